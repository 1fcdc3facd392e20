// From a compiled module to a function that draws: seconds in, the pixels of an ImageData out.
export async function frames(module) {
  const { instance } = await WebAssembly.instantiate(module, {});
  const { draw, memory } = instance.exports;
  return (seconds) => {
    const address = draw(seconds);
    // A new view for each frame, made after it is drawn: memory that grows detaches older ones.
    return new Uint8ClampedArray(memory.buffer, address, 320 * 200 * 4);
  };
}
