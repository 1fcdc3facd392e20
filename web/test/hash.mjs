// The conformance frames in a browser: each must have the hash of every other machine.
//
//     hash.mjs FRAMES.wasm BROWSER...
//
// FRAMES.wasm is machines/frames, built for WebAssembly. A BROWSER is a program such as chromium or firefox-esr. It opens
// a page of this computer, which draws the frames and says what came of it.
import { spawn } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import { basename, join } from "node:path";

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

/** Removes a browser's folder. Its last processes may still write there: then it stays in the system's temporary folder. */
function removeProfile(profile) {
  try {
    rmSync(profile, { recursive: true, force: true, maxRetries: 10, retryDelay: 100 });
  } catch (error) {
    console.log(`${profile} stays: ${error.code}`);
  }
}

function ask(program) {
  return new Promise((resolve) => {
    const profile = mkdtempSync(join(tmpdir(), "mode13h-hash-"));
    let running;
    const server = createServer((request, response) => {
      if (request.url === "/frames.wasm") response.writeHead(200, { "content-type": "application/wasm" }).end(readFileSync(file));
      else if (request.url === "/said") {
        let said = "";
        request.on("data", (part) => (said += part)).on("end", () => end(response.end() && said));
      } else response.writeHead(200, { "content-type": "text/html" }).end(page);
    });
    const end = (said) => {
      clearTimeout(timer);
      server.close();
      server.closeAllConnections?.();
      running.once("exit", () => {
        removeProfile(profile);
        resolve(said);
      });
      running.kill();
    };
    const timer = setTimeout(() => end("nothing within three minutes"), 180_000);
    server.listen(0, "127.0.0.1", () => {
      const address = `http://127.0.0.1:${server.address().port}/`;
      const isFirefox = basename(program).startsWith("firefox");
      const options = isFirefox ? ["--headless", "--no-remote", "--profile", profile] : ["--headless=new", "--no-sandbox", "--disable-gpu", `--user-data-dir=${profile}`];
      running = spawn(program, [...options, address], { stdio: "ignore" });
    });
  });
}

let failures = 0;
for (const program of browsers) {
  const said = await ask(program);
  const lines = said.split("\n").filter((line) => line.includes(" frames, "));
  const same = lines.length > 0 && lines.every((line) => line.endsWith(", same")) && said.endsWith("status 0");
  if (!same) failures++;
  console.log(`${basename(program)}: ${same ? `${lines.length} kernels, same` : `DIFFERENT: ${said}`}`);
}
process.exit(failures);
