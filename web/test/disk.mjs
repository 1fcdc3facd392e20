// The page opened from disk in installed browsers: disk.mjs PAGE.html BROWSER...
//
// A copy of the page reports whether the engine, its worker and the text's figures work, and any errors.
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, join } from "node:path";
import { pathToFileURL } from "node:url";
import { ask } from "./elsewhere.mjs";

const [page, ...browsers] = process.argv.slice(2);
const folder = mkdtempSync(join(tmpdir(), "mode13h-disk-"));

/** Waits for the first error figures, which the worker computes, or for a message from the page. */
const script = (server) => `<script>
const wrong = [];
addEventListener("error", ({ message }) => wrong.push(message));
addEventListener("unhandledrejection", ({ reason }) => wrong.push(String(reason)));
const say = (said) => fetch("${server}/said", { method: "POST", mode: "no-cors", body: said });
const look = () => {
  const trouble = document.getElementById("trouble");
  if (wrong.length || !trouble.hidden) say([trouble.textContent, ...wrong].join("; "));
  else if (globalThis.page?.accuracy.judged) say("drawn, and off by " + page.accuracy.judged.max.toFixed(2) + " shades at worst");
  else setTimeout(look, 100);
};
look();
</script>`;

let failures = 0;
for (const program of browsers) {
  const said = await ask(program, (server) => {
    const copy = join(folder, "page.html");
    writeFileSync(copy, readFileSync(page, "utf8").replace("</body>", () => `${script(server)}</body>`));
    return pathToFileURL(copy).href;
  });
  const works = said.startsWith("drawn");
  if (!works) failures++;
  console.log(`${basename(program)}, from a disk: ${works ? said : `FAILED: ${said}`}`);
}
rmSync(folder, { recursive: true });
process.exit(failures);
