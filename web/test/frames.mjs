// The frames of `verify` in node: machines/wasm/run draws them all with and without vectors and compares their
// hash with that of every other machine. This test compares the pictures of the page's own module with the program's.
//
//     frames.mjs MODULE.wasm MODE13H
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { Engine } from "../page/engine.js";

const [file, program] = process.argv.slice(2);
const engine = new Engine(await WebAssembly.compile(readFileSync(file)));
const scratch = mkdtempSync(join(tmpdir(), "mode13h-frames-"));
let [same, all] = [0, 0];
try {
  for (const { name, toml } of engine.shipped) {
    const scene = engine.open(toml);
    for (const [settings, options] of [[{}, []], [{ maxError: 1 }, ["--max-error", "1"]]]) {
      const seconds = 0.75;
      scene.set(settings);
      scene.show(seconds);
      scene.draw();
      const out = join(scratch, "frame.png");
      execFileSync(program, ["render", name, "--time", `${seconds}`, ...options, "-o", out]);
      all++;
      if (readFileSync(out).equals(scene.png())) same++;
      else console.log(`${name} ${options.join(" ")}: another picture`);
    }
    scene.free();
  }
} finally {
  rmSync(scratch, { recursive: true });
}
console.log(`${same} of ${all} pictures of shipped scenes are the program's, to the byte of the file`);
process.exit(same === all && all > 0 ? 0 : 1);
