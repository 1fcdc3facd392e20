// A ramp with two bends, and the lines that the eye sees there.
import * as M from "./00-shared.js";

// Mean over 2·radius + 1 positions; beyond the ends the last value continues.
function blur(values, radius) {
  const n = values.length;
  const at = (i) => values[M.clamp(i, 0, n - 1)];
  const out = new Float64Array(n);
  let sum = 0;
  for (let i = -radius; i <= radius; i++) sum += at(i);
  for (let i = 0; i < n; i++) {
    out[i] = sum / (2 * radius + 1);
    sum += at(i + radius + 1) - at(i - radius);
  }
  return out;
}

/**
 * Brightness, 0 to 1, along n places: level up to (x1, y1), straight to (x2, y2), level from there.
 * `soft` rounds the bends.
 * @param {number[]} left
 * @param {number[]} right
 * @param {number} n
 */
export function machProfile([x1, y1], [x2, y2], n, soft = false) {
  const sharp = Float64Array.from({ length: n }, (_, i) => {
    const x = i / (n - 1);
    return x <= x1 ? y1 : x >= x2 ? y2 : y1 + (y2 - y1) * (x - x1) / (x2 - x1);
  });
  if (!soft) return sharp;
  const radius = Math.max(1, Math.round((x2 - x1) * n * .2));
  return blur(blur(sharp, radius), radius);
}

// A simple model of the eye: each point, and how it differs from its surroundings.
export function machSeen(profile) {
  const radius = Math.round(profile.length * .045);
  const around = blur(blur(profile, radius), radius);
  return profile.map((v, i) => v + 5 * (v - around[i]));
}

M.figure("mach", (stage, engine) => {
  const knees = [[.36, .25], [.64, .75]];
  let soft = false;
  const [STRIP, PAD] = [110, 14];
  const n = 640;
  const board = M.board(stage, {
    height: () => STRIP + 150,
    paint(c, width, h, ink) {
      const profile = machProfile(knees[0], knees[1], n, soft);
      M.pixels(c, profile.map((v) => Math.round(v * 255)), n, 1, 0, 0, width, STRIP);
      const y = (v) => STRIP + PAD + (1 - v) * (h - STRIP - 2 * PAD);
      const curve = (values) => [...values].map((v, i) => [i / (n - 1) * width, y(v)]);
      c.fillStyle = ink.paper;
      c.fillRect(0, STRIP + 4, width, h - STRIP - 4);
      M.line(c, curve(profile), ink.accent, 3);
      M.line(c, curve(machSeen(profile)), ink.second, 1.5);
      M.text(c, "in the picture", 8, y(knees[0][1]) + (knees[0][1] < .5 ? -12 : 24), ink.accent);
      M.text(c, "as seen", width - 8, y(knees[1][1]) + (knees[1][1] > .5 ? 24 : -12), ink.second, { align: "right" });
    },
  });
  const place = (i, x, y) => {
    knees[i] = [i ? M.clamp(x, knees[0][0] + .02, .97) : M.clamp(x, .03, knees[1][0] - .02), M.clamp(y, 0, 1)];
    show();
  };
  knees.forEach((_, i) => M.handle(board, {
    label: i ? "Right bend" : "Left bend",
    at: () => [knees[i][0] * board.width, STRIP + PAD + (1 - knees[i][1]) * (board.height - STRIP - 2 * PAD)],
    move: (x, y) => place(i, x / board.width, 1 - (y - STRIP - PAD) / (board.height - STRIP - 2 * PAD)),
    nudge: (dx, dy) => place(i, knees[i][0] + dx / 100, knees[i][1] - dy / 100),
    say: () => `at ${Math.round(knees[i][0] * 100)} %, brightness ${Math.round(knees[i][1] * 255)}`,
  }));
  M.choice(stage, {
    label: "Bends", options: [["sharp", "as Gouraud has them"], ["soft", "rounded"]], value: "sharp",
    input: (v) => ((soft = v === "soft"), show()),
  });
  const say = M.readout(stage);
  function show() {
    const profile = machProfile(knees[0], knees[1], n, soft);
    const seen = machSeen(profile);
    const over = Math.max(...seen.map((v, i) => Math.abs(v - profile[i]))) * 255;
    board.describe(`A strip of brightness with two bends; the model sees lines of ${Math.round(over)} shades there`);
    say("No pixel differs from its neighbour by more than ",
      { b: `${(Math.max(...profile.slice(1).map((v, i) => Math.abs(v - profile[i]))) * 255).toFixed(1)} shades` },
      "; the model sees lines of ", { b: `${Math.round(over)} shades` }, ".");
    board.repaint();
  }
  show();
  if (engine) cone(stage, engine);
}, true);

// The engine's cone, where the bends are real, beside a cone of many slices.
function cone(stage, engine) {
  const few = engine.shipped.find((s) => s.name === "cone").toml;
  const many = few.replace("subdivisions = [9, 1]", "subdivisions = [90, 1]");
  const pair = M.make("div", "fig-pair", stage);
  const frames = [];
  const boards = [["A cone of 9 slices", few], ["A cone of 90 slices", many]].map(([title, toml], i) => {
    const board = M.frame(pair, title, () => frames[i]);
    board.describe(`${title}, drawn by the engine`);
    return { scene: engine.open(toml), board };
  });
  const draw = (frame) => boards.forEach(({ scene, board }, i) => {
    frames[i] = scene.render({ frame });
    board.repaint();
  });
  M.slider(M.controls(stage), {
    label: "Turn the cone", min: 0, max: 139, value: 0, format: (v) => `${Math.round(v / 140 * 360)}°`, input: draw,
  });
  draw(0);
}
