// @ts-check
// What the page shows, and who is told when that changes.

import { FIRST_POSE } from "./engine.js";
import { settingAt, stopOf } from "./stops.js";

/** @import { State } from "./types.d.ts" */

/** The scene of the first screen: one in which it is seen what accuracy is for. */
export const FIRST_SCENE = "phong";

/**
 * The first screen's state, of which the page also has a ready picture.
 * @type {State}
 */
export const FIRST_STATE = Object.freeze({
  name: FIRST_SCENE, toml: "", seconds: 0, playing: false, pose: FIRST_POSE, ...settingAt(0), stop: 0, effects: {},
  beside: "max-error 0.5", divider: 0.5, pixel: null,
});

/**
 * The state. It is changed by `choose` alone. Views are told of each change, and only show it: one that answers by a
 * change of its own is an error.
 */
export class Store {
  /** @type {State} */
  #state;
  /** @type {((state: State, before: State) => void)[]} */
  #views = [];
  #isTelling = false;

  /** @param {State} first */
  constructor(first) {
    this.#state = Object.freeze({ ...first });
  }

  get state() {
    return this.#state;
  }

  /**
   * Has a view told of every change from now on.
   * @param {(state: State, before: State) => void} view
   */
  listen(view) {
    this.#views.push(view);
  }

  /**
   * Changes the state, and tells the views.
   * @param {Partial<State>} change
   */
  choose(change) {
    const before = this.#set(change);
    this.#isTelling = true;
    try {
      for (const view of this.#views) view(this.#state, before);
    } finally {
      this.#isTelling = false;
    }
  }

  /**
   * Moves the time on as it passes. Nobody is told: what moves is drawn in each frame.
   * @param {number} seconds
   */
  pass(seconds) {
    this.#set({ seconds });
  }

  /** @param {Partial<State>} change */
  #set(change) {
    if (this.#isTelling) throw new Error("a view changes the state that it is told of");
    const before = this.#state;
    const now = { ...before, ...change };
    this.#state = Object.freeze({ ...now, stop: stopOf(now) ?? before.stop });
    return before;
  }
}
