// Nanoseconds per face in node, by the page's module, against the program with SSE2 on this machine. It only reports,
// because the result depends on the load of the machine.
//
//     speed.mjs MODULE.wasm MODE13H [SCENE.toml]...
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, join } from "node:path";
import { Engine, FIRST_POSE } from "../page/engine.js";

const ROUNDS = 3;
const [file, program, ...files] = process.argv.slice(2);
const engine = new Engine(await WebAssembly.compile(readFileSync(file)));
const scratch = mkdtempSync(join(tmpdir(), "mode13h-speed-"));
const median = (numbers) => numbers.sort((a, b) => a - b)[numbers.length >> 1];

/** A fine body with the faces of a scan. */
const FINE = 'palette = "copper"\nobjects = [{ shape = "torus", subdivisions = [200, 120], spin = 1 }]\nlights = [{ sun = [0.4, 0.6, 1] }]\n';

/** Nanoseconds per frame: the median of frames timed one by one, as in the program, at two moments in turn. */
function time(scene, milliseconds) {
  const times = [];
  for (const begun = performance.now(); performance.now() - begun < milliseconds; ) {
    scene.show(0.5 + (times.length % 2) / 35, FIRST_POSE);
    const before = performance.now();
    scene.draw(true);
    times.push(1e6 * (performance.now() - before));
  }
  return median(times);
}

function measure(name, words, toml) {
  const scene = engine.open(toml);
  const [here, there] = [[], []];
  // Warms up: the module is optimized only after a while.
  time(scene, 2000);
  for (let round = 0; round < ROUNDS; round++) {
    here.push(time(scene, 500));
    const said = execFileSync(program, ["plan", words, "--measure", "--time", "0.5", "--kernel", "simd-sse2"], { encoding: "utf8", stdio: ["ignore", "pipe", "ignore"] });
    there.push(Number(/drawing the frame takes (\d+) ns/.exec(said.replace(/\s+/g, " "))?.[1]));
  }
  const { faces } = scene.about;
  const [ours, native] = [median(here) / faces, median(there) / faces];
  console.log(`${name}: ${faces} faces, ${ours.toFixed(1)} ns a face in node, ${native.toFixed(1)} by the program with SSE2: ${(ours / native).toFixed(2)} times as long`);
  scene.free();
}

try {
  for (const { name, toml } of engine.shipped.filter(({ name }) => ["torus", "teapot"].includes(name))) measure(name, name, toml);
  const fine = join(scratch, "fine.toml");
  writeFileSync(fine, FINE);
  measure("fine torus", fine, FINE);
  for (const file of files) measure(basename(file), file, readFileSync(file, "utf8"));
} finally {
  rmSync(scratch, { recursive: true });
}
