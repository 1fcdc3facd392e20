// What is added before truncation, and the error that remains.
import * as M from "./00-shared.js";

// Bytes of a row and their errors in shades: `added` is in 1/256 shade.
export function halfErrors(start, step, pixels, added) {
  const bytes = M.spanBytes((start + added) & 0xFFFF, step & 0xFFFF, pixels);
  const errors = Array.from(bytes, (byte, k) => byte - (start + k * step) / 256);
  const mean = errors.reduce((a, b) => a + b, 0) / pixels;
  return { bytes, errors, mean, worst: Math.max(...errors.map(Math.abs)) };
}

M.figure("half", (stage) => {
  const PIXELS = 32;
  let [start, step, added] = [0x1430, 0x2D, 0];
  const chart = M.board(stage, {
    height: (w) => Math.max(190, Math.min(260, w * .42)),
    paint(c, w, h, ink) {
      const { bytes, errors } = halfErrors(start, step, PIXELS, added);
      const [left, bottom, top] = [30, h - 34, 8];
      const cell = (w - left - 4) / PIXELS;
      const low = 19.5;
      const high = 29.5;
      const y = (s) => bottom - (s - low) / (high - low) * (bottom - top);
      for (let s = 20; s <= 29; s++) {
        M.line(c, [[left, y(s)], [w - 4, y(s)]], ink.line);
        if (s % 2 === 0) M.text(c, String(s), left - 6, y(s) + 4, ink.muted, { align: "right" });
      }
      for (let k = 0; k < PIXELS; k++) {
        const exact = (start + k * step) / 256;
        const x = left + k * cell;
        c.fillStyle = errors[k] < 0 ? ink.second : ink.accent;
        c.globalAlpha = .3;
        c.fillRect(x, Math.min(y(exact), y(bytes[k])), cell, Math.abs(y(exact) - y(bytes[k])));
        c.globalAlpha = 1;
        M.line(c, [[x, y(bytes[k])], [x + cell, y(bytes[k])]], ink.ink, 2.5);
        // Ten shades spread over the whole range of greys, to be visible.
        c.fillStyle = M.grey(M.clamp(Math.round((bytes[k] - 19) * 25), 0, 255));
        c.fillRect(x, bottom + 4, cell + .5, 14);
      }
      M.line(c, [0, PIXELS - 1].map((k) => [left + (k + .5) * cell, y((start + k * step) / 256)]), ink.accent, 2);
      M.text(c, "bytes, their contrast raised", left, h - 3, ink.muted);
      M.text(c, "shade", left + 6, top + 12, ink.muted);
    },
  });
  const say = M.readout(stage);
  const bar = M.controls(stage);
  const adder = M.slider(bar, {
    label: "Added first", min: 0, max: 256, step: 8, value: added,
    format: (v) => `${v}/256`, input: (v) => ((added = v), show()),
  });
  M.slider(bar, {
    label: "Step a pixel", min: 8, max: 64, value: step,
    format: (v) => `${v}/256`, input: (v) => ((step = v), show()),
  });
  M.slider(bar, {
    label: "First shade", min: 0x1400, max: 0x14FF, value: start,
    format: (v) => (v / 256).toFixed(2), input: (v) => ((start = v), show()),
  });
  M.button(bar, "Add half a shade", () => {
    added = 128;
    adder.set(added);
    show();
  });
  function show() {
    const { mean, worst } = halfErrors(start, step, PIXELS, added);
    chart.describe(`Exact shades and bytes along ${PIXELS} pixels; mean error ${M.signed(mean)} shades`);
    say("Mean error ", { b: `${M.signed(mean)} shades`, warn: Math.abs(mean) > .1 },
      ", worst ", { b: `${worst.toFixed(2)} shades`, warn: worst > .5 }, " over the row.",
      mean < -.1 ? " The row is too dark." : mean > .1 ? " The row is too bright."
        : worst > .5 ? " Not every byte is the nearest shade." : " Every byte is the nearest shade.");
    chart.repaint();
  }
  show();
});
