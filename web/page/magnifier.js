// @ts-check
// The magnifier: the pixels around the chosen one, and the explanation of its byte.

import { element, make, setText } from "./elements.js";
import { HEIGHT, WIDTH } from "./engine.js";
import { ARROWS } from "./picture.js";

/**
 * @import { Scene } from "./engine.js"
 * @import { Page } from "./page.js"
 * @import { Account, Picture, Pixel, Registers } from "./types.d.ts"
 */

/**
 * The shades of light at the pixel: one, or those of red, green and blue.
 * @param {[number, number, number]} shades
 * @param {number} error
 */
function litText([red, green, blue], error) {
  const off = `${error < 0 ? "−" : "+"}${Math.abs(error).toFixed(2)}`;
  if (red === green && green === blue) return `Lit at the pixel itself it would be ${red.toFixed(2)} shades: this is off by ${off}.`;
  const shades = [red, green, blue].map((shade) => shade.toFixed(2));
  return `Lit at the pixel itself red, green and blue would be ${shades.join(", ")} shades: the one farthest off is off by ${off}.`;
}

const LENS = { columns: 21, rows: 13, zoom: 20 };

export class Magnifier {
  #parts;
  #isSeen = false;
  /**
   * The pixel shown before one is chosen.
   * @type {Pixel}
   */
  #start = { x: WIDTH / 2, y: HEIGHT / 2 };

  /** @param {Page} page */
  constructor(page) {
    this.page = page;
    this.#parts = this.#build();
    this.canvas = element("lens");
    this.context = /** @type {CanvasRenderingContext2D} */ (this.canvas.getContext("2d"));
    this.canvas.width = LENS.columns * LENS.zoom;
    this.canvas.height = LENS.rows * LENS.zoom;
    this.canvas.addEventListener("keydown", (event) => {
      const arrow = ARROWS[event.key];
      if (!arrow || event.ctrlKey || event.metaKey || event.altKey) return;
      event.preventDefault();
      page.movePixel(...arrow);
    });
    new IntersectionObserver(([{ isIntersecting }]) => {
      this.#isSeen = isIntersecting;
      page.redraw();
    }).observe(element("pixel"));
    // A click, so that a finger can scroll the page here.
    this.canvas.addEventListener("click", (event) => {
      const box = this.canvas.getBoundingClientRect();
      const column = Math.floor(((event.clientX - box.left) / box.width) * LENS.columns);
      const row = Math.floor(((event.clientY - box.top) / box.height) * LENS.rows);
      page.movePixel(column - (LENS.columns >> 1), row - (LENS.rows >> 1));
    });
  }

  /**
   * Follows the picture while the magnifier is in the window.
   * @param {Scene} scene
   * @param {Picture} frame
   */
  follow(scene, frame) {
    if (!this.#isSeen) return;
    const { x, y } = this.at;
    this.show({ x, y }, frame, scene.explain(x, y));
  }

  /**
   * The chosen pixel or, before one is chosen, the pixel nearest to the middle that shows an object.
   * @returns {Pixel}
   */
  get at() {
    return this.page.state.pixel ?? this.#first();
  }

  /** @returns {Pixel} */
  #first() {
    const { engine, accuracy } = this.page;
    const map = accuracy.lastMap?.map;
    // Levels of errors come first; pixels without one show no object.
    if (!map) return this.#start;
    /** @param {Pixel} pixel */
    const shows = ({ x, y }) => map[y * WIDTH + x] < engine.levels.length;
    if (shows(this.#start)) return this.#start;
    let nearest = { pixel: this.#start, far: Infinity };
    for (let y = 0; y < HEIGHT; y++) {
      for (let x = 0; x < WIDTH; x++) {
        const far = Math.hypot(x - WIDTH / 2, y - HEIGHT / 2);
        if (far < nearest.far && shows({ x, y })) nearest = { pixel: { x, y }, far };
      }
    }
    return (this.#start = nearest.pixel);
  }

  /**
   * @param {Pixel} pixel
   * @param {Picture} frame
   * @param {Account} account
   */
  show(pixel, frame, account) {
    // While the picture moves, screen readers would announce it without end.
    this.#parts.head.setAttribute("aria-live", this.page.state.playing ? "off" : "polite");
    this.#draw(pixel, frame, account);
    this.#say(account);
  }

  /**
   * @param {Pixel} pixel
   * @param {Picture} frame
   * @param {Account} account
   */
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

  /** The elements of the explanation. They are made once, so that open ones stay open and the focus is kept. */
  #build() {
    /** @param {string} name */
    const register = (name) => {
      const box = make("div", { className: "register" });
      const cell = { box, name: make("dt", {}, name), value: make("dd", { className: "mono" }) };
      box.append(cell.name, cell.value);
      return cell;
    };
    const cells = ["AX, the shade", "BX, the step", "CX, pixels left", "EDI, the address"].map(register);
    const parts = {
      head: make("h3"), swatch: make("i", { className: "swatch" }), name: make("span", {}, " Pixel"), color: make("span", { className: "mono muted" }),
      face: make("p"), registers: make("dl", { className: "registers" }), exact: make("p"), off: make("p"),
      text: make("pre", { className: "mono", tabIndex: 0 }), cells,
    };
    const all = make("details");
    parts.head.append(parts.swatch, parts.name, parts.color);
    parts.registers.append(...cells.map(({ box }) => box));
    all.append(make("summary", {}, "Full details"), parts.text);
    // Parts that can be opened are above those that come and go with the pixel, so that they do not move under a press.
    element("account").replaceChildren(parts.head, parts.face, all, parts.off, parts.exact, parts.registers);
    return parts;
  }

  /** @param {Account} account */
  #say(account) {
    const { x, y, byte, color, registers, exact, isRamp, against = [], object, triangle } = account;
    const parts = this.#parts;
    /**
     * @param {number} number
     * @param {number} digits
     */
    const hex = (number, digits) => number.toString(16).toUpperCase().padStart(digits, "0");
    parts.swatch.style.background = color;
    setText(parts.name, ` Pixel ${x}, ${y}: byte ${byte} `);
    setText(parts.color, `${hex(byte, 2)}h ${color}`);
    setText(parts.face, object === undefined ? "No face here: the background." : `Triangle ${triangle} of ${object}.`);
    parts.registers.hidden = !registers;
    if (registers) this.#sayRegisters(registers, hex);
    const lit = against.find(([standard]) => standard === "lit");
    setText(parts.exact, exact === undefined ? "" : `The exact ${isRamp ? "palette entry" : "shade"} here is ${exact.toFixed(4)}.`);
    setText(parts.off, lit ? litText(lit[1], lit[2]) : "");
    setText(parts.text, account.text.trim());
  }

  /**
   * @param {Registers} registers
   * @param {(number: number, digits: number) => string} hex
   */
  #sayRegisters({ eax, ebx, cx, edi, isWide }, hex) {
    const digits = isWide ? 8 : 4;
    const ax = hex(eax, digits);
    // The byte is AH, or in 16.16 the third of EAX.
    const at = isWide ? 2 : 0;
    const [shade, step, left, place] = this.#parts.cells;
    setText(shade.name, isWide ? "EAX, the shade" : "AX, the shade");
    setText(step.name, isWide ? "EBX, the step" : "BX, the step");
    shade.value.replaceChildren(ax.slice(0, at), make("b", {}, ax.slice(at, at + 2)), ax.slice(at + 2));
    setText(step.value, hex(ebx, digits));
    setText(left.value, hex(cx, 4));
    setText(place.value, hex(0xa0000 + edi, 5));
  }
}
