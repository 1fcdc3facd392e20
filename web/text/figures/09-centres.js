// Exact cover of a triangle beside that of the period's rows.
import * as M from "./00-shared.js";

// Adds 1 to every pixel of the rows that the period's code draws: corners on whole pixels, slopes
// in 16.16 truncated toward zero, and one addition per row (gouraud-vintage).
export function coverVintage(corners, width, height, into = new Uint8Array(width * height)) {
  const nearestPixel = (u) => (u + 128) >> 8;
  const { v, area } = M.sorted(corners);
  const [t, m, b] = v.map(([x, y]) => [nearestPixel(x), nearestPixel(y)]);
  const doubled = (m[0] - t[0]) * (b[1] - t[1]) - (b[0] - t[0]) * (m[1] - t[1]);
  if (!area || !doubled) return into;
  const at = (from, to, y) => {
    const step = Math.trunc((to[0] - from[0]) * 65536 / Math.max(to[1] - from[1], 1));
    return Math.floor((from[0] * 65536 + step * (y - from[1])) / 65536);
  };
  for (let y = Math.max(t[1], 0); y < Math.min(b[1], height); y++) {
    const long = at(t, b, y);
    const short = y < m[1] ? at(t, m, y) : at(m, b, y);
    const [x0, x1] = doubled > 0 ? [long, short] : [short, long];
    for (let x = Math.max(x0, 0); x < Math.min(x1, width); x++) into[y * width + x]++;
  }
  return into;
}

// Where a pixel's centre lies: 1 inside, 0 on an edge, −1 outside. In 1/256 pixel, by the three
// edge functions. A triangle without area has no inside, and draws nothing.
export function whereIsCentre(corners, x, y) {
  const { v: [a, b, c], area } = M.sorted(corners);
  if (area === 0) return -1;
  const [px, py] = [x * 256 + 128, y * 256 + 128];
  let least = Infinity;
  for (const [p, q] of [[a, b], [b, c], [c, a]]) {
    least = Math.min(least, Math.sign(area) * ((q[0] - p[0]) * (py - p[1]) - (q[1] - p[1]) * (px - p[0])));
  }
  return Math.sign(least) || 0;
}

// A grid of pixels on a board, and points on it in 1/256 pixel.
export function grid(columns, rows) {
  const self = {
    cell: 1, left: 0,
    fit(width) {
      self.cell = Math.max(1, Math.floor(width / columns));
      self.left = Math.floor((width - self.cell * columns) / 2);
    },
    height: (width) => Math.floor(width / columns) * rows,
    x: (u) => self.left + u / 256 * self.cell,
    y: (u) => u / 256 * self.cell,
    // The nearest sixteenth of a pixel inside the grid.
    back: (x, y, snap = 16) => [
      M.clamp(Math.round((x - self.left) / self.cell * 256 / snap) * snap, 0, columns * 256),
      M.clamp(Math.round(y / self.cell * 256 / snap) * snap, 0, rows * 256),
    ],
    clear(c, ink) {
      c.fillStyle = ink.paper;
      c.fillRect(self.left, 0, columns * self.cell, rows * self.cell);
    },
    lines(c, ink) {
      for (let x = 0; x <= columns; x++) M.line(c, [[self.x(x * 256), 0], [self.x(x * 256), rows * self.cell]], ink.line);
      for (let y = 0; y <= rows; y++) M.line(c, [[self.left, self.y(y * 256)], [self.x(columns * 256), self.y(y * 256)]], ink.line);
    },
    fill(c, x, y) {
      c.fillRect(self.left + x * self.cell, y * self.cell, self.cell, self.cell);
    },
    centre: (x, y) => [self.left + (x + .5) * self.cell, (y + .5) * self.cell],
  };
  return self;
}

/**
 * A handle for a point [x, y] in 1/256 pixel of a grid.
 * @param {ReturnType<typeof M.board>} board
 * @param {ReturnType<typeof grid>} on
 * @param {number[]} point
 * @param {{ label: string, changed: () => void, limit: number[], snap?: number, kind?: string }} options
 */
export function gridHandle(board, on, point, { label, changed, limit, snap = 16, kind }) {
  M.handle(board, {
    label, kind,
    at: () => [on.x(point[0]), on.y(point[1])],
    move: (x, y) => {
      [point[0], point[1]] = on.back(x, y, snap);
      changed();
    },
    nudge: (dx, dy) => {
      point[0] = M.clamp(point[0] + dx * snap, 0, limit[0] * 256);
      point[1] = M.clamp(point[1] + dy * snap, 0, limit[1] * 256);
      changed();
    },
    say: () => `x ${(point[0] / 256).toFixed(2)}, y ${(point[1] / 256).toFixed(2)} pixels`,
  });
}

M.figure("centres", (stage, engine) => {
  const [COLUMNS, ROWS] = [16, 12];
  const corners = [[2.5 * 256, 1.5 * 256], [14.25 * 256, 4.5 * 256], [5.5 * 256, 10.5 * 256]];
  const pair = M.make("div", "fig-pair", stage);
  const boards = ["exact", "period"].map((kind) => {
    const side = M.make("div", "", pair);
    const name = M.make("p", "fig-name", side);
    const on = grid(COLUMNS, ROWS);
    const board = M.board(side, {
      height: (w) => on.height(w),
      paint(c, w, h, ink) {
        on.fit(w);
        const exact = M.coverExact(corners, COLUMNS, ROWS);
        const drawn = kind === "exact" ? exact : coverVintage(corners, COLUMNS, ROWS);
        on.clear(c, ink);
        for (let i = 0; i < drawn.length; i++) {
          if (!drawn[i]) continue;
          c.fillStyle = kind === "exact" || exact[i] ? ink.second : ink.warn;
          c.globalAlpha = .45;
          on.fill(c, i % COLUMNS, Math.floor(i / COLUMNS));
          c.globalAlpha = 1;
        }
        on.lines(c, ink);
        for (let i = 0; i < drawn.length; i++) {
          const [x, y] = on.centre(i % COLUMNS, Math.floor(i / COLUMNS));
          const r = on.cell * .28;
          if (kind === "exact") {
            const where = whereIsCentre(corners, i % COLUMNS, Math.floor(i / COLUMNS));
            c.beginPath();
            c.arc(x, y, where === 0 ? Math.max(3, on.cell * .15) : Math.max(1, on.cell * .055), 0, 7);
            c.fillStyle = where === 0 ? ink.accent : ink.ink;
            if (where === 0 && !drawn[i]) {
              c.strokeStyle = ink.accent;
              c.lineWidth = 2;
              c.stroke();
            } else c.fill();
          } else if (drawn[i] && !exact[i]) {
            M.line(c, [[x - r, y - r], [x + r, y + r]], ink.warn, 2);
            M.line(c, [[x - r, y + r], [x + r, y - r]], ink.warn, 2);
          } else if (!drawn[i] && exact[i]) {
            c.strokeStyle = ink.warn;
            c.lineWidth = 2;
            c.beginPath();
            c.arc(x, y, r, 0, 7);
            c.stroke();
          }
        }
        M.line(c, [...corners, corners[0]].map(([x, y]) => [on.x(x), on.y(y)]), ink.ink, 2);
      },
    });
    corners.forEach((p, i) => gridHandle(board, on, p, {
      label: `Corner ${i + 1}`, changed: show, limit: [COLUMNS, ROWS], snap: 32,
    }));
    return { name, board };
  });
  const say = M.readout(stage);
  function show() {
    const exact = M.coverExact(corners, COLUMNS, ROWS);
    const period = coverVintage(corners, COLUMNS, ROWS);
    const sum = (a) => a.reduce((n, b) => n + (b ? 1 : 0), 0);
    const extra = sum(period.map((b, i) => Number(b && !exact[i])));
    const missing = sum(exact.map((b, i) => Number(b && !period[i])));
    let [kept, left] = [0, 0];
    exact.forEach((b, i) => {
      if (whereIsCentre(corners, i % COLUMNS, Math.floor(i / COLUMNS)) === 0) b ? kept++ : left++;
    });
    const name = (b, head, small) => {
      b.name.replaceChildren(head, " ");
      M.make("small", "", b.name, small);
    };
    name(boards[0], "Exact", M.count(sum(exact), "pixel"));
    name(boards[1], "The period’s code", M.count(sum(period), "pixel"));
    boards[0].board.describe(`Exact coverage: ${sum(exact)} pixels`);
    boards[1].board.describe(`Coverage by the period’s code: ${sum(period)} pixels, ${extra} too many, ${missing} missing`);
    const parts = ["The period’s code adds ", { b: M.count(extra, "pixel"), warn: extra > 0 }, " and misses ", { b: String(missing), warn: missing > 0 }, ". "];
    if (kept + left) {
      parts.push(`${M.count(kept + left, "centre lies", "centres lie")} on an edge: the rule keeps ${kept} (full dots) and leaves ${left} (open dots).`);
    } else parts.push("No centre lies on an edge.");
    if (engine) {
      const bytes = engine.triangles(Float64Array.from(corners.flatMap(([x, y]) => [x / 256, y / 256, 200])));
      const same = exact.every((b, i) => !!b === bytes[Math.floor(i / COLUMNS) * 320 + i % COLUMNS] > 0);
      parts.push(same ? " The engine covers the same pixels as the exact grid." : { b: " The engine covers different pixels.", warn: true });
    }
    say(...parts);
    boards.forEach((b) => b.board.repaint());
  }
  show();
}, true);
