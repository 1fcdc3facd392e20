// The magnifier: the pixels about the chosen one, and the account that it gives of itself.

const LENS = { columns: 21, rows: 13, zoom: 20 };

class Magnifier {
  #parts;
  #isSeen = false;
  /** Where it is before a pixel is chosen. */
  #start = { x: WIDTH / 2, y: HEIGHT / 2 };

  constructor(page) {
    this.page = page;
    this.#parts = this.#build();
    this.canvas = element("lens");
    this.context = this.canvas.getContext("2d");
    this.canvas.width = LENS.columns * LENS.zoom;
    this.canvas.height = LENS.rows * LENS.zoom;
    this.canvas.addEventListener("keydown", (event) => {
      const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
      if (!arrows[event.key]) return;
      event.preventDefault();
      page.movePixel(...arrows[event.key]);
    });
    new IntersectionObserver(([{ isIntersecting }]) => {
      this.#isSeen = isIntersecting;
      page.redraw();
    }).observe(element("pixel"));
    this.canvas.addEventListener("pointerdown", (event) => {
      const box = this.canvas.getBoundingClientRect();
      const column = Math.floor(((event.clientX - box.left) / box.width) * LENS.columns);
      const row = Math.floor(((event.clientY - box.top) / box.height) * LENS.rows);
      page.movePixel(column - (LENS.columns >> 1), row - (LENS.rows >> 1));
    });
  }

  /** Follows the picture while it is in the window. */
  follow(scene, frame) {
    if (!this.#isSeen) return;
    const { x, y } = this.at;
    this.show({ x, y }, frame, scene.explain(x, y));
  }

  /** The chosen pixel or, before one is chosen, the nearest to the middle that shows an object. */
  get at() {
    return this.page.state.pixel ?? this.#first();
  }

  #first() {
    const { engine, accuracy } = this.page;
    const map = accuracy.lastMap?.map;
    // Levels of errors come first; where there are none, no object is seen.
    const shows = ({ x, y }) => map?.[y * WIDTH + x] < engine.levels.length;
    if (!map || shows(this.#start)) return this.#start;
    const far = ({ x, y }) => Math.hypot(x - WIDTH / 2, y - HEIGHT / 2);
    let nearest = null;
    for (let y = 0; y < HEIGHT; y++) {
      for (let x = 0; x < WIDTH; x++) if (shows({ x, y }) && !(nearest && far(nearest) <= far({ x, y }))) nearest = { x, y };
    }
    return (this.#start = nearest ?? this.#start);
  }

  show(pixel, frame, account) {
    // While the picture moves there would be no end to what is announced.
    this.#parts.head.setAttribute("aria-live", this.page.state.playing ? "off" : "polite");
    this.#draw(pixel, frame, account);
    this.#say(account);
  }

  #draw({ x, y }, { bytes, palette }, { corners }) {
    const { columns, rows, zoom } = LENS;
    const { context } = this;
    const [left, top] = [x - (columns >> 1), y - (rows >> 1)];
    context.fillStyle = "#16161a";
    context.fillRect(0, 0, columns * zoom, rows * zoom);
    for (let row = 0; row < rows; row++) {
      for (let column = 0; column < columns; column++) {
        const [px, py] = [left + column, top + row];
        if (px < 0 || py < 0 || px >= WIDTH || py >= HEIGHT) continue;
        const entry = 3 * bytes[py * WIDTH + px];
        const [red, green, blue] = palette.subarray(entry, entry + 3);
        context.fillStyle = `rgb(${red} ${green} ${blue})`;
        context.fillRect(column * zoom, row * zoom, zoom - 1, zoom - 1);
        context.fillStyle = red + green + blue > 380 ? "rgb(0 0 0 / .45)" : "rgb(255 255 255 / .4)";
        context.fillRect((column + 0.5) * zoom - 1.5, (row + 0.5) * zoom - 1.5, 2, 2);
      }
    }
    if (corners) {
      context.beginPath();
      for (const [cx, cy] of [...corners, corners[0]]) context.lineTo((cx - left) * zoom, (cy - top) * zoom);
      context.closePath();
      context.lineWidth = 3;
      context.strokeStyle = "#000";
      context.stroke();
      context.lineWidth = 1.5;
      context.strokeStyle = "#28c8f0";
      context.stroke();
    }
    context.lineWidth = 3;
    context.strokeStyle = "#ff3060";
    context.strokeRect((columns >> 1) * zoom - 1, (rows >> 1) * zoom - 1, zoom + 1, zoom + 1);
  }

  /** The account's elements. They are made once, so that what is open stays open, and what has the focus keeps it. */
  #build() {
    const register = (name) => {
      const box = make("div", { className: "register" });
      box.append(make("dt", {}, name), make("dd", { className: "mono" }));
      return box;
    };
    const parts = {
      head: make("h3"), swatch: make("i", { className: "swatch" }), name: make("span", {}, " Pixel"), color: make("span", { className: "mono muted" }),
      face: make("p"), registers: make("dl", { className: "registers" }), exact: make("p"), off: make("p"),
      text: make("pre", { className: "mono", tabIndex: 0 }),
    };
    const all = make("details");
    parts.head.append(parts.swatch, parts.name, parts.color);
    parts.registers.append(register("AX, the shade"), register("BX, the step"), register("CX, pixels left"), register("EDI, the address"));
    all.append(make("summary", {}, "Full details"), parts.text);
    // What opens stands above what comes and goes with the pixel, so that it does not move under a press.
    element("account").replaceChildren(parts.head, parts.face, all, parts.off, parts.exact, parts.registers);
    return parts;
  }

  #say(account) {
    const { x, y, byte, color, registers, exact, against = [], object, triangle } = account;
    const parts = this.#parts;
    const hex = (number, digits) => number.toString(16).toUpperCase().padStart(digits, "0");
    parts.swatch.style.background = color;
    setText(parts.name, ` Pixel ${x}, ${y}: byte ${byte} `);
    setText(parts.color, `${hex(byte, 2)}h ${color}`);
    setText(parts.face, object === undefined ? "No face is here: the background." : `Triangle ${triangle} of ${object}.`);
    parts.registers.hidden = !registers;
    if (registers) this.#sayRegisters(registers, hex);
    const lit = against.find(([standard]) => standard === "lit");
    setText(parts.exact, typeof exact === "number" ? `Exactly, the shade here is ${exact.toFixed(4)}.` : "");
    const off = lit && `${lit[2] < 0 ? "−" : "+"}${Math.abs(lit[2]).toFixed(2)}`;
    setText(parts.off, lit ? `Lit at the pixel itself it would be ${lit[1].toFixed(2)} shades: this is off by ${off}.` : "");
    setText(parts.text, account.text.trim());
  }

  #sayRegisters({ eax, ebx, cx, edi }, hex) {
    const isWide = eax > 0xffff || ebx > 0xffff;
    const digits = isWide ? 8 : 4;
    const ax = hex(eax, digits);
    // The byte is AH, or in 16.16 the third of EAX.
    const at = isWide ? 2 : 0;
    const [shade, step, left, place] = this.#parts.registers.children;
    setText(shade.firstElementChild, isWide ? "EAX, the shade" : "AX, the shade");
    setText(step.firstElementChild, isWide ? "EBX, the step" : "BX, the step");
    shade.lastElementChild.replaceChildren(ax.slice(0, at), make("b", {}, ax.slice(at, at + 2)), ax.slice(at + 2));
    setText(step.lastElementChild, hex(ebx, digits));
    setText(left.lastElementChild, hex(cx, 4));
    setText(place.lastElementChild, hex(0xa0000 + edi, 5));
  }
}
