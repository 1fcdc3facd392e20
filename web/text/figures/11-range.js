// A row's sums with the step rounded in three ways, and which of them wrap.
import * as M from "./00-shared.js";

// Sums of a row from shade a to shade b, both in 1/256 and met at the centres of the first and
// the last of w pixels. `mode` rounds the step: "zero", "nearest" or "away" from zero.
export function rowSums(a, b, w, mode) {
  const exactStep = w > 1 ? (b - a) / (w - 1) : 0;
  const up = Math.sign(exactStep) * Math.ceil(Math.abs(exactStep));
  const step = mode === "zero" ? Math.trunc(exactStep) : mode === "away" ? up : Math.round(exactStep);
  const drift = Array.from({ length: w }, (_, k) => k * step - (w > 1 ? (b - a) * k / (w - 1) : 0));
  const bytes = M.spanBytes((a + 128) & 0xFFFF, step & 0xFFFF, w);
  const [low, high] = [(Math.min(a, b) + 128) >> 8, (Math.max(a, b) + 128) >> 8];
  const outside = bytes.reduce((n, byte) => n + Number(byte < low || byte > high), 0);
  return { step, drift, bytes, low, high, outside };
}

M.figure("range", (stage) => {
  let [a, b, w, mode] = [200 * 256, 255 * 256, 320, "away"];
  const LAST = 20;
  const MODES = { zero: "toward zero", nearest: "to the nearest", away: "away from zero" };
  M.choice(stage, {
    label: "The step is rounded", value: mode,
    options: Object.entries(MODES),
    input: (v) => ((mode = v), show()),
  });
  const board = M.board(stage, {
    height: () => 236,
    paint(c, width, h, ink) {
      const { drift, bytes, low, high } = rowSums(a, b, w, mode);
      M.pixels(c, bytes, w, 1, 0, 0, width, 26);
      // The last pixels, enlarged.
      const shown = Math.min(LAST, w);
      const from = w - shown;
      const cell = width / shown;
      const x0 = from / w * width;
      c.fillStyle = ink.line;
      c.beginPath();
      c.moveTo(x0, 26);
      c.lineTo(width, 26);
      c.lineTo(width, 40);
      c.lineTo(0, 40);
      c.fill();
      for (let i = 0; i < shown; i++) {
        const byte = bytes[from + i];
        c.fillStyle = M.grey(byte);
        c.fillRect(i * cell, 40, cell + .5, 36);
        const bad = byte < low || byte > high;
        if (cell > 22) {
          M.text(c, String(byte), (i + .5) * cell, 63, byte > 115 ? "#000" : "#fff", { align: "center", font: `11px ${ink.mono}` });
        }
        if (bad) {
          c.fillStyle = ink.warn;
          c.fillRect(i * cell, 78, cell + .5, 4);
        }
      }
      // Drift compared with the room left before the 16 bits wrap.
      const [top, bottom, left] = [96, h - 22, 40];
      const y = (units) => (top + bottom) / 2 - units / 400 * (bottom - top) / 2;
      const x = (k) => left + k / Math.max(w - 1, 1) * (width - left - 2);
      c.save();
      c.beginPath();
      c.rect(left, top, width - left, bottom - top);
      c.clip();
      c.fillStyle = ink.warn;
      c.globalAlpha = .18;
      for (const side of [1, -1]) {
        c.beginPath();
        for (let k = 0; k < w; k++) {
          const exact = a + (b - a) * k / Math.max(w - 1, 1) + 128;
          c.lineTo(x(k), y(side > 0 ? 65536 - exact : -exact));
        }
        c.lineTo(width, side > 0 ? top : bottom);
        c.lineTo(left, side > 0 ? top : bottom);
        c.fill();
      }
      c.globalAlpha = 1;
      M.line(c, drift.map((d, k) => [x(k), y(d)]), ink.accent, 2.5);
      c.restore();
      M.line(c, [[left, y(0)], [width, y(0)]], ink.muted);
      for (const s of [-1, 0, 1]) M.text(c, s ? M.signed(s, 0) : "exact", left - 5, y(s * 256) + 4, ink.muted, { align: "right" });
      M.text(c, "sum minus exact", left + 4, bottom + 16, ink.muted);
      M.text(c, "shaded: AX wraps", width - 2, bottom + 16, ink.warn, { align: "right" });
    },
  });
  const say = M.readout(stage);
  const bar = M.controls(stage);
  M.slider(bar, { label: "First shade", min: 0, max: 255, value: a / 256, input: (v) => ((a = v * 256), show()) });
  M.slider(bar, { label: "Last shade", min: 0, max: 255, value: b / 256, input: (v) => ((b = v * 256), show()) });
  M.slider(bar, { label: "Pixels in the row", min: 2, max: 320, value: w, input: (v) => ((w = v), show()) });
  function show() {
    const { step, drift, bytes, low, high, outside } = rowSums(a, b, w, mode);
    board.describe(`Row of ${w} pixels from ${low} to ${high}; ${outside} bytes outside that range`);
    say(`Rounded ${MODES[mode]}, the step is ${step}/256. At the end the sum is ${M.signed(drift[w - 1] / 256)} shades off. `,
      outside ? { b: `${M.count(outside, "byte leaves", "bytes leave")} the range ${low} … ${high}; the last byte is ${bytes[w - 1]}.`, warn: true }
        : { b: `Every byte lies in ${low} … ${high}.` });
    board.repaint();
  }
  show();
});
