// Turns a compiled module into a function that draws: it takes seconds, and returns the pixels of an ImageData.
export async function frames(module) {
  const { instance } = await WebAssembly.instantiate(module, {});
  const { draw, memory } = instance.exports;
  return (seconds) => {
    const address = draw(seconds);
    // A new view for each frame, made after drawing, because memory that grows detaches older views.
    return new Uint8ClampedArray(memory.buffer, address, 320 * 200 * 4);
  };
}
