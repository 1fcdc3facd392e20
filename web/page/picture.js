// @ts-check
// A canvas that shows bytes by a palette, and what hands do with the picture: turn, tilt, enlarge, choose a pixel.

import { clamp } from "./common.js";
import { HEIGHT, PIXELS, WIDTH } from "./engine.js";

/** @import { Picture, Pixel } from "./types.d.ts" */

/** Shows bytes in the colours of a palette of 768 bytes. */
export class PalettedCanvas {
  #colors = new Uint32Array(256);

  /** @param {HTMLCanvasElement} canvas */
  constructor(canvas) {
    canvas.width = WIDTH;
    canvas.height = HEIGHT;
    this.canvas = canvas;
    this.context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d", { alpha: false }));
    this.image = this.context.createImageData(WIDTH, HEIGHT);
    this.words = new Uint32Array(this.image.data.buffer);
  }

  /**
   * Shows columns `from` to `to` of a frame.
   * @param {Picture} picture
   * @param {number} from
   * @param {number} to
   */
  show({ bytes, palette }, from = 0, to = WIDTH) {
    const colors = this.#colors;
    for (let i = 0; i < 256; i++) {
      colors[i] = 0xff000000 | (palette[3 * i + 2] << 16) | (palette[3 * i + 1] << 8) | palette[3 * i];
    }
    for (let row = 0; row < PIXELS; row += WIDTH) {
      for (let at = row + from; at < row + to; at++) this.words[at] = colors[bytes[at]];
    }
    this.context.putImageData(this.image, 0, 0, from, 0, to - from, HEIGHT);
  }

  /**
   * The pixel under a pointer.
   * @param {{ clientX: number, clientY: number }} event
   */
  pixelAt(event) {
    const box = this.canvas.getBoundingClientRect();
    const x = Math.floor(((event.clientX - box.left) / box.width) * WIDTH);
    const y = Math.floor(((event.clientY - box.top) / box.height) * HEIGHT);
    return { x: clamp(x, 0, WIDTH - 1), y: clamp(y, 0, HEIGHT - 1) };
  }
}

/** Pixels of the screen that a pointer may move and still choose a pixel. */
const STILL = 5;
/** Radians for a pixel of the screen, and for a key. */
const TURN = 0.008;
const KEY_TURN = Math.PI / 24;

/**
 * Where arrow keys lead.
 * @type {Record<string, [number, number]>}
 */
export const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

/** Enlargement for a step of the wheel. */
const WHEEL = 0.0015;

/**
 * What is called for what hands do.
 * @typedef {object} Hands
 * @property {(turn: number, tilt: number) => void} turn
 * @property {(factor: number) => void} zoom
 * @property {(pixel?: Pixel) => void} choose
 * @property {(dx: number, dy: number) => void} move
 * @property {() => void} play
 */

/**
 * What hands do with the picture.
 * @param {PalettedCanvas} canvas
 * @param {Hands} on
 */
export function handle(canvas, on) {
  const element = canvas.canvas;
  /**
   * Pointers that are down, by their numbers: where they were last.
   * @type {Map<number, { x: number, y: number }>}
   */
  const down = new Map();
  let from = { x: 0, y: 0, moved: false };
  const spread = () => {
    const [a, b] = [...down.values()];
    return Math.hypot(a.x - b.x, a.y - b.y);
  };
  element.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    down.set(event.pointerId, { x: event.clientX, y: event.clientY });
    from = { x: event.clientX, y: event.clientY, moved: down.size > 1 };
    element.setPointerCapture(event.pointerId);
  });
  element.addEventListener("pointermove", (event) => {
    const last = down.get(event.pointerId);
    if (!last) return;
    const before = down.size === 2 ? spread() : 0;
    const [dx, dy] = [event.clientX - last.x, event.clientY - last.y];
    if (!from.moved && Math.hypot(event.clientX - from.x, event.clientY - from.y) <= STILL) return;
    from.moved = true;
    [last.x, last.y] = [event.clientX, event.clientY];
    if (down.size === 2) on.zoom(spread() / Math.max(before, 1));
    // Up and down a finger scrolls the page.
    else on.turn(dx * TURN, event.pointerType === "touch" ? 0 : dy * TURN);
  });
  element.addEventListener("pointerup", (event) => {
    if (down.has(event.pointerId) && !from.moved) on.choose(canvas.pixelAt(event));
    down.delete(event.pointerId);
  });
  element.addEventListener("pointercancel", (event) => down.delete(event.pointerId));
  // By the wheel alone the page scrolls: over so large a picture it would stick.
  element.addEventListener("wheel", (event) => {
    if (!event.ctrlKey && document.activeElement !== element) return;
    event.preventDefault();
    on.zoom(Math.exp(-event.deltaY * WHEEL * (event.ctrlKey ? 4 : 1)));
  }, { passive: false });
  element.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const arrow = ARROWS[event.key];
    if (arrow) {
      const [dx, dy] = arrow;
      if (event.shiftKey) on.move(dx, dy);
      else on.turn(dx * KEY_TURN, dy * KEY_TURN);
    } else if (event.key === " ") on.play();
    else if (event.key === "Enter") on.choose();
    else if (event.key === "+" || event.key === "=") on.zoom(1.1);
    else if (event.key === "-") on.zoom(1 / 1.1);
    else return;
    event.preventDefault();
  });
}
