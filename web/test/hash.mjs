// The conformance frames in a browser: each must have the hash of every other machine.
//
//     hash.mjs FRAMES.wasm BROWSER...
//
// FRAMES.wasm is machines/frames, built for WebAssembly. A BROWSER is a program such as chromium or firefox-esr. It opens
// a local page, which draws the frames and reports the outcome.
import { readFileSync } from "node:fs";
import { basename } from "node:path";
import { ask } from "./elsewhere.mjs";

const [file, ...browsers] = process.argv.slice(2);
const page = `<!doctype html><title>frames</title><script type="module">
let said = "";
let memory;
const machine = {
  print: (place, length) => (said += new TextDecoder().decode(new Uint8Array(memory.buffer, place, length))),
  words: () => 0,
};
const { instance } = await WebAssembly.instantiateStreaming(fetch("/frames.wasm"), { machine });
memory = instance.exports.memory;
const status = instance.exports.start();
await fetch("/said", { method: "POST", body: said + "status " + status });
</script>`;

function serve(request, response) {
  if (request.url === "/frames.wasm") response.writeHead(200, { "content-type": "application/wasm" }).end(readFileSync(file));
  else response.writeHead(200, { "content-type": "text/html" }).end(page);
}

let failures = 0;
for (const program of browsers) {
  const said = await ask(program, (server) => `${server}/`, serve);
  const lines = said.split("\n").filter((line) => line.includes(" frames, "));
  const same = lines.length > 0 && lines.every((line) => line.endsWith(", same")) && said.endsWith("status 0");
  if (!same) failures++;
  console.log(`${basename(program)}: ${same ? `${lines.length} kernels, same` : `DIFFERENT: ${said}`}`);
}
process.exit(failures);
