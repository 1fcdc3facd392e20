// Tests of the text and its figures: node web/text/test.mjs
// The figures' results are compared with slow oracles in BigInt or in doubles.
import assert from "node:assert/strict";
import { test } from "node:test";
import { readFileSync, readdirSync } from "node:fs";

const here = new URL(".", import.meta.url);
const read = (name) => readFileSync(new URL(name, here), "utf8");
const files = readdirSync(new URL("figures/", here)).filter((f) => /^\d.*\.js$/.test(f)).sort();
const sources = files.map((f) => [f, read(`figures/${f}`)]);
const html = read("text.html");
const css = read("text.css");
const M = {};
for (const file of files) Object.assign(M, await import(`./figures/${file}`));

let seed = 1;
const random = () => {
  seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0;
  return seed / 2 ** 32;
};
const integer = (low, high) => low + Math.floor(random() * (high - low + 1));
const times = (n, f) => {
  for (let i = 0; i < n; i++) f(i);
};
const floor = (n, d) => (n >= 0n ? n / d : -((-n + d - 1n) / d));
const ceil = (n, d) => -floor(-n, d);
const big = (corner) => corner.map(BigInt);

const tests = {
  "the loop is (shade + k·step) mod 65,536 / 256"() {
    times(2000, () => {
      const [ax, bx, cx] = [integer(0, 65535), integer(0, 65535), integer(0, 40)];
      const expected = Array.from({ length: cx }, (_, k) => Number(((BigInt(ax) + BigInt(k) * BigInt(bx)) % 65536n) >> 8n));
      assert.deepEqual([...M.spanBytes(ax, bx, cx)], expected);
      const end = M.loopState(ax, bx, cx, 5 * cx);
      assert.deepEqual(end.row, expected);
      assert.ok(end.over && end.cx === 0 && end.edi === 0xA0000 + cx);
      const before = M.loopState(ax, bx, cx, 5 * cx - 1);
      assert.ok(cx === 0 || !before.over);
    });
  },

  "the carry is that of AL"() {
    times(2000, () => {
      const [ax, bx] = [integer(0, 65535), integer(0, 65535)];
      const { ax: sum, carry } = M.loopState(ax, bx, 2, 3);
      assert.equal(carry, (sum >> 8) !== (((ax >> 8) + (bx >> 8)) & 255));
    });
  },

  "half a shade gives the nearest byte, nothing gives the one below"() {
    times(1000, () => {
      const [start, step] = [integer(0x2000, 0x4000), integer(-64, 64)];
      const half = M.halfErrors(start, step, 64, 128);
      assert.ok(half.worst <= .5, `${half.worst}`);
      const none = M.halfErrors(start, step, 64, 0);
      assert.ok(none.errors.every((e) => e <= 0 && e > -1));
    });
    assert.ok(Math.abs(M.halfErrors(0x1400, 1, 256, 128).mean) < .01);
    assert.ok(Math.abs(M.halfErrors(0x1400, 1, 256, 0).mean + .5) < .01);
  },

  "exact cover is that of three edge functions with the top-left rule"() {
    let [on, covered] = [0, 0];
    times(1500, (n) => {
      const snap = [1, 16, 64, 128][n % 4];
      const corners = Array.from({ length: 3 }, () => [integer(-512 / snap, 4608 / snap) * snap, integer(-512 / snap, 3584 / snap) * snap]);
      // Some have no area.
      if (n % 50 === 0) corners[2] = corners[n % 100 ? 0 : 1];
      const cover = M.coverExact(corners, 16, 12);
      for (let i = 0; i < cover.length; i++) {
        const [where, inside] = slowCover(corners, i % 16, Math.floor(i / 16));
        assert.equal(cover[i], inside ? 1 : 0, JSON.stringify([corners, i]));
        assert.equal(M.whereIsCentre(corners, i % 16, Math.floor(i / 16)), area(corners) ? where : -1);
        on += where === 0;
        covered += inside;
      }
    });
    assert.ok(on > 500 && covered > 10000, `${on} on edges, ${covered} covered`);
  },

  "the period's rows are those of one addition a row"() {
    let pixels = 0;
    times(1500, () => {
      const corners = Array.from({ length: 3 }, () => [integer(-512, 4608), integer(-512, 3584)]);
      const cover = M.coverVintage(corners, 16, 12);
      const expected = slowVintage(corners, 16, 12);
      assert.deepEqual([...cover], expected, JSON.stringify(corners));
      pixels += expected.reduce((a, b) => a + b);
    });
    assert.ok(pixels > 10000);
  },

  "neighbours share no pixel and leave none under the top-left rule alone"() {
    const sums = {};
    for (const rule of ["top-left", "both", "neither", "slope"]) {
      sums[rule] = [0, 0];
      times(400, () => {
        const half = (low, high) => integer(low * 2, high * 2) * 128;
        const quad = [[256, 1664], [half(4, 16), half(0, 4)], [19 * 256, 1408], [half(4, 16), half(8, 12)]];
        const { holes, twice } = M.countSeam(rule, quad, 20, 12);
        sums[rule][0] += holes;
        sums[rule][1] += twice;
      });
    }
    assert.deepEqual(sums["top-left"], [0, 0]);
    assert.ok(sums.both[0] === 0 && sums.both[1] > 100, `${sums.both}`);
    assert.ok(sums.neither[0] > 100 && sums.neither[1] === 0, `${sums.neither}`);
    assert.ok(sums.slope[0] > 10 && sums.slope[1] > 10, `${sums.slope}`);
  },

  "a step toward zero keeps every byte in range, a step away does not"() {
    let wrapped = 0;
    times(3000, () => {
      const [a, b, w] = [integer(0, 255) * 256, integer(0, 255) * 256, integer(2, 320)];
      const zero = M.rowSums(a, b, w, "zero");
      assert.equal(zero.outside, 0);
      const k = integer(0, w - 1);
      const step = BigInt(b - a) / BigInt(w - 1);
      assert.equal(BigInt(zero.step), step);
      const drift = Number((step * BigInt(w - 1) - BigInt(b - a)) * BigInt(k)) / (w - 1);
      assert.ok(Math.abs(zero.drift[k] - drift) < 1e-6);
      wrapped += M.rowSums(a, b, w, "away").outside;
    });
    assert.ok(wrapped > 1000, `${wrapped}`);
    assert.equal(M.rowSums(200 * 256, 255 * 256, 320, "away").bytes[319], 0);
  },

  "lags stay below what the text says"() {
    let [max, maxReseeded] = [0, 0];
    times(1500, () => {
      const [a, b, w] = [integer(0, 255) * 256, integer(0, 255) * 256, integer(2, 320)];
      for (const [bits, reseed] of [[8, w], [8, 64], [16, w]]) {
        const { lag, sums, bytes } = M.rowDrift(a, b, w, bits, reseed);
        const unit = BigInt(2 ** (bits - 8));
        const [delta, n] = [BigInt(b - a) * unit, BigInt(w - 1)];
        const step = delta / n;
        for (let k = 0; k < w; k++) {
          const from = Math.floor(k / reseed) * reseed;
          const start = BigInt(a) * unit + (delta < 0n ? ceil : floor)(delta * BigInt(from), n);
          const sum = start + step * BigInt(k - from);
          assert.equal(sums[k] * 2 ** bits, Number(sum));
          assert.equal(bytes[k], Number((sum + (1n << BigInt(bits - 1))) >> BigInt(bits)));
          assert.ok(lag[k] < (k - from + 1) / 2 ** bits);
          const exact = (a + (b - a) * k / (w - 1)) / 256;
          assert.ok(Math.abs(Math.abs(exact - sums[k]) - lag[k]) < 1e-9);
          if (bits === 8 && reseed === w) max = Math.max(max, lag[k]);
          if (reseed === 64) maxReseeded = Math.max(maxReseeded, lag[k]);
        }
      }
    });
    assert.ok(max > 1 && max < 1.25, `${max}`);
    assert.ok(maxReseeded > .2 && maxReseeded < .25, `${maxReseeded}`);
  },

  "the eye's model adds nothing to what is straight, and lines to what is bent"() {
    const flat = M.machProfile([.3, .5], [.6, .5], 500);
    M.machSeen(flat).forEach((v, i) => assert.ok(Math.abs(v - flat[i]) < 1e-9));
    const lines = (soft) => {
      const p = M.machProfile([.35, .2], [.65, .8], 640, soft);
      assert.ok(Math.abs(p[0] - .2) < 1e-9 && Math.abs(p[639] - .8) < 1e-9);
      const seen = M.machSeen(p);
      return Math.max(...seen.map((v, i) => Math.abs(v - p[i])));
    };
    assert.ok(lines(false) > .05 && lines(true) < lines(false) / 2);
    const p = M.machProfile([.35, .2], [.65, .8], 640);
    const seen = M.machSeen(p);
    assert.ok(seen[Math.round(.35 * 639)] < .19 && seen[Math.round(.65 * 639)] > .81);
  },

  "the wall is where a ray from the eye hits it"() {
    for (const ratio of [1.25, 2, 6, 16]) {
      const { us, vs } = M.wallTexels(ratio, "exact");
      const every = M.wallTexels(ratio, "every16");
      const affine = M.wallTexels(ratio, "affine");
      const K = 316 / (1 - 1 / ratio);
      let [hit, off, offAffine] = [0, 0, 0];
      for (let i = 0; i < us.length; i++) {
        assert.equal(Number.isNaN(us[i]), Number.isNaN(every.us[i]));
        if (Number.isNaN(us[i])) continue;
        hit++;
        // Column x shows the distance w with x = 2 + K·(1 − 1/w).
        const w = 1 / (1 - (i % 320 + .5 - 2) / K);
        const u = (w - 1) / (ratio - 1) * 256;
        const v = ((Math.floor(i / 320) + .5 - 64) * w / 62 + 1) / 2 * 256;
        assert.ok(Math.abs(us[i] - u) < 1e-6 && Math.abs(vs[i] - v) < 1e-6, `${[ratio, i, us[i], u, vs[i], v]}`);
        off = Math.max(off, Math.abs(every.us[i] - u), Math.abs(every.vs[i] - v));
        offAffine = Math.max(offAffine, Math.abs(affine.us[i] - u), Math.abs(affine.vs[i] - v));
      }
      assert.ok(hit > 10000 && off < offAffine && affine.divisions === 0, `${[ratio, hit, off, offAffine]}`);
      // Dividing at every 16th pixel is cheaper, but its error is visible.
      assert.ok(ratio < 6 || off > 2, `${[ratio, off]}`);
      assert.ok(every.divisions * 8 < M.wallTexels(ratio, "exact").divisions);
    }
  },

  "a depth buffer shows the nearest triangle at every pixel"() {
    let wrong = 0;
    times(60, () => {
      const corner = () => [integer(0, 64) + .5, integer(0, 40) + .25, 1 + random()];
      const triangles = [0, 1].map(() => [corner(), corner(), corner()]);
      if (triangles.some((t) => !area(t))) return;
      const { shown } = M.hidden(triangles, "buffer", 64, 40);
      const painter = M.hidden(triangles, "painter", 64, 40).shown;
      for (let i = 0; i < shown.length; i++) {
        const [x, y] = [i % 64, Math.floor(i / 64)];
        const near = triangles
          .map((t, k) => ({ k: k + 1, in: slowCover(t.map(([a, b]) => [a * 256, b * 256]), x, y)[1], z: slowDepth(t, x + .5, y + .5) }))
          .filter((t) => t.in).sort((p, q) => p.z - q.z);
        if (near.length < 2 || near[1].z - near[0].z > 1e-9) assert.equal(shown[i], near[0]?.k ?? 0);
        wrong += shown[i] !== painter[i];
      }
    });
    assert.ok(wrong > 100, `${wrong}`);
  },

  "finer walls come nearer to light at each pixel, by the square"() {
    const exact = M.wallExact(60, 40);
    const worst = [2, 4, 8, 16, 32].map((n) => {
      const triangles = M.wallTriangles(n, 60, 40);
      assert.equal(triangles.length, 2 * n * n);
      // Shades linear over each triangle, at every pixel's centre.
      let off = 0;
      for (const [[x0, y0, s0], [x1, y1, s1], [x2, y2, s2]] of triangles) {
        const area = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0);
        for (let y = Math.floor(Math.min(y0, y1, y2)); y < Math.max(y0, y1, y2) && y < 90; y++) {
          for (let x = Math.floor(Math.min(x0, x1, x2)); x < Math.max(x0, x1, x2) && x < 144; x++) {
            const [dx, dy] = [x + .5 - x0, y + .5 - y0];
            const [b, c] = [(dx * (y2 - y0) - (x2 - x0) * dy) / area, ((x1 - x0) * dy - dx * (y1 - y0)) / area];
            if (b >= 0 && c >= 0 && b + c <= 1) off = Math.max(off, Math.abs(s0 + b * (s1 - s0) + c * (s2 - s0) - exact[y * 144 + x]));
          }
        }
      }
      return off;
    });
    assert.ok(worst.every((w, i) => !i || w <= worst[i - 1]), `${worst}`);
    const ratio = worst[3] / worst[4];
    assert.ok(ratio > 3 && ratio < 5, `${worst}`);
    for (let i = 0; i < 144; i++) {
      for (const spot of [false, true]) assert.ok(M.wallLight(i, 30, 60, 40, spot) >= 0 && M.wallLight(i, 30, 60, 40, spot) <= 1);
    }
    // A spot light: full light on its axis, less on its soft edge, and only ambient light beyond.
    const [inside, edge] = [10, 33].map((off) => M.wallLight(60 + off, 40, 60, 40, true) / M.wallLight(60 + off, 40, 60, 40, false, 52));
    assert.ok(inside === 1 && edge > .2 && edge < .8 && M.wallLight(105, 40, 60, 40, true) === .07, `${inside} ${edge}`);
  },

  "no true error is above its bound"() {
    let [tightest, straight] = [Infinity, 0];
    times(4000, () => {
      const sun = (random() - .5) * 160 / 180 * Math.PI;
      const width = Math.PI / integer(4, 64);
      const a = -Math.PI / 2 + random() * (Math.PI - width);
      const bound = M.linearBound(a, a + width, sun);
      const [s, t] = [M.roundLight(a, sun), M.roundLight(a + width, sun)];
      let off = 0;
      for (let i = 0; i <= 64; i++) off = Math.max(off, Math.abs(s + (t - s) * i / 64 - M.roundLight(a + width * i / 64, sun)));
      assert.ok(off + .5 <= bound + 1e-9, `${[a, width, sun, off, bound]}`);
      tightest = Math.min(tightest, bound - .5 - off);
      straight += bound < 4;
    });
    // The bound is tight enough to decide something, not always far above.
    assert.ok(tightest < .05 && straight > 1000, `${[tightest, straight]}`);
  },

  "no pixel of the row is beyond E"() {
    let lit = 0;
    for (const E of [.6, 1, 2, 4, 8, 16, 64]) {
      for (let faces = 4; faces <= 64; faces += 3) {
        for (let sun = -80; sun <= 80; sun += 16) {
          const row = M.budgetRow(faces, 320, sun / 180 * Math.PI, E);
          assert.ok(row.worst <= E, `${[E, faces, sun, row.worst]}`);
          lit += row.lit;
        }
      }
    }
    assert.ok(lit > 1000);
  },

  "a fade is the card's, and no channel has more than 64 levels"() {
    for (let v = 0; v < 256; v++) {
      const levels = new Set();
      for (let t = 0; t <= 256; t++) {
        const level = Number((BigInt(v) * BigInt(256 - t)) >> 10n);
        assert.equal(M.faded(v, t), level);
        levels.add(level);
      }
      assert.ok(levels.size <= 64);
      if (v === 255) assert.equal(levels.size, 64);
    }
    for (let s = 0; s < 64; s++) assert.equal(M.toDac6(M.dac6To8(s)), s);
    assert.equal(M.dac6To8(63), 255);
  },

  "floors of quotients are exact"() {
    times(20000, () => {
      const d = integer(1, 2 ** integer(1, 52));
      const max = Math.floor((2 ** 53 - 2) / d);
      const n = integer(-max, max) * d + integer(-1, 1);
      assert.equal(BigInt(M.floorDiv(n, d)), floor(BigInt(n), BigInt(d)));
      assert.equal(BigInt(M.ceilDiv(n, d)), ceil(BigInt(n), BigInt(d)));
    });
  },

  "each figure of the text has its file, and the reverse, in order"() {
    const inText = [...html.matchAll(/data-figure="([^"]*)"/g)].map((m) => m[1]);
    const inFiles = files.slice(1).map((f) => f.replace(/^\d\d-|\.js$/g, ""));
    assert.deepEqual(inText, inFiles);
    assert.deepEqual([...M.registered.keys()], inFiles);
    assert.equal(inText.length, 12);
    files.forEach((f, i) => assert.equal(+f.slice(0, 2), i));
    assert.deepEqual([...read("figures/all.js").matchAll(/^import "\.\/(.*)";$/gm)].map((m) => m[1]), files.slice(1));
  },

  "each section has a title, 60 to 140 words, a figure and its caption"() {
    const sections = [...html.matchAll(/<section class="lesson[^"]*" id="([a-z]+)">(.*?)<\/section>/gs)];
    assert.equal(sections.length, 13);
    assert.equal(new Set(sections.map((s) => s[1])).size, 13);
    for (const [, id, body] of sections) {
      const words = body.replace(/<h2>.*?<\/h2>|<figure.*?<\/figure>/gs, "").replace(/<[^>]+>/g, " ").split(/\s+/).filter((w) => /\w/.test(w));
      assert.ok(words.length >= 60 && words.length <= 140, `${id}: ${words.length} words`);
      assert.match(body, /<h2>[^<]+<\/h2>/);
      if (id !== "limits") {
        const [, name, caption] = body.match(/<figure class="lesson-figure" data-figure="(\w+)"><figcaption>(.+)<\/figcaption><\/figure>/);
        assert.equal(name, id);
        assert.ok(caption.length > 40);
      }
      const sentences = body.replace(/<h2>.*?<\/h2>/s, "").replace(/<[^>]+>/g, " ").split(/[.:?!]\s+/);
      for (const s of sentences) {
        assert.doesNotMatch(s.trim(), /^(The same|As |Of |And )/, s);
        assert.ok(s.split(/\s+/).length <= 32, `${id}: ${s}`);
      }
    }
    const listed = [...html.matchAll(/<li><a href="#(\w+)">(.*?)<\/a>/g)].map((m) => [m[1], m[2]]);
    assert.deepEqual(listed, sections.map(([, id, body]) => [id, body.match(/<h2>(.*?)<\/h2>/)[1]]));
    const taken = [...read("../page/index.html").matchAll(/ id="([^"]+)"/g)].map((m) => m[1]);
    assert.deepEqual(sections.map((s) => s[1]).filter((id) => taken.includes(id)), []);
    const tags = [...html.matchAll(/<(\/?)([a-z0-9]+)[^>]*>/g)];
    const open = [];
    for (const [, close, tag] of tags) close ? assert.equal(open.pop(), tag) : open.push(tag);
    assert.deepEqual(open, []);
  },

  "nothing is loaded from anywhere"() {
    for (const [name, text] of [["text.html", html], ["text.css", css], ...sources]) {
      assert.doesNotMatch(text, /https?:|\bsrc=|@import|url\(|\bfetch\(|XMLHttpRequest|\bimport\(|from "(?!\.)|\beval\(|innerHTML/, name);
    }
  },

  "nothing moves by itself"() {
    assert.doesNotMatch(css, /animation|transition|@keyframes/);
    for (const [name, source] of sources) assert.doesNotMatch(source, /setInterval|setTimeout|\.animate\(|behavior: "smooth"/, name);
  },

  "all of it is below 95 kB, without indentation and comments"() {
    const pieces = [...sources.map(([, s]) => s.replace(/^ +/gm, "").replace(/^\/\/.*\n/gm, "")), html, css];
    const size = Buffer.byteLength(pieces.join(""));
    assert.ok(size < 95_000, `${size}`);
  },
};

// ---- oracles ----

function area([a, b, c]) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
}

// Where a pixel's centre lies (1 inside, 0 on an edge, −1 outside), and whether it is covered.
function slowCover(corners, px, py) {
  let [a, b, c] = corners.map(([x, y]) => big([x, y]));
  const doubled = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
  if (doubled === 0n) return [-1, false];
  // Clockwise on a screen whose y runs down.
  if (doubled < 0n) [b, c] = [c, b];
  const [x, y] = [BigInt(px) * 256n + 128n, BigInt(py) * 256n + 128n];
  let [where, inside] = [1, true];
  for (const [p, q] of [[a, b], [b, c], [c, a]]) {
    const [dx, dy] = [q[0] - p[0], q[1] - p[1]];
    const e = dx * (y - p[1]) - dy * (x - p[0]);
    // A left edge goes up, a top edge is level and goes right.
    const topLeft = dy < 0n || (dy === 0n && dx > 0n);
    if (e < 0n || (e === 0n && !topLeft)) inside = false;
    where = Math.min(where, e < 0n ? -1 : e === 0n ? 0 : 1);
  }
  return [where, inside];
}

// Rows as the period's code draws them, with one addition per row and edge.
function slowVintage(corners, width, height) {
  const out = new Array(width * height).fill(0);
  const v = corners.map(big).sort((p, q) => Number(p[1] - q[1] || p[0] - q[0])).map((p) => p.map((u) => (u + 128n) >> 8n));
  const [t, m, b] = v;
  const doubled = (m[0] - t[0]) * (b[1] - t[1]) - (b[0] - t[0]) * (m[1] - t[1]);
  if (doubled === 0n || area(corners) === 0) return out;
  const rows = new Map();
  for (const [p, q] of [[t, b], [t, m], [m, b]]) {
    if (p[1] === q[1]) continue;
    const step = ((q[0] - p[0]) << 16n) / (q[1] - p[1]);
    let x = p[0] << 16n;
    for (let y = p[1]; y < q[1]; y++) {
      rows.set(y, [...(rows.get(y) ?? []), x >> 16n]);
      x += step;
    }
  }
  for (const [y, [long, short]] of rows) {
    const [x0, x1] = doubled > 0n ? [long, short] : [short, long];
    for (let x = x0; x < x1; x++) {
      if (x >= 0n && x < BigInt(width) && y >= 0n && y < BigInt(height)) out[Number(y) * width + Number(x)] = 1;
    }
  }
  return out;
}

function slowDepth(t, x, y) {
  const w = area(t);
  const part = (p, q) => (q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0]);
  return (part(t[1], t[2]) * t[0][2] + part(t[2], t[0]) * t[1][2] + part(t[0], t[1]) * t[2][2]) / w;
}

for (const [name, run] of Object.entries(tests)) test(name, run);
