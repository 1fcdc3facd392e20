// A lamp in front of a wall: light at corners beside light at each pixel.
import * as M from "./00-shared.js";

const [WIDTH, HEIGHT] = [144, 90];

// A spot light that shines straight at the wall: full light up to 25 degrees from its axis, none from 40 degrees on, and
// between the two the engine's soft edge. Takes the cosine of the angle.
const [INNER, OUTER] = [25, 40].map((degrees) => Math.cos(degrees * Math.PI / 180));
function cone(cosine) {
  const x = M.clamp(1 - (INNER - cosine) / (INNER - OUTER), 0, 1);
  return x * x * (3 - 2 * x);
}

// Light, 0 to 1, at a point of the wall (pixels) from a lamp at (lx, ly), `near` pixels before it.
// Body and highlight, with the engine's fall-off; the eye is far in front of the middle.
export function wallLight(x, y, lx, ly, isSpot = false, near = isSpot ? 52 : 26) {
  const [dx, dy] = [lx - x, ly - y];
  const d2 = dx * dx + dy * dy + near * near;
  const d = Math.sqrt(d2);
  const range = 110;
  const fall = d < range ? (1 - d2 / (range * range)) ** 2 * (isSpot ? cone(near / d) : 1) : 0;
  const [vx, vy, vz] = [WIDTH / 2 - x, HEIGHT / 2 - y, 220];
  const v = Math.hypot(vx, vy, vz);
  // The reflected ray: the light's direction with the part along the wall reversed.
  const along = (-dx * vx - dy * vy + near * vz) / (d * v);
  return Math.min(1, .07 + fall * (.55 * near / d + .4 * Math.max(0, along) ** 12));
}

// The wall cut into n × n squares of two triangles, lit at their corners: x and y in pixels, and a shade up to 255.
export function wallTriangles(n, lx, ly, isSpot) {
  const at = (i, j) => {
    const [x, y] = [i * WIDTH / n, j * HEIGHT / n];
    return [x, y, 255 * wallLight(x, y, lx, ly, isSpot)];
  };
  const triangles = [];
  for (let j = 0; j < n; j++) {
    for (let i = 0; i < n; i++) {
      const [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
      triangles.push([a, b, c], [a, c, d]);
    }
  }
  return triangles;
}

// Their bytes, in the upper left of the engine's frame of 320 columns.
function wallGouraud(engine, n, lx, ly, isSpot) {
  const frame = engine.triangles(Float64Array.from(wallTriangles(n, lx, ly, isSpot).flat(2)));
  return Uint8Array.from({ length: WIDTH * HEIGHT }, (_, i) => frame[Math.floor(i / WIDTH) * 320 + i % WIDTH]);
}

// Light at every pixel's centre, not rounded to a byte.
export function wallExact(lx, ly, isSpot) {
  return Float64Array.from({ length: WIDTH * HEIGHT }, (_, i) =>
    255 * wallLight(i % WIDTH + .5, Math.floor(i / WIDTH) + .5, lx, ly, isSpot));
}

M.figure("highlights", (stage, engine) => {
  if (!engine) {
    M.make("p", "fig-say fig-wait", stage, "The pictures follow when the engine is loaded.");
    return;
  }
  let [lx, ly, power, isSpot] = [62, 48, 0, false];
  const CUTS = [1, 2, 4, 8, 16, 32];
  const pair = M.make("div", "fig-pair", stage);
  let drawn = null;
  const copper = (b) => (Math.min(255, b * 5 >> 2) << 16) | (Math.min(255, b * 200 >> 8) << 8) | (b * 128 >> 8);
  const boards = ["Light at the corners", "Light at each pixel"].map((title, k) => {
    const side = M.make("div", "", pair);
    M.make("p", "fig-name", side, title);
    const board = M.board(side, {
      height: (w) => w * HEIGHT / WIDTH,
      paint(c, w, h) {
        M.pixels(c, drawn[k], WIDTH, HEIGHT, 0, 0, w, h, copper);
        if (k) return;
        const n = CUTS[power];
        if (n > 8) return;
        c.globalAlpha = .45;
        for (let i = 0; i <= n; i++) {
          M.line(c, [[i * w / n, 0], [i * w / n, h]], "#ffffff", 1);
          M.line(c, [[0, i * h / n], [w, i * h / n]], "#ffffff", 1);
          for (let j = 0; j < n && i < n; j++) M.line(c, [[i * w / n, j * h / n], [(i + 1) * w / n, (j + 1) * h / n]], "#ffffff", 1);
        }
        c.globalAlpha = 1;
      },
    });
    M.handle(board, {
      label: "Lamp", anywhere: true,
      at: () => [lx / WIDTH * board.width, ly / HEIGHT * board.height],
      move: (x, y) => put(x / board.width * WIDTH, y / board.height * HEIGHT),
      nudge: (dx, dy) => put(lx + 2 * dx, ly + 2 * dy),
      say: () => `column ${Math.round(lx)}, row ${Math.round(ly)}`,
    });
    return board;
  });
  const put = (x, y) => {
    [lx, ly] = [M.clamp(x, 0, WIDTH), M.clamp(y, 0, HEIGHT)];
    show();
  };
  const say = M.readout(stage);
  const bar = M.controls(stage);
  M.choice(bar, {
    label: "The lamp shines", options: [["round", "all round"], ["spot", "as a spot light"]], value: "round",
    input: (v) => ((isSpot = v === "spot"), show()),
  });
  M.slider(bar, {
    label: "Cut the wall", min: 0, max: CUTS.length - 1, value: power,
    format: (v) => `${CUTS[v]} × ${CUTS[v]}, ${M.group(2 * CUTS[v] ** 2)} triangles`,
    input: (v) => ((power = v), show()),
  });
  function show() {
    const n = CUTS[power];
    const exact = wallExact(lx, ly, isSpot);
    const gouraud = wallGouraud(engine, n, lx, ly, isSpot);
    drawn = [gouraud, Uint8Array.from(exact, (v) => Math.floor(v + .5))];
    let [worst, sum] = [0, 0];
    exact.forEach((v, i) => {
      const off = Math.abs(gouraud[i] - v);
      worst = Math.max(worst, off);
      sum += off;
    });
    boards[0].describe(`The wall lit at ${(n + 1) ** 2} corners; worst error ${worst.toFixed(1)} shades`);
    boards[1].describe("The wall lit at each pixel");
    say("Light is computed ", { b: `${M.group((n + 1) ** 2)} times` }, ` at corners, and ${M.group(WIDTH * HEIGHT)} times at pixels. `,
      "Worst pixel of the first: ", { b: `${worst.toFixed(1)} shades`, warn: worst > 8 }, ` off; mean ${(sum / exact.length).toFixed(1)}.`);
    boards.forEach((b) => b.repaint());
  }
  show();
}, true);
