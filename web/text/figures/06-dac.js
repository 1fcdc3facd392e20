// The palette behind the picture: six bits a channel, and a fade that draws nothing.
import * as M from "./00-shared.js";

// A colour's channel faded to black by t of 256, as the DAC stores it: 0 to 63.
export const faded = (eight, t) => M.toDac6((eight * (256 - t)) >> 8);

// Copper, dark to light.
const copper = (i) => [Math.min(255, i * 5 >> 2), i * 200 >> 8, i * 128 >> 8];
const [WIDTH, HEIGHT] = [160, 100];

// A ball's bytes.
function ball() {
  return Uint8Array.from({ length: WIDTH * HEIGHT }, (_, i) => {
    const [x, y] = [(i % WIDTH - 79.5) / 44, (Math.floor(i / WIDTH) - 49.5) / 44];
    const r2 = x * x + y * y;
    if (r2 >= 1) return 0;
    const z = Math.sqrt(1 - r2);
    const nl = Math.max(0, (-.5 * x - .55 * y + .7 * z) / 1.022);
    const shine = Math.max(0, 2 * nl * z - .685);
    return Math.min(255, 24 + 150 * nl + 80 * shine ** 16);
  });
}

M.figure("dac", (stage) => {
  let [t, entry] = [64, 200];
  const bytes = ball();
  const [COLUMNS, ROWS] = [32, 8];
  const shownColor = (i) => copper(i).map((v) => M.dac6To8(faded(v, t)));
  const packed = (i) => shownColor(i).reduce((n, v) => n * 256 + v, 0);
  const pair = M.make("div", "fig-pair", stage);
  const side = (title) => {
    const d = M.make("div", "", pair);
    M.make("p", "fig-name", d, title);
    return d;
  };
  const picture = M.board(side("The picture"), {
    height: (w) => w * HEIGHT / WIDTH,
    paint: (c, w, h) => M.pixels(c, bytes, WIDTH, HEIGHT, 0, 0, w, h, packed),
  });
  const right = side("The table of 256 colours");
  const palette = M.board(right, {
    height: (w) => Math.floor(w / COLUMNS) * ROWS * 1.5,
    paint(c, w, h, ink) {
      M.pixels(c, Uint8Array.from({ length: 256 }, (_, i) => i), COLUMNS, ROWS, 0, 0, w, h, packed);
    },
  });
  const pick = (i) => {
    entry = M.clamp(i, 0, 255);
    show();
  };
  M.handle(palette, {
    label: "Entry of the table", kind: "second", anywhere: true,
    at: () => [(entry % COLUMNS + .5) / COLUMNS * palette.width, (Math.floor(entry / COLUMNS) + .5) / ROWS * palette.height],
    move: (x, y) => pick(M.clamp(Math.floor(y / palette.height * ROWS), 0, ROWS - 1) * COLUMNS
      + M.clamp(Math.floor(x / palette.width * COLUMNS), 0, COLUMNS - 1)),
    nudge: (dx, dy) => pick(entry + dx + COLUMNS * dy),
    say: () => `entry ${entry}`,
  });
  const bits = M.board(right, {
    height: () => 92,
    paint(c, w, h, ink) {
      const cell = Math.min(24, (w - 120) / 6);
      copper(entry).forEach((v, k) => {
        const level = faded(v, t);
        const y = 8 + k * 28;
        M.text(c, ["red", "green", "blue"][k], 0, y + 15, ink.muted);
        for (let b = 0; b < 6; b++) {
          const on = level >> (5 - b) & 1;
          c.fillStyle = on ? ink.ink : ink.paper;
          c.fillRect(48 + b * cell, y, cell - 3, 20);
          c.strokeStyle = ink.muted;
          c.strokeRect(48.5 + b * cell, y + .5, cell - 4, 19);
          M.text(c, String(on), 48 + b * cell + (cell - 3) / 2, y + 15, on ? ink.paper : ink.ink, { align: "center", font: `12px ${ink.mono}` });
        }
        M.text(c, `= ${level}`, 54 + 6 * cell, y + 15, ink.ink);
      });
    },
  });
  const chart = M.board(stage, {
    height: () => 150,
    paint(c, w, h, ink) {
      const [left, top, bottom] = [30, 10, h - 22];
      const x = (s) => left + s / 256 * (w - left - 6);
      const y = (level) => bottom - level / 63 * (bottom - top);
      for (const l of [0, 21, 42, 63]) {
        M.line(c, [[left, y(l)], [w - 6, y(l)]], ink.line);
        M.text(c, String(l), left - 6, y(l) + 4, ink.muted, { align: "right" });
      }
      const [r, g, b] = copper(entry);
      // A contrast of 3 : 1 and more on light and on dark.
      for (const [v, color] of [[r, "#d83a3a"], [g, "#2f9440"], [b, "#4f7fe8"]]) {
        const steps = [];
        for (let s = 0; s <= 256; s++) steps.push([x(s), y(faded(v, s))], [x(Math.min(s + 1, 256)), y(faded(v, s))]);
        M.line(c, steps, color, 2);
      }
      M.line(c, [[x(t), top - 4], [x(t), bottom]], ink.ink, 1.5, [4, 3]);
      M.text(c, "red, green and blue during the fade", left, h - 5, ink.muted);
    },
  });
  const say = M.readout(stage);
  const bar = M.controls(stage);
  const fader = M.slider(bar, {
    label: "Fade to black", min: 0, max: 256, step: 4, value: t, format: (v) => `${v / 4} of 64`, input: (v) => ((t = v), show()),
  });
  const jump = (by) => {
    t = M.clamp(t + by, 0, 256);
    fader.set(t);
    show();
  };
  M.button(bar, "One step of 64", () => jump(4));
  M.button(bar, "Back", () => jump(-4));
  function show() {
    const greys = new Set(Array.from({ length: 256 }, (_, v) => M.dac6To8(M.toDac6(v)))).size;
    const levels = new Set(Array.from({ length: 257 }, (_, s) => faded(copper(entry)[0], s))).size;
    say("Bytes of the picture changed: ", { b: "0" }, ". Bytes of the table written: ", { b: "768" }, ". ",
      `Red of entry ${entry} has ${M.count(levels, "level")} on its way to black, and no channel has more than ${greys}.`);
    picture.describe(`A copper ball, faded by ${t} of 256`);
    palette.describe("256 colours of the table");
    bits.describe(`Entry ${entry}: red, green, blue ${copper(entry).map((v) => faded(v, t)).join(", ")} of 63`);
    chart.describe(`Levels of entry ${entry} during a fade`);
    [picture, palette, bits, chart].forEach((b) => b.repaint());
  }
  show();
});
