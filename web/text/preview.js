// The text and its figures without the page around them.
import "./figures/all.js";
import { Engine } from "../page/engine.js";
import { mountFigures } from "./figures/00-shared.js";

mountFigures();

/** Remounts the figures that use the engine. */
export async function begin(wasm) {
  mountFigures(new Engine(await WebAssembly.compile(wasm)));
}
