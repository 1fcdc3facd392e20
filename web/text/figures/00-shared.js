// Shared by all figures: registration, boards, handles, sliders, and the machine's arithmetic.
//
// figure(name, mount, usesEngine)   registers a figure; mount(stage, engine) builds it
// mountFigures(engine)              mounts every [data-figure] as it comes near the screen. Called
//                                   again with an engine, it remounts the figures that use one.

export const registered = new Map();
const mounted = new Map();
/** @type {any} */
let theEngine = null;

export const figure = (name, mount, usesEngine = false) => registered.set(name, { mount, usesEngine });

function mountOne(element) {
  const entry = registered.get(element.dataset.figure);
  if (!entry) return;
  element.querySelector(":scope > .fig-stage")?.remove();
  const stage = make("div", "fig-stage");
  element.prepend(stage);
  mounted.set(element, theEngine);
  try {
    entry.mount(stage, theEngine);
  } catch (error) {
    make("p", "fig-say", stage).textContent = `This figure cannot be shown: ${error.message}`;
    console.error(error);
  }
}

let near = null;
/** @param {any} engine */
export function mountFigures(engine = null) {
  theEngine = engine ?? theEngine;
  for (const [element, had] of mounted) {
    if (had !== theEngine && registered.get(element.dataset.figure)?.usesEngine) mountOne(element);
  }
  near ??= new IntersectionObserver((entries) => {
    for (const entry of entries) {
      if (entry.isIntersecting) {
        near.unobserve(entry.target);
        mountOne(entry.target);
      }
    }
  }, { rootMargin: "600px" });
  for (const element of document.querySelectorAll("[data-figure]")) {
    if (!mounted.has(element)) near.observe(element);
  }
}

// ---- elements ----

export function make(tag, className, parent, text) {
  const element = document.createElement(tag);
  if (className) element.className = className;
  if (text !== undefined) element.textContent = text;
  parent?.append(element);
  return element;
}

const boards = new Set();
let watching = false;
function watchTheme() {
  if (watching) return;
  watching = true;
  const all = () => boards.forEach((b) => b.repaint());
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", all);
  new MutationObserver(all).observe(document.documentElement, { attributeFilter: ["data-theme"] });
}

const INK = ["paper", "ink", "muted", "line", "accent", "second", "warn", "panel", "mono", "sans"];

/**
 * A canvas as wide as its container. `paint(context, width, height, ink)` draws in CSS pixels;
 * `height(width)` returns its height.
 * @param {HTMLElement} parent
 * @param {{ height: (width: number) => number, paint: Function, label?: string, className?: string }} options
 */
export function board(parent, { height, paint, label, className = "" }) {
  const wrap = make("div", `fig-board ${className}`, parent);
  const canvas = make("canvas", "", wrap);
  canvas.setAttribute("role", "img");
  const handles = [];
  let asked = false;
  const self = {
    wrap, canvas, handles, width: 0, height: 0,
    describe: (text) => canvas.setAttribute("aria-label", text),
    repaint() {
      if (asked) return;
      asked = true;
      requestAnimationFrame(() => {
        asked = false;
        self.paintNow();
      });
    },
    paintNow() {
      if (!wrap.isConnected) return void boards.delete(self);
      const width = wrap.clientWidth;
      if (!width) return;
      const dpr = globalThis.devicePixelRatio || 1;
      self.width = width;
      self.height = Math.round(height(width));
      const [w, h] = [Math.round(width * dpr), Math.round(self.height * dpr)];
      if (canvas.width !== w || canvas.height !== h) [canvas.width, canvas.height] = [w, h];
      canvas.style.height = `${self.height}px`;
      const context = canvas.getContext("2d");
      context.setTransform(dpr, 0, 0, dpr, 0, 0);
      context.clearRect(0, 0, width, self.height);
      const style = getComputedStyle(wrap);
      const ink = Object.fromEntries(INK.map((n) => [n, style.getPropertyValue(`--${n}`).trim()]));
      context.font = `12px ${ink.sans}`;
      context.textBaseline = "alphabetic";
      context.imageSmoothingEnabled = false;
      paint(context, width, self.height, ink);
      handles.forEach((h) => h.place());
    },
  };
  self.describe(label ?? "");
  new ResizeObserver(() => self.paintNow()).observe(wrap);
  boards.add(self);
  watchTheme();
  return self;
}

// A point on a board, dragged by pointer or moved by arrow keys (Shift: farther).
// at() → [x, y] in the board's CSS pixels; move(x, y) takes the same; nudge(dx, dy) takes key steps;
// say() → the meaning of the point's position. With `anywhere` the mouse may press the board beside it.
export function handle(on, { label, at, move, nudge, say, kind = "", anywhere = false }) {
  const button = make("button", `fig-handle ${kind}${anywhere ? " anywhere" : ""}`, on.wrap);
  button.type = "button";
  button.setAttribute("aria-roledescription", "movable point, arrow keys");
  const place = () => {
    const [x, y] = at();
    button.style.transform = `translate(${x}px, ${y}px)`;
    const text = `${label}: ${say()}`;
    if (button.getAttribute("aria-label") !== text) button.setAttribute("aria-label", text);
  };
  let grip = [0, 0];
  button.addEventListener("pointerdown", (event) => {
    button.setPointerCapture(event.pointerId);
    const box = on.wrap.getBoundingClientRect();
    const [x, y] = at();
    grip = [event.clientX - box.left - x, event.clientY - box.top - y];
  });
  button.addEventListener("pointermove", (event) => {
    if (!button.hasPointerCapture(event.pointerId)) return;
    const box = on.wrap.getBoundingClientRect();
    move(event.clientX - box.left - grip[0], event.clientY - box.top - grip[1]);
    on.repaint();
  });
  if (anywhere) {
    on.canvas.addEventListener("pointerdown", (event) => {
      if (event.pointerType !== "mouse" || event.button) return;
      event.preventDefault();
      button.focus({ preventScroll: true });
      button.setPointerCapture(event.pointerId);
      grip = [0, 0];
      const box = on.wrap.getBoundingClientRect();
      move(event.clientX - box.left, event.clientY - box.top);
      on.repaint();
    });
  }
  button.addEventListener("keydown", (event) => {
    const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    if (!step || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    nudge(...step.map((s) => s * (event.shiftKey ? 8 : 1)));
    on.repaint();
  });
  on.handles.push({ place, button });
  return button;
}

// A container for sliders, choices and buttons.
export const controls = (parent) => make("div", "fig-controls", parent);

/**
 * @param {HTMLElement} parent
 * @param {{ label: string, min: number, max: number, step?: number, value: number, format?: (value: number) => string, input: (value: number) => void }} options
 */
export function slider(parent, { label, min, max, step = 1, value, format = String, input }) {
  const wrap = make("label", "fig-slider", parent);
  const head = make("span", "fig-slider-head", wrap);
  make("span", "", head, label);
  // Screen readers get this from aria-valuetext; an output would announce it a second time.
  const out = make("span", "fig-slider-value", head);
  out.setAttribute("aria-hidden", "true");
  const range = make("input", "", wrap);
  Object.assign(range, { type: "range", min, max, step, value });
  const show = () => {
    out.textContent = format(+range.value);
    range.setAttribute("aria-valuetext", out.textContent);
  };
  range.addEventListener("input", () => {
    show();
    input(+range.value);
  });
  show();
  return {
    range,
    set(v) {
      range.value = v;
      show();
    },
  };
}

let groups = 0;
export function choice(parent, { label, options, value, input }) {
  const set = make("fieldset", "fig-choice", parent);
  make("legend", "", set, label);
  const name = `fig-choice-${groups++}`;
  for (const [key, text] of options) {
    const one = make("label", "", set);
    const radio = make("input", "", one);
    Object.assign(radio, { type: "radio", name, value: key, checked: key === value });
    radio.addEventListener("change", () => input(key));
    make("span", "", one, text);
  }
  return set;
}

export function button(parent, text, press) {
  const b = make("button", "fig-button", parent, text);
  b.type = "button";
  b.addEventListener("click", press);
  return b;
}

// A line that says what the figure is showing.
export function readout(parent) {
  const p = make("p", "fig-say", parent);
  p.setAttribute("aria-live", "polite");
  return (...parts) => {
    p.replaceChildren(...parts.map((part) => {
      if (typeof part === "string") return document.createTextNode(part);
      const b = document.createElement(part.code ? "code" : "b");
      b.textContent = part.code ?? part.b;
      if (part.warn) b.className = "warn";
      return b;
    }));
  };
}

// Fills a table with a head and rows of cells.
export function fillTable(table, head, rows) {
  table.replaceChildren();
  const top = make("tr", "", make("thead", "", table));
  for (const cell of head) make("th", "", top, cell).scope = "col";
  const body = make("tbody", "", table);
  return rows.map((cells) => {
    const tr = make("tr", "", body);
    for (const cell of cells) make("td", "", tr, cell);
    return tr;
  });
}

// ---- drawing ----

export const grey = (s) => `rgb(${s},${s},${s})`;

/** @type {HTMLCanvasElement | undefined} */
let spareCanvas;
const spare = () => (spareCanvas ??= document.createElement("canvas"));

// Draws bytes as greys, `scale` CSS pixels a byte; `color(byte, index)` → 0xRRGGBB if given.
export function pixels(context, bytes, w, h, x, y, toWidth, toHeight, color) {
  const canvas = spare();
  [canvas.width, canvas.height] = [w, h];
  const inner = canvas.getContext("2d");
  const image = inner.createImageData(w, h);
  for (let i = 0; i < w * h; i++) {
    const c = color ? color(bytes[i], i) : bytes[i] * 0x010101;
    image.data.set([c >> 16, (c >> 8) & 255, c & 255, 255], 4 * i);
  }
  inner.putImageData(image, 0, 0);
  context.imageSmoothingEnabled = false;
  context.drawImage(canvas, 0, 0, w, h, x, y, toWidth, toHeight);
}

// A board with a frame of the engine, returned by get(), under a title.
export function frame(parent, title, get, color) {
  const side = make("div", "", parent);
  make("p", "fig-name", side, title);
  return board(side, {
    height: (w) => w * 200 / 320,
    paint(c, w, h) {
      const shown = get();
      if (!shown) return;
      const p = shown.palette;
      pixels(c, shown.bytes, shown.width, shown.height, 0, 0, w, h,
        color ?? ((b) => (p[3 * b] << 16) | (p[3 * b + 1] << 8) | p[3 * b + 2]));
    },
  });
}

/**
 * @param {CanvasRenderingContext2D} context
 * @param {string} string
 * @param {number} x
 * @param {number} y
 * @param {string} color
 * @param {{ align?: CanvasTextAlign, font?: string }} options
 */
export function text(context, string, x, y, color, { align = "left", font } = {}) {
  context.save();
  context.fillStyle = color;
  context.textAlign = align;
  if (font) context.font = font;
  context.fillText(string, x, y);
  context.restore();
}

export function line(context, points, color, width = 1, dash = []) {
  context.save();
  context.strokeStyle = color;
  context.lineWidth = width;
  context.lineJoin = "round";
  context.setLineDash(dash);
  context.beginPath();
  points.forEach(([x, y], i) => (i ? context.lineTo(x, y) : context.moveTo(x, y)));
  context.stroke();
  context.restore();
}

// ---- numbers ----

export const clamp = (x, low, high) => Math.min(high, Math.max(low, x));
export const hex = (n, digits) => n.toString(16).toUpperCase().padStart(digits, "0");
export const binary = (n, bits) => n.toString(2).padStart(bits, "0");
export const group = (n) => String(Math.round(n)).replace(/\B(?=(\d{3})+$)/g, ",");
export const signed = (x, digits = 2) => (x < 0 ? "−" : "+") + Math.abs(x).toFixed(digits);
export const count = (n, one, more = `${one}s`) => `${group(n)} ${n === 1 ? one : more}`;

// The integer at or below, and at or above, n / d. Exact for integers with |n| < 2⁵³: a quotient
// that is not whole is at least 1/d from the next whole q, more than a rounding while q·d < 2⁵³.
export const floorDiv = (n, d) => Math.floor(n / d);
export const ceilDiv = (n, d) => Math.ceil(n / d);

// ---- the machine ----

// Bytes of the 8.8 loop; AX and BX are 16 bits.
export function spanBytes(ax, bx, cx) {
  const row = new Uint8Array(cx);
  for (let k = 0; k < cx; k++) {
    row[k] = ax >> 8;
    ax = (ax + bx) & 0xFFFF;
  }
  return row;
}

// First pixel whose centre lies at or right of (below) u, in 1/256 pixel.
export const firstCentre = (u) => (u + 127) >> 8;

/**
 * Three corners [x, y, …] in 1/256 pixel by (y, x), with twice the signed area.
 * @param {number[][]} corners
 */
export function sorted(corners) {
  const v = [...corners].sort((a, b) => a[1] - b[1] || a[0] - b[0]);
  const [[x0, y0], [x1, y1], [x2, y2]] = v;
  return { v, area: (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0) };
}

/**
 * First pixel of a row whose centre lies on the edge from a down to b, or right of it: exact.
 * @param {number[]} a
 * @param {number[]} b
 * @param {number} row
 */
export function edgeAt(a, b, row) {
  const dy = b[1] - a[1];
  return ceilDiv((a[0] - 128) * dy + (b[0] - a[0]) * (row * 256 + 128 - a[1]), dy * 256);
}

// Calls row(y, x0, x1) for the exactly covered rows: a centre inside, or on a top or left edge.
export function coverRows(corners, height, row) {
  const { v: [top, middle, bottom], area } = sorted(corners);
  if (!area) return;
  const split = firstCentre(middle[1]);
  const end = Math.min(firstCentre(bottom[1]), height);
  for (let y = Math.max(firstCentre(top[1]), 0); y < end; y++) {
    const long = edgeAt(top, bottom, y);
    const short = y < split ? edgeAt(top, middle, y) : edgeAt(middle, bottom, y);
    const [x0, x1] = area > 0 ? [long, short] : [short, long];
    if (x0 < x1) row(y, x0, x1);
  }
}

// Adds 1 to every pixel that a triangle covers.
export function coverExact(corners, width, height, into = new Uint8Array(width * height)) {
  coverRows(corners, height, (y, x0, x1) => {
    for (let x = Math.max(x0, 0); x < Math.min(x1, width); x++) into[y * width + x]++;
  });
  return into;
}

// Converts 8 bits to the DAC's 6 and back.
export const toDac6 = (eight) => eight >> 2;
export const dac6To8 = (six) => (six << 2) | (six >> 4);

export const equalBytes = (a, b) => a.length === b.length && a.every((byte, i) => byte === b[i]);
