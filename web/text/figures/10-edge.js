// Two triangles that share an edge, under four rules.
import * as M from "./00-shared.js";
import { grid, gridHandle, whereIsCentre } from "./09-centres.js";

// Adds 1 to every pixel that `rule` gives to a triangle: "top-left"; "both", where a centre on an
// edge counts as inside; "neither", where it does not; "slope", where each edge is walked in the
// triangle's own direction by a slope truncated to 1/16 pixel per row.
export function coverByRule(rule, corners, width, height, into = new Uint8Array(width * height)) {
  if (rule === "top-left") return M.coverExact(corners, width, height, into);
  if (rule === "slope") return coverSloped(corners, width, height, into);
  for (let i = 0; i < into.length; i++) {
    const where = whereIsCentre(corners, i % width, Math.floor(i / width));
    if (where > 0 || (where === 0 && rule === "both")) into[i]++;
  }
  return into;
}

function coverSloped(corners, width, height, into) {
  const { area } = M.sorted(corners);
  if (!area) return into;
  const [[ax, ay], [bx, by], [cx, cy]] = corners;
  const turned = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay) < 0;
  const v = turned ? [...corners].reverse() : corners;
  const ends = Array.from({ length: height }, () => []);
  v.forEach((p, i) => {
    const q = v[(i + 1) % 3];
    if (p[1] === q[1]) return;
    const slope = Math.trunc((q[0] - p[0]) * 16 / (q[1] - p[1])) / 16;
    const from = Math.max(M.firstCentre(Math.min(p[1], q[1])), 0);
    const to = Math.min(M.firstCentre(Math.max(p[1], q[1])), height);
    for (let y = from; y < to; y++) {
      ends[y].push(Math.ceil((p[0] + slope * (y * 256 + 128 - p[1]) - 128) / 256));
    }
  });
  ends.forEach((e, y) => {
    for (let x = Math.max(Math.min(...e), 0); x < Math.min(Math.max(...e), width); x++) into[y * width + x]++;
  });
  return into;
}

// Holes and double pixels of a quadrilateral p, a, q, b that is split along a–b. A hole is a pixel
// whose centre lies inside it and which neither triangle draws.
export function countSeam(rule, [p, a, q, b], width, height) {
  const drawn = coverByRule(rule, [p, a, b], width, height);
  coverByRule(rule, [q, b, a], width, height, drawn);
  const rim = [[p, a], [a, q], [q, b], [b, p]];
  const inside = (x, y) => rim.every(([s, t]) =>
    (t[0] - s[0]) * (y * 256 + 128 - s[1]) - (t[1] - s[1]) * (x * 256 + 128 - s[0]) > 0);
  let [holes, twice] = [0, 0];
  const marks = drawn.map((n, i) => {
    const hole = n === 0 && inside(i % width, Math.floor(i / width));
    if (hole) holes++;
    if (n > 1) twice++;
    return hole ? 1 : n > 1 ? 2 : 0;
  });
  return { drawn, marks, holes, twice };
}

M.figure("edge", (stage, engine) => {
  const [COLUMNS, ROWS] = [20, 12];
  const half = 128;
  const [p, q] = [[1 * 256, 6 * 256 + half], [19 * 256, 5 * 256 + half]];
  const [a, b] = [[14 * 256 + half, 1 * 256 + half], [5 * 256 + half, 10 * 256 + half]];
  const RULES = [["top-left", "by the top-left rule"], ["both", "to both"], ["neither", "to neither"], ["slope", "by a rounded slope"]];
  let rule = "both";
  const on = grid(COLUMNS, ROWS);
  const keep = () => {
    a[0] = M.clamp(a[0], 4 * 256, 16 * 256);
    b[0] = M.clamp(b[0], 4 * 256, 16 * 256);
    a[1] = M.clamp(a[1], 0, 4 * 256);
    b[1] = M.clamp(b[1], 8 * 256, ROWS * 256);
  };
  M.choice(stage, {
    label: "Pixels on the edge go", options: RULES, value: rule,
    input: (v) => ((rule = v), show()),
  });
  const board = M.board(stage, {
    height: (w) => on.height(w),
    paint(c, w, h, ink) {
      on.fit(w);
      on.clear(c, ink);
      const { drawn, marks } = countSeam(rule, [p, a, q, b], COLUMNS, ROWS);
      const first = coverByRule(rule, [p, a, b], COLUMNS, ROWS);
      drawn.forEach((n, i) => {
        const [x, y] = [i % COLUMNS, Math.floor(i / COLUMNS)];
        if (n === 1) {
          c.globalAlpha = .4;
          c.fillStyle = first[i] ? ink.accent : ink.second;
          on.fill(c, x, y);
          c.globalAlpha = 1;
        } else if (n > 1) {
          c.fillStyle = ink.ink;
          on.fill(c, x, y);
        }
      });
      on.lines(c, ink);
      const outline = (points, width) => M.line(c, points.map(([x, y]) => [on.x(x), on.y(y)]), ink.ink, width);
      outline([p, a, q, b, p], 1.2);
      outline([a, b], 3);
      marks.forEach((m, i) => {
        if (!m) return;
        const [x, y] = on.centre(i % COLUMNS, Math.floor(i / COLUMNS));
        c.beginPath();
        c.arc(x, y, on.cell * .3, 0, 7);
        c.lineWidth = 3;
        c.strokeStyle = m === 1 ? ink.warn : ink.paper;
        if (m === 1) c.stroke();
        else M.text(c, "2", x, y + on.cell * .2, ink.paper, { align: "center", font: `bold ${on.cell * .6}px ${ink.sans}` });
      });
    },
  });
  const changed = () => (keep(), show());
  gridHandle(board, on, a, { label: "Upper end of the shared edge", changed, limit: [COLUMNS, ROWS], snap: half });
  gridHandle(board, on, b, { label: "Lower end of the shared edge", changed, limit: [COLUMNS, ROWS], snap: half });
  const say = M.readout(stage);
  const bar = M.controls(stage);
  const table = M.make("table", "fig-table", stage);
  table.hidden = true;
  M.button(bar, "Try 1,000 random edges", () => {
    const sums = Object.fromEntries(RULES.map(([r]) => [r, [0, 0]]));
    const random = (low, high) => (low * 2 + Math.floor(Math.random() * (2 * (high - low) + 1))) * half;
    for (let n = 0; n < 1000; n++) {
      const [s, t] = [[random(4, 16), random(0, 4)], [random(4, 16), random(8, ROWS)]];
      for (const [r] of RULES) {
        const { holes, twice } = countSeam(r, [p, s, q, t], COLUMNS, ROWS);
        sums[r][0] += holes;
        sums[r][1] += twice;
      }
    }
    const rows = M.fillTable(table, ["1,000 edges", "holes", "drawn twice"],
      RULES.map(([r, name]) => [name, ...sums[r].map(M.group)]));
    rows[0].className = "on";
    table.hidden = false;
  });
  function show() {
    const { holes, twice } = countSeam(rule, [p, a, q, b], COLUMNS, ROWS);
    board.describe(`Two triangles on a grid: ${holes} holes, ${twice} pixels drawn twice`);
    const parts = [{ b: M.count(holes, "hole"), warn: holes > 0 }, " (ringed), ",
      { b: `${M.count(twice, "pixel")} drawn twice`, warn: twice > 0 }, " (black or white, marked 2)."];
    if (engine && rule === "top-left") {
      const flat = (t) => t.flatMap(([x, y]) => [x / 256, y / 256, 200]);
      const drawn = (t) => engine.triangles(Float64Array.from(flat(t))).reduce((n, byte) => n + (byte > 0), 0);
      const [one, two, all] = [[p, a, b], [q, b, a], [p, a, b, q, b, a]].map(drawn);
      parts.push(` The engine draws ${one} + ${two} = ${all} pixels${one + two === all ? ": none twice." : "?"}`);
    }
    say(...parts);
    board.repaint();
  }
  show();
}, true);
