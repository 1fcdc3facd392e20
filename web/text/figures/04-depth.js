// Two triangles that may cross: painter's order beside a depth buffer.
import * as M from "./00-shared.js";

const [WIDTH, HEIGHT] = [160, 100];
const COLORS = [0x15181d, 0xe8924a, 0x4a9cc4];

/**
 * Depth of a triangle [x, y, z] in pixels at a point.
 * @param {number[][]} corners
 * @param {number} x
 * @param {number} y
 */
export function depthAt([[x0, y0, z0], [x1, y1, z1], [x2, y2, z2]], x, y) {
  const area = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0);
  const gx = ((z1 - z0) * (y2 - y0) - (z2 - z0) * (y1 - y0)) / area;
  const gy = ((z2 - z0) * (x1 - x0) - (z1 - z0) * (x2 - x0)) / area;
  return z0 + gx * (x - x0) + gy * (y - y0);
}

// Number (from 1) of the triangle that each pixel shows, and how many pixels were written.
// "painter": by the mean distance, far first. "buffer": in the given order, the nearer stays.
export function hidden(triangles, method, width = WIDTH, height = HEIGHT) {
  const shown = new Uint8Array(width * height);
  const depths = new Float64Array(width * height).fill(Infinity);
  let [writes, compared] = [0, 0];
  const mean = (t) => (t[0][2] + t[1][2] + t[2][2]) / 3;
  const order = triangles.map((t, i) => [t, i + 1]);
  if (method === "painter") order.sort((a, b) => mean(b[0]) - mean(a[0]));
  for (const [t, number] of order) {
    M.coverRows(t.map(([x, y]) => [Math.round(x * 256), Math.round(y * 256)]), height, (y, from, to) => {
      for (let x = Math.max(from, 0); x < Math.min(to, width); x++) {
        const i = y * width + x;
        const z = depthAt(t, x + .5, y + .5);
        if (method === "buffer") {
          compared++;
          if (z >= depths[i]) continue;
          depths[i] = z;
        }
        shown[i] = number;
        writes++;
      }
    });
  }
  return { shown, writes, compared };
}

M.figure("depth", (stage) => {
  let [tilt, push, row] = [.55, 0, 52];
  const scene = () => [
    [[12, 14, 2 - tilt + push], [148, 40, 2 + tilt + push], [20, 92, 2 - tilt + push]],
    [[148, 8, 2], [140, 94, 2], [10, 56, 2]],
  ];
  const pair = M.make("div", "fig-pair", stage);
  const boards = [["painter", "Painter’s order"], ["buffer", "Depth buffer"]].map(([method, title]) => {
    const side = M.make("div", "", pair);
    M.make("p", "fig-name", side, title);
    const board = M.board(side, {
      height: (w) => w * HEIGHT / WIDTH,
      paint(c, w, h) {
        const { shown } = hidden(scene(), method);
        M.pixels(c, shown, WIDTH, HEIGHT, 0, 0, w, h, (n) => COLORS[n]);
        const y = (row + .5) / HEIGHT * h;
        M.line(c, [[0, y], [w, y]], "#ffffff", 1.5, [5, 5]);
      },
    });
    const move = (y) => {
      row = M.clamp(Math.floor(y), 0, HEIGHT - 1);
      show();
    };
    M.handle(board, {
      label: "Row of the cut", kind: "level", anywhere: true,
      at: () => [board.width - 18, (row + .5) / HEIGHT * board.height],
      move: (x, y) => move(y / board.height * HEIGHT),
      nudge: (dx, dy) => move(row + dy + dx),
      say: () => `row ${row}`,
    });
    return board;
  });
  const cut = M.board(stage, {
    height: () => 132,
    paint(c, w, h, ink) {
      const [left, right] = [10, w - 10];
      const x = (p) => left + p / WIDTH * (right - left);
      const y = (z) => h - 22 - (z - .9) / 2.2 * (h - 30);
      c.fillStyle = ink.paper;
      c.fillRect(0, 0, w, h);
      const spans = scene().map((t) => {
        let span = null;
        M.coverRows(t.map(([px, py]) => [Math.round(px * 256), Math.round(py * 256)]), HEIGHT, (r, a, b) => {
          if (r === row) span = [Math.max(a, 0), Math.min(b, WIDTH)];
        });
        return { t, span };
      });
      spans.forEach(({ t, span }, i) => {
        if (!span) return;
        const color = `#${COLORS[i + 1].toString(16)}`;
        const z = (px) => depthAt(t, px + .5, row + .5);
        M.line(c, [[x(span[0]), y(z(span[0]))], [x(span[1]), y(z(span[1]))]], color, 2, [4, 4]);
        // Thick where the triangle is in front.
        const other = spans[1 - i];
        for (let px = span[0]; px < span[1]; px++) {
          const there = other.span && px >= other.span[0] && px < other.span[1];
          if (!there || z(px) < depthAt(other.t, px + .5, row + .5)) {
            M.line(c, [[x(px), y(z(px))], [x(px + 1) + .5, y(z(px + 1))]], color, 6);
          }
        }
      });
      M.text(c, "far", 6, 16, ink.muted);
      M.text(c, "near: the eye is below", 6, h - 6, ink.muted);
    },
  });
  const say = M.readout(stage);
  const bar = M.controls(stage);
  M.slider(bar, {
    label: "Turn the orange triangle", min: -1, max: 1, step: .05, value: tilt,
    format: (v) => M.signed(v), input: (v) => ((tilt = v), show()),
  });
  M.slider(bar, {
    label: "Push it away", min: -.6, max: .6, step: .02, value: push,
    format: (v) => M.signed(v), input: (v) => ((push = v), show()),
  });
  function show() {
    const [painter, buffer] = ["painter", "buffer"].map((m) => hidden(scene(), m));
    const wrong = painter.shown.reduce((n, s, i) => n + Number(s !== buffer.shown[i]), 0);
    boards[0].describe(`Painter's order: ${wrong} pixels show the wrong triangle`);
    boards[1].describe("Depth buffer: the nearer at every pixel");
    cut.describe(`Cut along row ${row}, seen from above`);
    say("The painter gets ", { b: M.count(wrong, "pixel"), warn: wrong > 0 }, ` wrong. The depth buffer gets none, `,
      `for ${M.group(buffer.compared)} comparisons.`);
    boards.forEach((b) => b.repaint());
    cut.repaint();
  }
  show();
});
