// Compares the module's frames with those of the native program, to the byte.
//     node run.mjs teapot.wasm native
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { frames } from "../frames.mjs";

const [module, native] = process.argv.slice(2);
// The first time comes again at the end: a frame does not depend on those before it.
const times = [0, 0.5, 1, 1.7, 3.9, 0];
const bytes = 320 * 200 * 4;
const expected = execFileSync(native, times.map(String), { maxBuffer: times.length * bytes });
const draw = await frames(readFileSync(module));
times.forEach((seconds, i) => {
  const wanted = expected.subarray(i * bytes, (i + 1) * bytes);
  const drawn = draw(seconds);
  const wrong = wanted.findIndex((byte, at) => byte !== drawn[at]);
  if (wrong >= 0 || wanted.length !== bytes) {
    const [x, y] = [(wrong >> 2) % 320, Math.floor((wrong >> 2) / 320)];
    console.error(`wasm: ${seconds} s: pixel (${x}, ${y}) differs from the native program's`);
    process.exit(1);
  }
  if (new Set(wanted).size < 32) {
    console.error(`wasm: ${seconds} s: the frame is nearly blank`);
    process.exit(1);
  }
});
console.log(`wasm: ${times.length} frames, the bytes of the native program`);
