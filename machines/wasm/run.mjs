// Runs the program in node: run.mjs FILE.wasm WORD...
import { readFileSync, writeSync } from "node:fs";

const [file, ...words] = process.argv.slice(2);
let memory;
const machine = {
  print: (place, length) => writeSync(1, new Uint8Array(memory.buffer, place, length)),
  words: (place, room) => {
    const bytes = new TextEncoder().encode(words.join(" ")).subarray(0, room);
    new Uint8Array(memory.buffer).set(bytes, place);
    return bytes.length;
  },
};
const { instance } = await WebAssembly.instantiate(readFileSync(file), { machine });
memory = instance.exports.memory;
process.exit(instance.exports.start());
