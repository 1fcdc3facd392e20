// The budget on the cut through a round body: a bound for each face decides how it is drawn.
import { FIRST_POSE } from "../../page/engine.js";
import { msText, Stopwatch } from "../../page/stopwatch.js";
import * as M from "./00-shared.js";

const [AMBIENT, BODY, SHINE, POWER] = [20, 150, 80, 24];
const HALF_TURN = Math.PI;

// Light, 0 to 250 shades, where the normal is at `theta`; the sun at `sun`, the eye at 0.
export function roundLight(theta, sun) {
  const nl = Math.cos(theta - sun);
  const c = Math.cos(2 * theta - sun);
  return AMBIENT + BODY * Math.max(0, nl) + (nl > 0 ? SHINE * Math.max(0, c) ** POWER : 0);
}

// Maximum of |cos| of angles a to b; b − a is less than π.
const maxCos = (a, b) =>
  Math.floor(b / HALF_TURN) > Math.floor(a / HALF_TURN) || a % HALF_TURN === 0 ? 1 : Math.max(Math.abs(Math.cos(a)), Math.abs(Math.cos(b)));
// Range of cos from a to b.
function rangeOfCos(a, b) {
  const holds = (at) => Math.floor((b - at) / (2 * HALF_TURN)) >= Math.ceil((a - at) / (2 * HALF_TURN));
  const ends = [Math.cos(a), Math.cos(b)];
  return [holds(HALF_TURN) ? -1 : Math.min(...ends), holds(0) ? 1 : Math.max(...ends)];
}

// By how much, in shades, light can differ from straight shades between the angles a and b, at
// most. It evaluates no light between them: an eighth of the squared width times the greatest second
// derivative, plus the clamp at the edge of the light (Lemmas 2 and 3 of docs/budget.md).
// Half a shade is for the byte. For |sun| < 90 degrees, where the highlight ends before the light.
export function linearBound(a, b, sun) {
  const w = (b - a) * (b - a) / 8;
  const u = [Math.cos(a - sun), Math.cos(b - sun)];
  const k = w * maxCos(a - sun, b - sun);
  const [P, S] = [Math.max(0, ...u), Math.max(0, -Math.min(...u))];
  const body = Math.max(...u) + k <= 0 ? 0 : k + (P + S > 0 ? P * S / (P + S) : 0);
  const [low, high] = rangeOfCos(2 * a - sun, 2 * b - sun).map((c) => Math.max(0, c));
  // H = cˢ bends by s·(s − 1)·c^(s−2) − s²·cˢ: greatest at an end or at c² = (s − 1)(s − 2)/s².
  const bend = (c) => Math.abs(POWER * (POWER - 1) * c ** (POWER - 2) - POWER * POWER * c ** POWER);
  const turn = Math.sqrt((POWER - 1) * (POWER - 2)) / POWER;
  const maxBend = Math.max(bend(low), bend(high), low < turn && turn < high ? bend(turn) : 0);
  const shine = Math.min(4 * w * maxBend, high ** POWER - low ** POWER);
  return BODY * body + SHINE * shine + .5;
}

// The cut in `faces` faces and `pixels` pixels within E shades: each face's method, the bytes,
// and how far each pixel is from exact light.
export function budgetRow(faces, pixels, sun, E) {
  const angle = (x) => (x / pixels - .5) * HALF_TURN;
  const bytes = new Uint8Array(pixels);
  const errors = new Float64Array(pixels);
  let lit = 0;
  const list = Array.from({ length: faces }, (_, i) => {
    const [x0, x1] = [i * pixels / faces, (i + 1) * pixels / faces];
    const [a, b] = [angle(x0), angle(x1)];
    const bound = linearBound(a, b, sun);
    const straight = bound <= E;
    const [s, t] = [roundLight(a, sun), roundLight(b, sun)];
    const linear = (x) => s + (t - s) * (x - x0) / (x1 - x0);
    let worst = 0;
    const [first, end] = [Math.ceil(x0 - .5), Math.ceil(x1 - .5)];
    lit += straight ? 2 : end - first;
    for (let p = first; p < end; p++) {
      const exact = roundLight(angle(p + .5), sun);
      const nearest = (v) => Math.floor(v + .5);
      worst = Math.max(worst, Math.abs(nearest(linear(p + .5)) - exact));
      bytes[p] = nearest(straight ? linear(p + .5) : exact);
      errors[p] = Math.abs(bytes[p] - exact);
    }
    return { x0, x1, bound, straight, worst };
  });
  return { list, bytes, errors, lit, worst: Math.max(...errors) };
}

M.figure("budget", (stage, engine) => {
  const PIXELS = 320;
  const [LOW, HIGH] = [.5, 128];
  let [E, faces, sun] = [4, 16, .5];
  const [STRIP, LEFT] = [34, 34];
  const plot = { top: STRIP + 34, bottom: 0 };
  const y = (s) => plot.bottom - Math.log(Math.max(s, LOW) / LOW) / Math.log(HIGH / LOW) * (plot.bottom - plot.top);
  const back = (at) => LOW * (HIGH / LOW) ** ((plot.bottom - at) / (plot.bottom - plot.top));
  const board = M.board(stage, {
    height: () => 300,
    paint(c, w, h, ink) {
      plot.bottom = h - 22;
      const { list, bytes } = budgetRow(faces, PIXELS, sun, E);
      const x = (p) => LEFT + p / PIXELS * (w - LEFT - 2);
      M.pixels(c, bytes, PIXELS, 1, LEFT, 0, w - LEFT - 2, STRIP);
      for (const f of list) {
        c.fillStyle = f.straight ? ink.second : ink.accent;
        c.fillRect(x(f.x0) + .5, STRIP + 3, x(f.x1) - x(f.x0) - 1, 5);
      }
      for (const s of [.5, 1, 2, 4, 8, 16, 32, 64, 128]) {
        M.line(c, [[LEFT, y(s)], [w - 2, y(s)]], ink.line);
        M.text(c, s === .5 ? "½" : String(s), LEFT - 6, y(s) + 4, ink.muted, { align: "right" });
      }
      for (const f of list) {
        const [left, width] = [x(f.x0) + 1.5, x(f.x1) - x(f.x0) - 3];
        c.fillStyle = f.straight ? ink.second : ink.accent;
        c.globalAlpha = .75;
        c.fillRect(left, y(f.worst), width, plot.bottom - y(f.worst));
        c.globalAlpha = 1;
        c.strokeStyle = f.straight ? ink.second : ink.accent;
        c.lineWidth = 1.5;
        c.strokeRect(left, y(f.bound), width, plot.bottom - y(f.bound));
      }
      M.line(c, [[LEFT, y(E)], [w - 2, y(E)]], ink.ink, 2.5);
      M.text(c, `E = ${E.toFixed(1)}`, w - 6, y(E) - 8, ink.ink, { align: "right", font: `bold 13px ${ink.sans}` });
      M.text(c, "shades", 0, plot.top - 12, ink.muted);
      M.text(c, "straight shades", LEFT, h - 5, ink.second);
      M.text(c, "light at each pixel", w - 2, h - 5, ink.accent, { align: "right" });
    },
  });
  const put = (v) => {
    E = M.clamp(Math.round(v * 10) / 10, LOW + .1, HIGH);
    show();
  };
  M.handle(board, {
    label: "E, the allowed error", kind: "level", anywhere: true,
    at: () => [LEFT + 24, y(E)],
    move: (px, py) => put(back(py)),
    nudge: (dx, dy) => put(Math.abs(E) * 1.1 ** (dx - dy) + (dx - dy) * .05),
    say: () => `${E.toFixed(1)} shades`,
  });
  const say = M.readout(stage);
  const bar = M.controls(stage);
  M.slider(bar, { label: "Faces around half the body", min: 4, max: 64, value: faces, input: (v) => ((faces = v), show()) });
  M.slider(bar, {
    label: "Position of the sun", min: -80, max: 80, value: Math.round(sun * 180 / HALF_TURN),
    format: (v) => `${v}°`, input: (v) => ((sun = v / 180 * HALF_TURN), show()),
  });
  const real = engine ? reality(stage, engine) : () => {};
  if (!engine) M.make("p", "fig-say fig-wait", stage, "The engine’s picture follows when it is loaded.");
  function show() {
    const { list, lit, worst } = budgetRow(faces, PIXELS, sun, E);
    const pixelwise = list.filter((f) => !f.straight).length;
    board.describe(`${faces} faces with their bounds; ${pixelwise} are lit at each pixel; worst pixel ${worst.toFixed(2)} shades`);
    say(`${M.count(faces - pixelwise, "face")} straight, ${pixelwise} lit at each pixel. Light is computed `, { b: `${lit} times` },
      ` instead of ${PIXELS}. Worst pixel: `, { b: `${worst.toFixed(2)} shades` }, `, promised ${E.toFixed(1)}.`);
    board.repaint();
    real(E);
  }
  show();
}, true);

// The engine's own picture within E shades, its error, and its time.
function reality(stage, engine) {
  const scene = engine.open((engine.shipped.find((s) => s.name === "phong") ?? engine.shipped[0]).toml);
  const frame = 45;
  const truth = scene.exact({ frame });
  let [picture, E] = [null, 4];
  const pair = M.make("div", "fig-pair", stage);
  const shown = M.frame(pair, "The engine within E", () => picture);
  const off = M.frame(pair, "Its error: bright is E", () => picture, (b, i) => {
    const t = Math.min(1, Math.abs(b - truth.bytes[i]) / Math.max(E, 1)) * 255;
    return (t << 16) | ((t * .7) << 8) | (t * .4);
  });
  const say = M.readout(stage);
  let worst = 0;
  const tell = (...more) => say("Worst pixel of the picture: ", { b: M.count(worst, "shade") },
    " from double precision, both rounded. ", ...more);
  // Both in turn, so that other load on the machine affects both.
  M.button(M.controls(stage), "Measure the time here", () => {
    const watches = [{ maxError: E }, { shading: "phong" }].map((way) => ({ way, watch: new Stopwatch() }));
    for (let round = 0; round < 6; round++) {
      for (const { way, watch } of watches) {
        scene.set(way);
        watch.add(...Stopwatch.laps(scene, frame / 35, FIRST_POSE, 3));
      }
    }
    const [within, lit] = watches.map(({ watch }) => msText(watch.ms));
    tell("A frame takes ", { b: within }, `; lit at every pixel it takes ${lit}. Lower quartiles of 18 laps.`);
  });
  let asked = 0;
  return (budget) => {
    E = budget;
    cancelAnimationFrame(asked);
    asked = requestAnimationFrame(() => {
      picture = scene.render({ frame, maxError: E });
      worst = picture.bytes.reduce((m, b, i) => Math.max(m, Math.abs(b - truth.bytes[i])), 0);
      shown.describe(`A torus drawn within ${E} shades`);
      off.describe(`Its error, at most ${worst} shades`);
      tell();
      shown.repaint();
      off.repaint();
    });
  };
}
