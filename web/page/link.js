// @ts-check
// The link: the part after # holds scene, moment, pose, shading, budget, effects and the other side's setting.

import { HEIGHT, WIDTH } from "./engine.js";
import { OCTAVES } from "./stops.js";

/**
 * @import { Engine } from "./engine.js"
 * @import { Shipped, State } from "./types.d.ts"
 */

/**
 * Packs a text for a link.
 * @param {string} text
 */
async function pack(text) {
  const stream = new Blob([text]).stream().pipeThrough(new CompressionStream("deflate-raw"));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  const letters = Array.from(bytes, (byte) => String.fromCharCode(byte)).join("");
  return btoa(letters).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
}

/** @param {string} packed */
async function unpackText(packed) {
  const bytes = Uint8Array.from(atob(packed.replaceAll("-", "+").replaceAll("_", "/")), (letter) => letter.charCodeAt(0));
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate-raw"))).text();
}

/**
 * The link of a state. It includes the text of a scene that is not shipped, but no files.
 * @param {State} state
 * @param {Shipped[]} shipped
 */
export async function linkOf(state, shipped) {
  const link = new URLSearchParams();
  link.set("scene", state.name);
  if (shipped.find(({ name }) => name === state.name)?.toml !== state.toml) link.set("toml", await pack(state.toml));
  link.set("t", state.seconds.toFixed(4));
  for (const key of /** @type {const} */ (["turn", "tilt"])) if (state.pose[key]) link.set(key, state.pose[key].toFixed(4));
  if (state.pose.zoom !== 1) link.set("zoom", state.pose.zoom.toFixed(4));
  if (state.maxError) link.set("max-error", `${state.maxError}`);
  else link.set("shading", state.shading);
  if (state.beside) link.set("beside", state.beside);
  if (state.beside) link.set("at", state.divider.toFixed(3));
  if (state.pixel) link.set("pixel", `${state.pixel.x},${state.pixel.y}`);
  for (const [effect, on] of Object.entries(state.effects)) link.append("effect", `${effect}:${on ? "on" : "off"}`);
  return `#${link}`;
}

/**
 * The state in a link; null if the link is not of this kind. Numbers out of range are left out.
 * @param {string} hash
 * @param {Pick<Engine, "shipped" | "shadings" | "effects">} engine
 * @returns {Promise<Partial<State> & { name: string, toml: string } | null>}
 */
export async function stateOf(hash, { shipped, shadings, effects }) {
  const link = new URLSearchParams(hash.slice(1));
  if (!link.has("scene")) return null;
  /**
   * @template Otherwise
   * @param {string} key
   * @param {number} low
   * @param {number} high
   * @param {Otherwise} otherwise
   */
  const number = (key, low, high, otherwise) => {
    const value = Number.parseFloat(link.get(key) ?? "");
    return value >= low && value <= high ? value : otherwise;
  };
  const name = link.get("scene") ?? "";
  const edited = link.get("toml");
  const toml = edited !== null ? await unpackText(edited) : shipped.find((scene) => scene.name === name)?.toml;
  if (toml === undefined) throw new Error(`The link names the scene ${name}, which is not shipped.`);
  /**
   * @param {string} what
   * @param {string} word
   * @param {string[]} known
   */
  const check = (what, word, known) => {
    if (!known.includes(word)) throw new Error(`The link names the ${what} ${word}, which this page does not have.`);
  };
  const switched = link.getAll("effect").map((effect) => effect.split(":"));
  for (const [effect] of switched) check("effect", effect, effects);
  const [shading, beside] = ["shading", "beside"].map((key) => link.get(key) ?? "");
  check("shading", shading, ["", ...shadings]);
  check("other side", beside, ["", "truth", ...OCTAVES.map((budget) => `max-error ${budget}`), ...shadings.map((name) => `shading ${name}`)]);
  const [x, y] = (link.get("pixel") ?? "").split(",").map(Number);
  const isPixel = link.has("pixel") && Number.isInteger(x) && Number.isInteger(y) && x >= 0 && x < WIDTH && y >= 0 && y < HEIGHT;
  return {
    name,
    toml,
    seconds: number("t", 0, 3600, 0),
    pose: { turn: number("turn", -1000, 1000, 0), tilt: number("tilt", -1000, 1000, 0), zoom: number("zoom", 0.05, 20, 1) },
    maxError: number("max-error", 0.01, 255, null),
    shading,
    beside,
    divider: number("at", 0, 1, 0.5),
    pixel: isPixel ? { x, y } : null,
    effects: Object.fromEntries(switched.map(([effect, on]) => [effect, on === "on"])),
  };
}
