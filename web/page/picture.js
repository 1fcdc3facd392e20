// A canvas that shows bytes by a palette, and what hands do with the picture: turn, tilt, enlarge, choose a pixel.

/** Shows bytes in the colours of a palette of 768 bytes. */
class PalettedCanvas {
  #colors = new Uint32Array(256);

  constructor(canvas) {
    canvas.width = WIDTH;
    canvas.height = HEIGHT;
    this.canvas = canvas;
    this.context = canvas.getContext("2d", { alpha: false });
    this.image = this.context.createImageData(WIDTH, HEIGHT);
    this.words = new Uint32Array(this.image.data.buffer);
  }

  /** Shows columns `from` to `to` of a frame. */
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

  /** The pixel under a pointer. */
  pixelAt(event) {
    const box = this.canvas.getBoundingClientRect();
    const x = Math.floor(((event.clientX - box.left) / box.width) * WIDTH);
    const y = Math.floor(((event.clientY - box.top) / box.height) * HEIGHT);
    return { x: clamp(x, 0, WIDTH - 1), y: clamp(y, 0, HEIGHT - 1) };
  }
}

const clamp = (number, low, high) => Math.min(Math.max(number, low), high);

/** Pixels of the screen that a pointer may move and still choose a pixel. */
const STILL = 5;
/** Radians for a pixel of the screen, and for a key. */
const TURN = 0.008;
const KEY_TURN = Math.PI / 24;

/** What hands do with the picture. `on` has turn(turn, tilt), zoom(factor), choose(pixel?), move(dx, dy), play(). */
function handle(canvas, on) {
  const element = canvas.canvas;
  let from = null;
  element.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    from = { x: event.clientX, y: event.clientY, lastX: event.clientX, lastY: event.clientY, moved: false };
    element.setPointerCapture(event.pointerId);
  });
  element.addEventListener("pointermove", (event) => {
    if (!from) return;
    const far = Math.hypot(event.clientX - from.x, event.clientY - from.y) > STILL;
    if (!from.moved && !far) return;
    from.moved = true;
    on.turn((event.clientX - from.lastX) * TURN, (event.clientY - from.lastY) * TURN);
    [from.lastX, from.lastY] = [event.clientX, event.clientY];
  });
  element.addEventListener("pointerup", (event) => {
    if (from && !from.moved) on.choose(canvas.pixelAt(event));
    from = null;
  });
  element.addEventListener("pointercancel", () => (from = null));
  element.addEventListener("keydown", (event) => {
    const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (arrows[event.key]) {
      const [dx, dy] = arrows[event.key];
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
