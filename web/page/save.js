// What is taken away: the picture, the film of one round, the scene's file.

function save(name, bytes, type) {
  const address = URL.createObjectURL(new Blob([bytes], { type }));
  make("a", { href: address, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(address), 10_000);
  element("saved").textContent = `${name}, ${bytes.length.toLocaleString("en")} bytes`;
}

function offerFiles(page) {
  element("save-png").addEventListener("click", () => {
    page.drawLeft();
    save(`${page.state.name}.png`, page.scene.png(), "image/png");
  });
  element("save-toml").addEventListener("click", () => save(`${page.state.name}.toml`, new TextEncoder().encode(page.state.toml), "application/toml"));
  element("save-gif").addEventListener("click", async ({ target }) => {
    target.disabled = true;
    const onProgress = (part) => (element("saved").textContent = `GIF: ${Math.round(100 * part)} %`);
    const film = await page.ask("film", page.question(), onProgress);
    target.disabled = false;
    if (film) save(`${page.state.name}.gif`, film.file, "image/gif");
  });
  element("copy-link").addEventListener("click", async () => {
    await page.link();
    const files = page.namedFiles();
    const without = files.length ? ` It cannot carry ${files.join(", ")}: whoever opens it has to drop the files, too.` : "";
    try {
      await navigator.clipboard.writeText(location.href);
      element("saved").textContent = `The link is copied.${without}`;
    } catch {
      element("saved").textContent = `The link is in the address bar.${without}`;
    }
  });
}
