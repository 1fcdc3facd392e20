// @ts-check
// The engine: WebAssembly over linear memory. The page has one, and its worker another.

/** @import { About, Account, Counts, Exports, Frame, Judged, PlanRow, Pose, SceneAbout, Settings } from "./types.d.ts" */

export const WIDTH = 320;
export const HEIGHT = 200;
export const PIXELS = WIDTH * HEIGHT;
const STANDARDS = ["gouraud", "gouraud-perspective", "gouraud-unrounded", "lit"];
/** Frames per second of a scene, as in the program's animations. */
export const RATE = 35;

/** The pose with which every picture begins: turn and tilt in radians, and the enlargement. */
export const FIRST_POSE = Object.freeze(/** @type {Pose} */ ({ turn: 0, tilt: 0, zoom: 1 }));

/** The instance has trapped. Another has replaced it, with the same files. */
export class EngineStopped extends Error {}

export class Engine {
  /**
   * Files that scenes may name.
   * @type {Map<string, Uint8Array>}
   */
  #files = new Map();
  /** @type {Exports} */
  #exports = /** @type {any} */ (null);
  /** Counts the instances: a scene opened by an earlier one is opened again. */
  generation = 0;

  /** @param {WebAssembly.Module} module */
  constructor(module) {
    this.module = module;
    this.#restart();
    this.call("about");
    /** @type {About} */
    const about = this.json();
    this.shipped = about.shipped;
    this.shadings = about.shadings;
    this.effects = about.effects;
    this.levels = about.levels;
    this.notTaken = about.notTaken;
  }

  #restart() {
    this.#exports = /** @type {any} */ (new WebAssembly.Instance(this.module).exports);
    this.generation++;
    this.#exports.start();
    for (const [name, bytes] of this.#files) this.#keep(name, bytes);
  }

  /**
   * Calls an export. Its answer is then in `text()`, `json()` or `bytes()`.
   * @param {string} name
   * @param {number[]} numbers
   */
  call(name, ...numbers) {
    try {
      return /** @type {(...numbers: number[]) => number} */ (this.#exports[name])(...numbers);
    } catch (error) {
      if (!(error instanceof WebAssembly.RuntimeError)) throw error;
      const reason = this.#reason();
      this.#restart();
      throw new EngineStopped(`The engine stopped at ${name}: ${reason || error.message}. Another one was started.`);
    }
  }

  #reason() {
    try {
      return this.text();
    } catch {
      return "";
    }
  }

  /**
   * Calls an export that returns whether it succeeded.
   * @param {string} name
   * @param {number[]} numbers
   */
  ask(name, ...numbers) {
    if (!this.call(name, ...numbers)) throw new Error(this.text());
  }

  /** @param {Uint8Array} bytes */
  put(bytes) {
    const place = this.call("room", bytes.length);
    new Uint8Array(this.#exports.memory.buffer, place, bytes.length).set(bytes);
  }

  /** A copy of the answer. */
  bytes() {
    const { memory, answer, answer_length } = this.#exports;
    return new Uint8Array(memory.buffer, answer(), answer_length()).slice();
  }

  text() {
    return new TextDecoder().decode(this.bytes());
  }

  json() {
    return JSON.parse(this.text());
  }

  /**
   * Replaces the files that scenes may name with the contents of `files`, a Map from name to bytes.
   * @param {Map<string, Uint8Array>} files
   */
  setFiles(files) {
    this.call("forget_files");
    this.#files = new Map(files);
    for (const [name, bytes] of this.#files) this.#keep(name, bytes);
  }

  /**
   * @param {string} name
   * @param {Uint8Array} bytes
   */
  #keep(name, bytes) {
    const letters = new TextEncoder().encode(name);
    const both = new Uint8Array(letters.length + bytes.length);
    both.set(letters);
    both.set(bytes, letters.length);
    this.put(both);
    this.call("file", letters.length);
  }

  /**
   * Opens a scene. An error has `line` and `column`, counted from 1, if it has a position.
   * @param {string} toml
   */
  open(toml) {
    return new Scene(this, toml);
  }

  /**
   * Bytes of the 8.8 span loop: start AX, step BX, count CX.
   * @param {number} ax
   * @param {number} bx
   * @param {number} cx
   */
  span(ax, bx, cx) {
    this.call("span", ax & 0xffff, bx & 0xffff, Math.max(0, Math.trunc(cx)));
    return this.bytes();
  }

  /**
   * A frame of triangles, nine numbers each: x, y and shade of three corners.
   * @param {Float64Array} numbers
   */
  triangles(numbers) {
    this.put(new Uint8Array(numbers.buffer, numbers.byteOffset, numbers.byteLength));
    this.call("triangles");
    return this.bytes();
  }
}

/**
 * Settings as the engine reads them. `effects` maps a name to true or false.
 * @param {Settings} settings
 */
export function settingLines({ shading, maxError, effects = {} }) {
  const lines = Object.entries(effects).map(([name, on]) => `effect ${name} ${on ? "on" : "off"}`);
  if (maxError) lines.push(`max-error ${maxError}`);
  else if (shading) lines.push(`shading ${shading}`);
  return lines.join("\n");
}

export class Scene {
  #generation = 0;
  #handle = -1;
  #lines = "";

  /**
   * @param {Engine} engine
   * @param {string} toml
   */
  constructor(engine, toml) {
    this.engine = engine;
    this.toml = toml;
    this.#open();
  }

  #open() {
    const { engine } = this;
    engine.put(new TextEncoder().encode(this.toml));
    this.#handle = engine.call("open");
    const about = engine.json();
    if (this.#handle < 0) {
      const { message, line, column } = about;
      throw Object.assign(new Error(message), { line, column });
    }
    /** @type {SceneAbout} */
    this.about = about;
    this.#generation = engine.generation;
    this.#lines = "";
  }

  /**
   * @param {string} name
   * @param {number[]} numbers
   */
  #ask(name, ...numbers) {
    if (this.#generation !== this.engine.generation) this.#open();
    this.engine.ask(name, this.#handle, ...numbers);
  }

  /**
   * Sets how the scene is drawn.
   * @param {Settings} settings
   */
  set(settings) {
    const lines = settingLines(settings);
    if (lines === this.#lines && this.#generation === this.engine.generation) return;
    if (this.#generation !== this.engine.generation) this.#open();
    this.engine.put(new TextEncoder().encode(lines));
    this.#ask("set");
    this.#lines = lines;
  }

  /**
   * Moves the scene to a time in seconds, seen in a pose.
   * @param {number} seconds
   * @param {Pose} pose
   */
  show(seconds, pose = FIRST_POSE) {
    const { turn, tilt, zoom } = pose;
    this.#ask("show", seconds, turn, tilt, zoom);
  }

  /**
   * Draws a frame; with `again` even if nothing has changed.
   * @param {boolean} again
   */
  draw(again = false) {
    this.#ask("draw", again ? 1 : 0);
  }

  /** @returns {Frame} */
  #picture() {
    const bytes = this.engine.bytes();
    return { width: WIDTH, height: HEIGHT, bytes: bytes.subarray(0, PIXELS), palette: bytes.subarray(PIXELS) };
  }

  /** The last frame. */
  frame() {
    this.#ask("frame");
    return this.#picture();
  }

  /** @returns {Counts} */
  counts() {
    this.#ask("counts");
    return this.engine.json();
  }

  /** @returns {PlanRow[]} */
  plan() {
    this.#ask("plan");
    return this.engine.json();
  }

  /**
   * @param {number} x
   * @param {number} y
   * @returns {Account}
   */
  explain(x, y) {
    this.#ask("explain", x, y);
    return this.engine.json();
  }

  /**
   * How far the frame of this moment is from the truth: figures, and the level of each pixel.
   * @returns {Judged}
   */
  judge() {
    this.#ask("judge");
    const figures = this.engine.json();
    this.#ask("error_map");
    return { ...figures, map: this.engine.bytes() };
  }

  png() {
    this.#ask("png");
    return this.engine.bytes();
  }

  /**
   * Adds a frame to an animation of one loop. After the last one, returns the GIF file.
   * @param {number} number
   * @param {number} frames
   */
  film(number, frames) {
    this.#ask("film", number, frames);
    return number + 1 < frames ? null : this.engine.bytes();
  }

  /**
   * A frame by its number, at 35 a second.
   * @param {{ frame?: number, pose?: Pose } & Settings} settings
   */
  render({ frame = 0, pose = FIRST_POSE, ...settings } = {}) {
    this.set(settings);
    this.show(frame / RATE, pose);
    this.draw();
    return this.frame();
  }

  /**
   * The truth in f64, rounded to bytes: the lighting model at every pixel, or another standard.
   * @param {{ frame?: number, pose?: Pose, standard?: string }} moment
   */
  exact({ frame = 0, pose = FIRST_POSE, standard = "lit" } = {}) {
    this.show(frame / RATE, pose);
    return this.truth(standard);
  }

  /**
   * The truth at the moment shown.
   * @param {string} standard
   */
  truth(standard = "lit") {
    this.#ask("exact", STANDARDS.indexOf(standard));
    return this.#picture();
  }

  free() {
    if (this.#generation === this.engine.generation) this.engine.call("close", this.#handle);
    this.#generation = -1;
  }
}
