// @ts-check
// The start: unpacks the packed parts, and runs them.

/** The parts packed into this page. */
async function unpack() {
  const packed = /** @type {HTMLElement} */ (document.getElementById("packed"));
  const { body } = await fetch(`data:application/gzip;base64,${(packed.textContent ?? "").trim()}`);
  const unpacked = /** @type {ReadableStream<Uint8Array<ArrayBuffer>>} */ (body).pipeThrough(new DecompressionStream("gzip"));
  const bytes = new Uint8Array(await new Response(unpacked).arrayBuffer());
  /** @type {Record<string, number>} */
  const lengths = JSON.parse(packed.dataset.parts ?? "{}");
  let at = 0;
  /** @param {string} name */
  const next = (name) => bytes.subarray(at, (at += lengths[name]));
  return Object.fromEntries(Object.keys(lengths).map((name) => [name, next(name)]));
}

try {
  const { wasm, ...texts } = await unpack();
  const [style, text, worker, page] = ["style", "text", "worker", "page"].map((name) => new TextDecoder().decode(texts[name]));
  document.head.append(Object.assign(document.createElement("style"), { textContent: style }));
  /** @type {HTMLElement} */ (document.getElementById("text")).innerHTML = text;
  const address = URL.createObjectURL(new Blob([page], { type: "text/javascript" }));
  const { begin } = await import(address);
  URL.revokeObjectURL(address);
  await begin({ wasm, worker });
} catch (error) {
  const trouble = /** @type {HTMLElement} */ (document.getElementById("trouble"));
  /** @type {HTMLElement} */ (trouble.firstElementChild).textContent = `The page could not be started: ${error instanceof Error ? error.message : error}`;
  trouble.hidden = false;
}
