// The page's first picture, drawn at build time by its own engine: first.mjs MODULE.wasm FOLDER
//
// It shows under the canvas until the engine is ready: left.png and right.png, half of each on its side of the divider.
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { Engine } from "./page/engine.js";
import { FIRST_SCENE, FIRST_STATE } from "./page/state.js";
import { besideSetting } from "./page/versus.js";

const [file, folder] = process.argv.slice(2);
const engine = new Engine(await WebAssembly.compile(readFileSync(file)));
const scene = engine.open(engine.shipped.find(({ name }) => name === FIRST_SCENE).toml);
mkdirSync(folder, { recursive: true });
for (const [side, settings] of [["left", FIRST_STATE], ["right", besideSetting(FIRST_STATE.beside)]]) {
  scene.set(settings);
  scene.show(scene.about.picture);
  scene.draw();
  writeFileSync(join(folder, `${side}.png`), scene.png());
}
