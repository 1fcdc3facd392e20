// @ts-check
// A canvas that shows bytes through a palette, and the gestures on the picture: turn, tilt, zoom, choose a pixel.

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

/** Screen pixels that a pointer may move and still choose a pixel. */
const STILL = 5;
/** Radians per screen pixel, and per key press. */
const TURN = 0.008;
const KEY_TURN = Math.PI / 24;

/**
 * The directions of the arrow keys.
 * @type {Record<string, [number, number]>}
 */
export const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

/** Enlargement for one step of the wheel. */
const WHEEL = 0.0015;

/**
 * The callbacks for gestures.
 * @typedef {object} Hands
 * @property {(turn: number, tilt: number) => void} turn
 * @property {(factor: number) => void} zoom
 * @property {(pixel?: Pixel) => void} choose
 * @property {(dx: number, dy: number) => void} move
 * @property {() => void} play
 */

/**
 * Connects the gestures on the picture.
 * @param {PalettedCanvas} canvas
 * @param {Hands} on
 */
export function handle(canvas, on) {
  const element = canvas.canvas;
  /**
   * Pointers that are down, by their ids, with their last positions.
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
    // A finger that moves up or down scrolls the page.
    else on.turn(dx * TURN, event.pointerType === "touch" ? 0 : dy * TURN);
  });
  element.addEventListener("pointerup", (event) => {
    if (down.has(event.pointerId) && !from.moved) on.choose(canvas.pixelAt(event));
    down.delete(event.pointerId);
  });
  element.addEventListener("pointercancel", (event) => down.delete(event.pointerId));
  // The wheel alone scrolls the page, which would otherwise get stuck over so large a picture.
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
    } else if (event.key === " ") event.repeat || on.play();
    else if (event.key === "Enter") event.repeat || on.choose();
    else if (event.key === "+" || event.key === "=") on.zoom(1.1);
    else if (event.key === "-") on.zoom(1 / 1.1);
    else return;
    event.preventDefault();
  });
}
