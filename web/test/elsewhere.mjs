// Installed browsers, without anything that drives them: the page itself reports the outcome.
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import { basename, join } from "node:path";

/** Removes a browser's folder. If its last processes still write there, it stays in the system's temporary folder. */
function removeProfile(profile) {
  try {
    rmSync(profile, { recursive: true, force: true, maxRetries: 10, retryDelay: 100 });
  } catch (error) {
    console.log(`${profile} stays: ${error.code}`);
  }
}

/**
 * Opens a page in a browser, and resolves to what it sends to `/said` of a local server. `open` makes the page's address
 * from the server's; `serve` answers all other requests.
 */
export function ask(program, open, serve = (request, response) => response.writeHead(404).end()) {
  return new Promise((resolve) => {
    const profile = mkdtempSync(join(tmpdir(), "mode13h-browser-"));
    let running;
    const server = createServer((request, response) => {
      if (request.url !== "/said") return serve(request, response);
      let said = "";
      request.on("data", (part) => (said += part)).on("end", () => end(response.end() && said));
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
      const isFirefox = basename(program).startsWith("firefox");
      const options = isFirefox ? ["--headless", "--no-remote", "--profile", profile] : ["--headless=new", "--no-sandbox", "--disable-gpu", `--user-data-dir=${profile}`];
      running = spawn(program, [...options, open(`http://127.0.0.1:${server.address().port}`)], { stdio: "ignore" });
    });
  });
}
