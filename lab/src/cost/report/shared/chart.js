// @ts-check
// The chart of error against time, both logarithmic: one for the page and for the report of `mode13h cost`.
/** Errors below are drawn here: a logarithmic axis has no 0. */
const ERROR_FLOOR = 0.01;

/** Room for the name of a tick, in pixels. */
const TICK_NAME = 46;

/**
 * A time with its unit, in three digits: `412 µs`.
 * @param {number} ms
 */
function timeText(ms) {
  const [number, unit] = ms >= 1000 ? [ms / 1000, "s"] : ms >= 1 ? [ms, "ms"] : ms >= 1e-3 ? [ms * 1e3, "µs"] : [ms * 1e6, "ns"];
  return `${Number(number.toPrecision(3))} ${unit}`;
}

/**
 * Ticks of a logarithmic axis: 1, 2 and 5 of each power of ten; of many powers the powers alone.
 * @param {number} low
 * @param {number} high
 */
function logTicks(low, high) {
  const steps = high / low > 1e3 ? [1] : [1, 2, 5];
  const ticks = [];
  for (let power = Math.floor(Math.log10(low)); power <= Math.ceil(Math.log10(high)); power++) {
    for (const step of steps) ticks.push(step * 10 ** power);
  }
  return ticks.filter((tick) => tick >= low && tick <= high);
}

/**
 * The span of an axis: all numbers, with room on either side, and a power of ten at least.
 * @param {number[]} numbers
 * @returns {[number, number]}
 */
function logSpan(numbers) {
  const [low, high] = [Math.min(...numbers), Math.max(...numbers)];
  if (!(low <= high)) return [0.1, 10];
  const room = Math.max(1.5, Math.sqrt((10 * low) / high));
  return [low / room, high * room];
}

/**
 * A point of the chart.
 * @typedef {object} Point
 * @property {number} ms
 * @property {number} error
 * @property {string} name
 * @property {"shading" | "budget" | "now" | "second"} kind
 * @property {boolean} [efficient]
 * @property {number} [budget]
 * @property {string} [title]
 * @property {string} [key]
 * @property {() => void} [choose]
 */

/**
 * What the chart is like: `across` and `down` name the axes, `time` words a time.
 * @typedef {{ height?: number, description?: string, across?: string, down?: string, time?: (ms: number) => string }} Options
 */

/**
 * Draws the chart into an element, at its width.
 *
 * Efficient shadings are joined, and so are budgets, in the order of `budget`. A press of a point that has `choose` calls
 * it, by pointer or by key; its `key` is its own, so that a chart that is drawn again under a press or the focus keeps them.
 * @param {HTMLElement} element
 * @param {Point[]} given
 * @param {Options} options
 */
export function drawChart(element, given, options = {}) {
  const { height = 260, description = "Error against time", time = timeText } = options;
  const { across: acrossName = "time for a frame", down: downName = "error in shades, r.m.s." } = options;
  /**
   * @param {string} name
   * @param {Record<string, string | number>} attributes
   * @param {Element} [parent]
   * @param {string} [text]
   */
  const make = (name, attributes, parent, text) => {
    const made = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, `${value}`);
    if (text !== undefined) made.textContent = text;
    parent?.append(made);
    return made;
  };
  const known = given.filter(({ ms, error }) => ms > 0 && Number.isFinite(ms) && Number.isFinite(error));
  const points = known.map((point) => ({ ...point, error: Math.max(point.error, ERROR_FLOOR) }));
  const width = Math.max(element.clientWidth, 260);
  const [left, right, top, bottom] = [46, width - 10, 10, height - 38];
  const [across, down] = [logSpan(points.map((point) => point.ms)), logSpan(points.map((point) => point.error))];
  /**
   * @param {[number, number]} span
   * @param {number} from
   * @param {number} to
   * @returns {(value: number) => number}
   */
  const on = ([low, high], from, to) => (value) => from + (Math.log(value / low) / Math.log(high / low)) * (to - from);
  const [x, y] = [on(across, left, right), on(down, bottom, top)];

  const svg = make("svg", { viewBox: `0 0 ${width} ${height}`, width, height, class: "chart-svg", role: "group", "aria-label": description });
  // A tick has no name where that of the one before would touch it.
  let lastNamed = -Infinity;
  for (const tick of logTicks(...across)) {
    make("line", { class: "chart-grid", x1: x(tick), x2: x(tick), y1: top, y2: bottom }, svg);
    const isAtEnd = x(tick) + 28 > width;
    if (x(tick) - lastNamed < TICK_NAME) continue;
    lastNamed = x(tick);
    make("text", { class: "chart-tick", x: isAtEnd ? width : x(tick), y: bottom + 15, "text-anchor": isAtEnd ? "end" : "middle" }, svg, time(tick));
  }
  for (const tick of logTicks(...down)) {
    make("line", { class: "chart-grid", x1: left, x2: right, y1: y(tick), y2: y(tick) }, svg);
    make("text", { class: "chart-tick", x: left - 6, y: y(tick) + 4, "text-anchor": "end" }, svg, `${Number(tick.toPrecision(2))}`);
  }
  make("text", { class: "chart-name", x: right, y: height - 6, "text-anchor": "end" }, svg, `${acrossName} →`);
  make("text", { class: "chart-name", x: 12, y: top + 2, transform: `rotate(-90 12 ${top + 2})`, "text-anchor": "end" }, svg, `${downName} →`);

  make("text", { class: "chart-name", x: left, y: height - 6 }, svg, "↙ better: down and left");

  /**
   * @typedef {{ x0: number, x1: number, y0: number, y1: number, isName?: boolean }} Box
   * @type {(cx: number, cy: number, size: number) => Box}
   */
  const around = (cx, cy, size) => ({ x0: cx - size, x1: cx + size, y0: cy - size, y1: cy + size });
  const taken = points.map((point) => around(x(point.ms), y(point.error), 5));
  /**
   * @param {Point[]} joined
   * @param {string} name
   */
  const path = (joined, name) => {
    const corners = joined.map((point) => [x(point.ms), y(point.error)]);
    if (corners.length > 1) make("polyline", { class: name, points: corners.join(" ") }, svg);
    // Names keep off the line, too.
    corners.slice(1).forEach(([endX, endY], at) => {
      const [startX, startY] = corners[at];
      const steps = Math.ceil(Math.hypot(endX - startX, endY - startY) / 6);
      for (let i = 1; i < steps; i++) taken.push(around(startX + ((endX - startX) * i) / steps, startY + ((endY - startY) * i) / steps, 1));
    });
  };
  path(points.filter((point) => point.kind === "budget").sort((a, b) => (b.budget ?? 0) - (a.budget ?? 0)), "chart-budgets");
  path(points.filter((point) => point.kind === "shading" && point.efficient).sort((a, b) => a.ms - b.ms), "chart-shadings");

  // A name over a name is worst, over a point bad.
  /** @param {Box} box */
  const cost = ({ isName, x0, x1 }) => (isName ? 100 : x1 - x0 > 2 ? 10 : 1);
  /** @type {(a: Box, b: Box) => boolean} */
  const meets = (a, b) => a.x0 < b.x1 && b.x0 < a.x1 && a.y0 < b.y1 && b.y0 < a.y1;
  const order = { now: 3, second: 2, shading: 1, budget: 0 };
  for (const point of [...points].sort((a, b) => order[a.kind] - order[b.kind])) {
    const at = { x: x(point.ms), y: y(point.error) };
    const group = make("g", { class: `chart-point ${point.kind}${point.efficient ? " efficient" : ""}` }, svg);
    const title = point.title ?? `${point.name}: ${acrossName} ${time(point.ms)}, ${downName} ${point.error.toPrecision(2)}`;
    make("title", {}, group, title);
    if (point.kind === "budget") make("path", { d: `M${at.x} ${at.y - 5}l5 9h-10z` }, group);
    else make("circle", { cx: at.x, cy: at.y, r: point.kind === "shading" ? 4.5 : 7 }, group);
    if (point.choose) {
      group.classList.add("chosen-by-click");
      for (const [key, value] of Object.entries({ tabindex: "0", role: "button", "data-key": point.key ?? "", "aria-label": title })) group.setAttribute(key, value);
    }
  }
  // Every point has a name. Budgets at one place share it.
  /** @type {{ x: number, y: number, kind: string, name: string }[]} */
  const named = [];
  for (const point of [...points].sort((a, b) => order[b.kind] - order[a.kind] || Number(b.efficient ?? false) - Number(a.efficient ?? false))) {
    if (!point.name) continue;
    const at = { x: x(point.ms), y: y(point.error) };
    const other = point.kind === "budget" && named.find((other) => other.kind === "budget" && Math.abs(other.x - at.x) <= 8 && Math.abs(other.y - at.y) <= 8);
    if (other) other.name += `, ${point.name.replace(/^≤ /, "")}`;
    else named.push({ ...at, kind: point.kind, name: point.name });
  }
  for (const point of named) {
    const size = 6.4 * point.name.length;
    // Beside the point, and farther and farther off.
    /** @type {[number, number, "start" | "middle" | "end"][]} */
    const places = [[9, 4, "start"], [-9, 4, "end"], [0, -10, "middle"], [0, 19, "middle"], [8, -7, "start"], [8, 15, "start"], [-8, -7, "end"], [-8, 15, "end"]];
    for (let far = 24; far <= 240; far += 12) {
      for (let turn = 0; turn < 16; turn++) {
        const [dx, dy] = [Math.cos((turn * Math.PI) / 8) * far, Math.sin((turn * Math.PI) / 8) * far];
        places.push([dx, dy + 4, Math.abs(dx) < 1 ? "middle" : dx > 0 ? "start" : "end"]);
      }
    }
    /** @type {{ covered: number, box: Box, dx: number, dy: number, anchor: string } | undefined} */
    let best;
    for (const [dx, dy, anchor] of places) {
      const start = point.x + dx - { start: 0, middle: size / 2, end: size }[anchor];
      const box = { x0: start - 3, x1: start + size + 3, y0: point.y + dy - 10, y1: point.y + dy + 2 };
      if (box.x0 < left || box.x1 > right + 8 || box.y0 < top - 6 || box.y1 > bottom) continue;
      const covered = taken.filter((other) => meets(box, other)).reduce((sum, other) => sum + cost(other), 0);
      if (!best || covered < best.covered) best = { covered, box, dx, dy, anchor };
      if (covered === 0) break;
    }
    if (!best) continue;
    const { box, dx, dy, anchor } = best;
    const end = { x: Math.min(Math.max(point.x, box.x0), box.x1), y: Math.min(Math.max(point.y, box.y0 + 2), box.y1) };
    if (Math.hypot(end.x - point.x, end.y - point.y) > 15) {
      make("line", { class: `chart-leader ${point.kind}`, x1: point.x, y1: point.y, x2: end.x, y2: end.y }, svg);
    }
    taken.push({ ...box, isName: true });
    make("text", { class: `chart-label ${point.kind}`, x: point.x + dx, y: point.y + dy, "text-anchor": anchor }, svg, point.name);
  }
  const focused = /** @type {SVGElement | null} */ (element.querySelector(":focus"))?.dataset.key;
  element.replaceChildren(svg);
  /** @param {EventTarget | null} target */
  const keyOf = (target) => (target instanceof Element && target.closest(".chosen-by-click")?.getAttribute("data-key")) || "";
  /** @param {string} key */
  const choose = (key) => points.find((point) => point.choose && point.key === key)?.choose?.();
  const groups = /** @type {NodeListOf<SVGElement>} */ (svg.querySelectorAll("[data-key]"));
  if (focused !== undefined) [...groups].find((group) => group.dataset.key === focused)?.focus({ preventScroll: true });
  // Not by `click`: between a press and its release another chart may have come.
  element.onpointerdown = ({ target }) => (element.dataset.pressed = keyOf(target));
  element.onpointerup = ({ target }) => keyOf(target) && keyOf(target) === element.dataset.pressed && choose(keyOf(target));
  element.onkeydown = (event) => {
    if ((event.key !== "Enter" && event.key !== " ") || event.ctrlKey || event.metaKey || event.altKey || !keyOf(event.target)) return;
    event.preventDefault();
    choose(keyOf(event.target));
  };
}

/**
 * Marks the shadings that no other is both nearer and faster than.
 * @param {Point[]} points
 */
export function markEfficient(points) {
  const shadings = points.filter((point) => point.kind === "shading");
  /** @type {(a: Point, b: Point) => boolean} */
  const beats = (a, b) => a.ms <= b.ms && a.error <= b.error && (a.ms < b.ms || a.error < b.error);
  for (const point of shadings) point.efficient = !shadings.some((other) => beats(other, point));
  return points;
}
