// @ts-check
// The stopwatch, which takes every time on the page and in its worker.

/**
 * @import { Scene } from "./engine.js"
 * @import { Lap, Pose } from "./types.d.ts"
 */

/** The clock's step in milliseconds, which browsers make coarse: the smallest difference between two readings. */
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

/**
 * Minimum length of a lap in milliseconds: forty steps of the clock, or one of a clock that is so coarse that more would
 * make the page jerk. A lap begins and ends just after a step, so it is off by one frame at most.
 */
const LAP = Math.max(2, Math.min(40 * CLOCK_STEP, 10), CLOCK_STEP);
/** Number of laps that are kept, so 50 frames or more; and how many there must be before a time is shown. */
export const KEPT_LAPS = 50;
const FIRST_LAPS = 5;
/** Seconds from one moment to the next: a moving scene is computed again in every frame of a lap. */
const NEXT_MOMENT = 1 / 70;
/** Share by which the two halves of settled laps may differ, and the number of laps that count as settled anyway. */
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
 * Other load on the machine only adds time: a quarter of the laps had little of it.
 * @param {number[]} numbers
 */
const lowerQuartile = (numbers) => ascending(numbers)[numbers.length >> 2];

export class Stopwatch {
  /** @type {number[]} */
  #laps = [];
  /** Laps since the picture changed. */
  #fresh = 0;
  /** Whether the scene moves and is redrawn: if nothing changes, the engine leaves the frame as it is. */
  isRedrawn = true;

  /**
   * Draws a scene repeatedly, around a moment and finally at it. Returns milliseconds per frame, and whether the scene
   * is redrawn from one moment to the next without being forced.
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
    const before = performance.now();
    let begun = before;
    while (begun === before) begun = performance.now();
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
    // Laps taken while the browser was still compiling are dropped in time.
    this.#laps.splice(0, this.#laps.length - KEPT_LAPS);
  }

  /** Forgets the laps of the previous picture. */
  reset() {
    this.#laps = [];
    this.renew();
  }

  /** The picture has changed slightly: its laps are no longer settled. */
  renew() {
    this.#fresh = 0;
  }

  /** Milliseconds per frame; null while there are too few laps. */
  get ms() {
    return this.#laps.length < FIRST_LAPS ? null : lowerQuartile(this.#laps);
  }

  /** Whether more laps would add nothing: there are as many as are kept, and their two halves agree. */
  get isSettled() {
    if (this.#fresh < KEPT_LAPS) return false;
    const half = KEPT_LAPS / 2;
    const [before, after] = [this.#laps.slice(0, half), this.#laps.slice(half)].map(lowerQuartile);
    return Math.abs(after - before) <= STEADY * (this.ms ?? 0) || this.#fresh >= PATIENCE;
  }
}
