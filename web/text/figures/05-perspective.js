// A textured wall, seen along it: affine, exact at every 16th pixel, exact everywhere. On a level floor all pixels of a row
// are equally far away, and one division per row would do.
import * as M from "./00-shared.js";

const [WIDTH, HEIGHT] = [320, 128];
const TEXELS = 256;

/**
 * Plane through three values at three points: [at the origin, per column, per row].
 * @param {number[][]} points
 * @param {number[]} values
 */
function plane([[x0, y0], [x1, y1], [x2, y2]], [v0, v1, v2]) {
  const area = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0);
  const gx = ((v1 - v0) * (y2 - y0) - (v2 - v0) * (y1 - y0)) / area;
  const gy = ((v2 - v0) * (x1 - x0) - (v1 - v0) * (x2 - x0)) / area;
  return [v0 - gx * x0 - gy * y0, gx, gy];
}
/** @type {(plane: number[], x: number, y: number) => number} */
const on = ([at, gx, gy], x, y) => at + gx * x + gy * y;

// Texture coordinates of the wall at every pixel: u and v in texels, NaN beside the wall. `ratio`
// is the distance of the far edge, on the right, over that of the near one; `mapping` is
// "affine", "every16" or "exact".
export function wallTexels(ratio, mapping) {
  const K = (WIDTH - 4) / (1 - 1 / ratio);
  const corner = (side, w) => ({ p: [2 + K * (1 - 1 / w), HEIGHT / 2 + side * 62 / w], w, u: w === 1 ? 0 : TEXELS, v: side < 0 ? 0 : TEXELS });
  const [a, b, c, d] = [corner(-1, 1), corner(1, 1), corner(1, ratio), corner(-1, ratio)];
  const us = new Float64Array(WIDTH * HEIGHT).fill(NaN);
  const vs = new Float64Array(WIDTH * HEIGHT).fill(NaN);
  let divisions = 0;
  for (const face of [[a, b, c], [a, c, d]]) {
    const points = face.map((f) => f.p);
    const units = points.map((p) => p.map((t) => Math.floor(t * 256 + .5)));
    const of = (value) => plane(points, face.map(value));
    const [u, v] = [of((f) => f.u), of((f) => f.v)];
    const [uw, vw, iw] = [of((f) => f.u / f.w), of((f) => f.v / f.w), of((f) => 1 / f.w)];
    M.coverRows(units, HEIGHT, (y, from, to) => {
      const [x0, x1] = [Math.max(from, 0), Math.min(to, WIDTH)];
      const exact = (x) => {
        divisions++;
        const z = 1 / on(iw, x + .5, y + .5);
        return [on(uw, x + .5, y + .5) * z, on(vw, x + .5, y + .5) * z];
      };
      /** @type {(x: number, texel: number[]) => unknown} */
      const put = (x, [s, t]) => ([us[y * WIDTH + x], vs[y * WIDTH + x]] = [s, t]);
      if (mapping === "affine") for (let x = x0; x < x1; x++) put(x, [on(u, x + .5, y + .5), on(v, x + .5, y + .5)]);
      else if (mapping === "exact") for (let x = x0; x < x1; x++) put(x, exact(x));
      else if (x0 < x1) {
        let left = exact(x0);
        for (let x = x0; x < x1; x += 16) {
          const end = Math.min(x + 16, x1 - 1);
          const right = end > x ? exact(end) : left;
          for (let i = x; i <= Math.min(end, x + 15); i++) {
            const t = end > x ? (i - x) / (end - x) : 0;
            put(i, [left[0] + (right[0] - left[0]) * t, left[1] + (right[1] - left[1]) * t]);
          }
          left = right;
        }
      }
    });
  }
  return { us, vs, divisions, points: [a, b, c, d].map((q) => q.p) };
}

// Tiles of 16 texels with joints, each of its own tone.
function texel(u, v) {
  if (Number.isNaN(u)) return -1;
  const [i, j] = [Math.floor(u) & 255, Math.floor(v) & 255];
  const [s, t] = [i >> 4, j >> 4];
  const tone = ((s + t) & 1 ? 196 : 92) + ((s * 37 + t * 59) % 32);
  return (i & 15) < 1 || (j & 15) < 1 ? tone - 60 : tone;
}

M.figure("perspective", (stage) => {
  let [ratio, mapping, split] = [6, "affine", .5];
  M.choice(stage, {
    label: "Right of the divider", value: mapping,
    options: [["affine", "affine"], ["every16", "exact every 16th pixel"], ["exact", "exact"]],
    input: (v) => ((mapping = v), show()),
  });
  let [bytes, points] = [null, null];
  const board = M.board(stage, {
    height: (w) => w * HEIGHT / WIDTH,
    paint(c, w, h, ink) {
      const tint = (byte) => (byte === 0 ? 0x15181d : (byte << 16) | ((byte * 5 >> 3) << 8) | (byte * 3 >> 3));
      M.pixels(c, bytes, WIDTH, HEIGHT, 0, 0, w, h, tint);
      const scale = w / WIDTH;
      const at = (p) => p.map((t) => t * scale);
      if (mapping !== "exact") {
        c.save();
        c.beginPath();
        c.rect(split * w, 0, w, h);
        c.clip();
        M.line(c, [points[0], points[2]].map(at), "#ffffff", 1, [4, 4]);
        c.restore();
      }
      M.line(c, [[split * w, 0], [split * w, h]], "#ffffff", 2);
      const tag = (words, x, align) => {
        const wide = c.measureText(words).width + 12;
        c.fillStyle = "#15181d";
        c.fillRect(align === "left" ? x - 6 : x - wide + 6, 4, wide, 20);
        M.text(c, words, x, 18, "#ffffff", { align });
      };
      tag("exact", 10, "left");
      tag({ affine: "affine", every16: "every 16th", exact: "exact" }[mapping], w - 10, "right");
    },
  });
  M.handle(board, {
    label: "Divider", kind: "upright", anywhere: true,
    at: () => [split * board.width, board.height - 20],
    move: (x) => ((split = M.clamp(x / board.width, 0, 1)), show()),
    nudge: (dx, dy) => ((split = M.clamp(split + (dx - dy) / 100, 0, 1)), show()),
    say: () => `${Math.round(split * 100)} % from the left`,
  });
  const say = M.readout(stage);
  const bar = M.controls(stage);
  M.slider(bar, {
    label: "The far edge is", min: 1.25, max: 16, step: .25, value: ratio,
    format: (v) => `${v} times as far`, input: (v) => ((ratio = v), show()),
  });
  function show() {
    const truth = wallTexels(ratio, "exact");
    const drawn = mapping === "exact" ? truth : wallTexels(ratio, mapping);
    let worst = 0;
    bytes = new Uint8Array(WIDTH * HEIGHT);
    for (let i = 0; i < bytes.length; i++) {
      const of = i % WIDTH < split * WIDTH ? truth : drawn;
      bytes[i] = Math.max(0, texel(of.us[i], of.vs[i]));
      if (!Number.isNaN(truth.us[i])) {
        worst = Math.max(worst, Math.abs(drawn.us[i] - truth.us[i]), Math.abs(drawn.vs[i] - truth.vs[i]));
      }
    }
    points = drawn.points;
    board.describe(`A tiled wall; the chosen mapping is off by up to ${worst.toFixed(1)} texels`);
    say("Worst error ", { b: `${worst.toFixed(1)} texels`, warn: worst >= 1 }, `, ${(worst / 16).toFixed(1)} tiles. `,
      `Divisions for the wall: `, { b: M.group(drawn.divisions) }, ".");
    board.repaint();
  }
  show();
});
