// The beginning: unpacks what is packed, and runs it.

/** Bytes of letters, 13 bits in two of them. */
function bytesOf(text, letters) {
  const values = new Uint8Array(128);
  [...letters].forEach((letter, value) => (values[letter.charCodeAt(0)] = value));
  const bytes = new Uint8Array(Math.floor((text.length / 2) * 13 / 8));
  let [bits, count, at] = [0, 0, 0];
  for (let i = 0; i + 1 < text.length; i += 2) {
    bits |= (values[text.charCodeAt(i)] + 91 * values[text.charCodeAt(i + 1)]) << count;
    for (count += 13; count >= 8; count -= 8) {
      bytes[at++] = bits;
      bits >>>= 8;
    }
  }
  return bytes;
}

/** The parts that are packed in this page: the engine as bytes, the rest as text. */
function unpackParts() {
  const { textContent, dataset } = document.getElementById("packed");
  const all = unpackLzma(bytesOf(textContent.trim(), LETTERS));
  let at = 0;
  const next = (length) => all.subarray(at, (at += length));
  const parts = Object.entries(JSON.parse(dataset.parts)).map(([name, length]) => [name, next(length)]);
  return Object.fromEntries(parts.map(([name, bytes]) => [name, name === "wasm" ? bytes : new TextDecoder().decode(bytes)]));
}

function run(script) {
  document.head.append(Object.assign(document.createElement("script"), { textContent: script }));
}

const PARTS = unpackParts();
document.head.append(Object.assign(document.createElement("style"), { textContent: PARTS.style }));
run(PARTS.engine);
run(PARTS.figures);
run(PARTS.page);
