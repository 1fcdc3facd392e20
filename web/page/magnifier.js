// The magnifier: the pixels about the chosen one, and the account that it gives of itself.

const LENS = { columns: 21, rows: 13, zoom: 20 };

class Magnifier {
  constructor(page) {
    this.page = page;
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
    this.isSeen = false;
    new IntersectionObserver(([{ isIntersecting }]) => {
      this.isSeen = isIntersecting;
      page.choose({});
    }).observe(element("pixel"));
    this.canvas.addEventListener("pointerdown", (event) => {
      const box = this.canvas.getBoundingClientRect();
      const column = Math.floor(((event.clientX - box.left) / box.width) * LENS.columns);
      const row = Math.floor(((event.clientY - box.top) / box.height) * LENS.rows);
      page.movePixel(column - (LENS.columns >> 1), row - (LENS.rows >> 1));
    });
  }

  /** Follows the picture while it is in the window: the chosen pixel, or that in the middle. */
  follow(scene, frame, pixel) {
    if (!this.isSeen) return;
    const at = pixel ?? { x: WIDTH / 2, y: HEIGHT / 2 };
    this.show(at, frame, scene.explain(at.x, at.y));
  }

  show(pixel, frame, account) {
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

  #say(account) {
    const { x, y, byte, color, registers, exact, against = [], object, triangle } = account;
    const hex = (number, digits) => number.toString(16).toUpperCase().padStart(digits, "0");
    const swatch = make("i", { className: "swatch" });
    swatch.style.background = color;
    const head = make("h3");
    head.append(swatch, ` Pixel ${x}, ${y}: byte ${byte} `, make("span", { className: "mono muted" }, `${hex(byte, 2)}h ${color}`));
    const parts = [head];
    parts.push(make("p", {}, object === undefined ? "No face is here: the background." : `Triangle ${triangle} of ${object}.`));
    if (registers) {
      const wide = registers.eax > 0xffff || registers.ebx > 0xffff;
      const digits = wide ? 8 : 4;
      const ax = hex(registers.eax, digits);
      // The byte is AH, or in 16.16 the third of EAX.
      const [before, seen, after] = wide ? [ax.slice(0, 2), ax.slice(2, 4), ax.slice(4)] : ["", ax.slice(0, 2), ax.slice(2)];
      const box = (name, ...content) => {
        const register = make("div", { className: "register" });
        const value = make("dd", { className: "mono" });
        value.append(...content);
        register.append(make("dt", {}, name), value);
        return register;
      };
      const list = make("dl", { className: "registers" });
      list.append(
        box(wide ? "EAX, the shade" : "AX, the shade", before, make("b", {}, seen), after),
        box(wide ? "EBX, the step" : "BX, the step", hex(registers.ebx, digits)),
        box("CX, pixels left", hex(registers.cx, 4)),
        box("EDI, the place", hex(0xa0000 + registers.edi, 5)),
      );
      parts.push(list);
    }
    if (typeof exact === "number") parts.push(make("p", {}, `Exactly, the shade here is ${exact.toFixed(4)}.`));
    const lit = against.find(([standard]) => standard === "lit");
    if (lit) {
      parts.push(make("p", {}, `Lit at the pixel itself it would be ${lit[1].toFixed(2)} shades: this is off by ${lit[2] < 0 ? "−" : "+"}${Math.abs(lit[2]).toFixed(2)}.`));
    }
    const all = make("details");
    all.open = element("account").querySelector("details")?.open ?? false;
    all.append(make("summary", {}, "The whole account"), make("pre", { className: "mono", tabIndex: 0 }, account.text.trim()));
    parts.push(all);
    element("account").replaceChildren(...parts);
  }
}
