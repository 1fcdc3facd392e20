// @ts-check
// The stopwatch: every time on the page, and in its worker, is taken by it.

/**
 * @import { Scene } from "./engine.js"
 * @import { Lap, Pose } from "./types.d.ts"
 */

/** The clock's step in milliseconds, which browsers make coarse: the least difference that it shows. */
export const CLOCK_STEP = (() => {
  let [step, changes, before] = [Infinity, 0, performance.now()];
  const end = before + 20;
  while (changes < 8 && before < end) {
    const now = performance.now();
    if (now === before) continue;
    step = Math.min(step, now - before);
    before = now;
    changes++;
  }
  return Number(step.toFixed(4));
})();

/** Milliseconds of a lap at least: the clock's step is at most a fortieth of them. */
const LAP = Math.max(2, 40 * CLOCK_STEP);
/** Laps that are kept, so 50 frames or more; and how many there must be before a time is shown. */
export const KEPT_LAPS = 50;
const FIRST_LAPS = 5;
/** From a moment to the next, in seconds: what moves is computed again in every frame of a lap. */
const NEXT_MOMENT = 1 / 70;
/** Part by which the halves of the laps may differ once they are settled, and laps after which they are so in any case. */
const STEADY = 0.04;
const PATIENCE = 250;

/**
 * A time in the page's one unit.
 * @param {number} ms
 */
export const msText = (ms) => `${ms.toFixed(ms < 0.0995 ? 3 : ms < 9.995 ? 2 : ms < 99.95 ? 1 : 0)} ms`;

/** @param {number[]} numbers */
const ascending = (numbers) => [...numbers].sort((a, b) => a - b);
/** @param {number[]} numbers */
export const median = (numbers) => ascending(numbers)[numbers.length >> 1];
/**
 * What the rest of the machine adds is on top: a quarter of the laps had little of it.
 * @param {number[]} numbers
 */
const lowerQuartile = (numbers) => ascending(numbers)[numbers.length >> 2];

export class Stopwatch {
  /** @type {number[]} */
  #laps = [];
  /** Laps since the picture changed. */
  #fresh = 0;
  /** Whether the scene moves and is redrawn: where nothing changes the engine leaves the frame as it is. */
  isRedrawn = true;

  /**
   * Draws a scene again and again, about a moment and at last in it. Returns milliseconds a frame, and whether the scene
   * is redrawn from one moment to the next without being asked for it.
   * @param {Scene} scene
   * @param {number} seconds
   * @param {Pose} pose
   * @returns {Lap}
   */
  static lap(scene, seconds, pose) {
    scene.show(seconds + NEXT_MOMENT, pose);
    scene.draw();
    const isRedrawn = scene.counts().redrawn;
    let [frames, took] = [0, 0];
    const begun = performance.now();
    while (took < LAP || frames % 2 === 0) {
      scene.show(frames % 2 ? seconds + NEXT_MOMENT : seconds, pose);
      scene.draw(true);
      frames++;
      took = performance.now() - begun;
    }
    return { ms: took / frames, isRedrawn };
  }

  /**
   * Laps of a scene, after one that warms up.
   * @param {Scene} scene
   * @param {number} seconds
   * @param {Pose} pose
   * @param {number} count
   */
  static laps(scene, seconds, pose, count) {
    Stopwatch.lap(scene, seconds, pose);
    return Array.from({ length: count }, () => Stopwatch.lap(scene, seconds, pose));
  }

  /** @param {Lap[]} laps */
  add(...laps) {
    for (const { ms, isRedrawn } of laps) {
      this.#laps.push(ms);
      this.#fresh++;
      this.isRedrawn = isRedrawn;
    }
    // What was taken while the browser still compiled leaves in time.
    this.#laps.splice(0, this.#laps.length - KEPT_LAPS);
  }

  /** Forgets what was timed of another picture. */
  reset() {
    this.#laps = [];
    this.renew();
  }

  /** The picture is another, but nearly the same: its laps are not settled any more. */
  renew() {
    this.#fresh = 0;
  }

  /** Milliseconds a frame; null while there are too few laps. */
  get ms() {
    return this.#laps.length < FIRST_LAPS ? null : lowerQuartile(this.#laps);
  }

  /** Whether more laps would say nothing new: as many as are kept, the later half as long as the one before. */
  get isSettled() {
    if (this.#fresh < KEPT_LAPS) return false;
    const half = KEPT_LAPS / 2;
    const [before, after] = [this.#laps.slice(0, half), this.#laps.slice(half)].map(lowerQuartile);
    return Math.abs(after - before) <= STEADY * (this.ms ?? 0) || this.#fresh >= PATIENCE;
  }
}
