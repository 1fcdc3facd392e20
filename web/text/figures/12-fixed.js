// How far sums in 8.8 and 16.16 lag behind the exact shade.
import * as M from "./00-shared.js";

// Sums, in shades, of a row from a to b (1/256 shade) over w pixels: step toward zero, each start
// rounded back toward where shades come from, a start every `reseed` pixels, `bits` of fraction.
// bytes: the sum plus a half, truncated.
export function rowDrift(a, b, w, bits, reseed = w) {
  const unit = 2 ** (bits - 8);
  const [from, delta, n] = [a * unit, (b - a) * unit, Math.max(w - 1, 1)];
  const step = Math.trunc(delta / n);
  const lag = new Float64Array(w);
  const sums = new Float64Array(w);
  const bytes = new Uint8Array(w);
  for (let seed = 0; seed < w; seed += reseed) {
    const start = from + (delta < 0 ? M.ceilDiv(delta * seed, n) : M.floorDiv(delta * seed, n));
    for (let k = seed; k < Math.min(seed + reseed, w); k++) {
      const sum = start + (k - seed) * step;
      sums[k] = sum / 2 ** bits;
      // Exact minus sum over the common denominator, so that no subtraction cancels.
      lag[k] = Math.abs((from - sum) * n + delta * k) / n / 2 ** bits;
      bytes[k] = Math.floor(sum / 2 ** bits + .5);
    }
  }
  return { lag, sums, bytes, step };
}

M.figure("fixed", (stage) => {
  let [a, b, w, at] = [40 * 256, 111 * 256, 320, 250];
  const ways = () => [
    { name: "8.8, one start", color: "accent", ...rowDrift(a, b, w, 8) },
    { name: "8.8, a start every 64 pixels", color: "second", ...rowDrift(a, b, w, 8, 64) },
    { name: "16.16, one start", color: "ink", ...rowDrift(a, b, w, 16) },
  ];
  const exact = (k) => (a + (b - a) * k / Math.max(w - 1, 1)) / 256;
  const TOP = 44;
  const LEFT = 34;
  const board = M.board(stage, {
    height: () => TOP + 1.3 * 64 + 44,
    paint(c, width, h, ink) {
      const x = (k) => LEFT + (k + .5) / w * (width - LEFT - 4);
      const y = (lag) => TOP + lag * 64;
      for (const s of [0, .25, .5, 1]) {
        M.line(c, [[LEFT, y(s)], [width - 4, y(s)]], ink.line);
        M.text(c, { 0: "0", .25: "¼", .5: "½", 1: "1" }[s], LEFT - 6, y(s) + 4, ink.muted, { align: "right" });
      }
      const all = ways();
      M.pixels(c, all[0].bytes, w, 1, LEFT, 0, width - LEFT - 4, 24);
      for (const way of all) M.line(c, [...way.lag].map((l, k) => [x(k), y(l)]), ink[way.color], way.color === "ink" ? 2.5 : 2);
      M.line(c, [[x(at), 12], [x(at), h - 40]], ink.muted, 1, [3, 3]);
      all.forEach((way) => {
        c.fillStyle = ink[way.color];
        c.beginPath();
        c.arc(x(at), y(way.lag[at]), 4, 0, 7);
        c.fill();
      });
      for (let s = 0; s < w; s += 64) M.text(c, String(s), x(s), h - 24, ink.muted, { align: s ? "center" : "left" });
      M.text(c, "lag in shades, along the pixels of the row", LEFT, h - 5, ink.muted);
    },
  });
  const go = (k) => {
    at = M.clamp(Math.round(k), 0, w - 1);
    show();
  };
  M.handle(board, {
    label: "Pixel of the row", kind: "upright", anywhere: true,
    at: () => [LEFT + (at + .5) / w * (board.width - LEFT - 4), 12],
    move: (x) => go((x - LEFT) / (board.width - LEFT - 4) * w - .5),
    nudge: (dx, dy) => go(at + dx - dy),
    say: () => `pixel ${at}`,
  });
  const table = M.make("table", "fig-table", stage);
  const say = M.readout(stage);
  const bar = M.controls(stage);
  M.slider(bar, { label: "First shade", min: 0, max: 255, value: a / 256, input: (v) => ((a = v * 256), show()) });
  M.slider(bar, { label: "Last shade", min: 0, max: 255, value: b / 256, input: (v) => ((b = v * 256), show()) });
  M.slider(bar, {
    label: "Pixels in the row", min: 2, max: 320, value: w,
    input: (v) => ((w = v), (at = Math.min(at, w - 1)), show()),
  });
  function show() {
    const all = ways();
    const rows = M.fillTable(table, [`at pixel ${at}`, "sum", "lag", "byte"], [
      ["exact", exact(at).toFixed(4), "", String(Math.floor(exact(at) + .5))],
      ...all.map((way) => [way.name, way.sums[at].toFixed(4), way.lag[at].toFixed(4), String(way.bytes[at])]),
    ]);
    rows.forEach((tr, i) => {
      tr.firstChild.style.paddingLeft = "12px";
      if (i) tr.firstChild.style.boxShadow = `inset 4px 0 var(--${all[i - 1].color})`;
    });
    const wrong = all.map((way) => way.bytes.reduce((n, byte, k) => n + Number(byte !== Math.floor(exact(k) + .5)), 0));
    const worst = all.map((way) => Math.max(...way.lag));
    board.describe(`Greatest lag: ${all.map((way, i) => `${way.name} ${worst[i].toFixed(3)} shades`).join(", ")}`);
    say(`Greatest lag along the row: ${worst[0].toFixed(2)}, ${worst[1].toFixed(2)} and ${worst[2].toFixed(4)} shades. `,
      "Bytes that are not the nearest: ", { b: wrong.join(", ") }, ".");
    board.repaint();
  }
  show();
});
