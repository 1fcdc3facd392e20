// @ts-check
// Downloads: the picture, an animation of one loop, the scene's file.

import { group } from "./common.js";
import { element, make, setText } from "./elements.js";

/** @import { Page } from "./page.js" */

/**
 * @param {string} name
 * @param {Uint8Array<ArrayBuffer>} bytes
 * @param {string} type
 */
function save(name, bytes, type) {
  const address = URL.createObjectURL(new Blob([bytes], { type }));
  make("a", { href: address, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(address), 10_000);
  setText(element("saved"), `${name}, ${group(bytes.length)} bytes`);
}

/** @param {Page} page */
export function offerFiles(page) {
  element("save-png").addEventListener("click", () => {
    page.drawLeft();
    save(`${page.state.name}.png`, page.scene.png(), "image/png");
  });
  element("save-toml").addEventListener("click", () => save(`${page.state.name}.toml`, new TextEncoder().encode(page.state.toml), "application/toml"));
  const gif = element("save-gif");
  gif.addEventListener("click", async () => {
    gif.disabled = true;
    const { name } = page.state;
    const film = await page.ask("film", page.question(), (part) => setText(element("saved"), `GIF: ${Math.round(100 * part)} %`));
    gif.disabled = false;
    if (film) save(`${name}.gif`, film.file, "image/gif");
  });
  element("copy-link").addEventListener("click", async () => {
    await page.link();
    const files = page.namedFiles();
    const without = files.length ? ` It does not include ${files.join(", ")}: whoever opens it must drop those files onto the page, too.` : "";
    try {
      await navigator.clipboard.writeText(location.href);
      setText(element("saved"), `The link is copied.${without}`);
    } catch {
      setText(element("saved"), `The link is in the address bar.${without}`);
    }
  });
}
