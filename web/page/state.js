// @ts-check
// What the page shows, and the views that are told of changes.

import { FIRST_POSE } from "./engine.js";
import { settingAt, stopOf } from "./stops.js";

/** @import { State } from "./types.d.ts" */

/** The scene of the first screen: one that shows what accuracy is for. */
export const FIRST_SCENE = "phong";

/**
 * The first screen's state, for which the page contains a picture.
 * @type {State}
 */
export const FIRST_STATE = Object.freeze({
  name: FIRST_SCENE, toml: "", seconds: 0, playing: false, pose: FIRST_POSE, ...settingAt(0), stop: 0, effects: {},
  beside: "max-error 0.5", divider: 0.5, pixel: null,
});

/**
 * The state, which only `choose` changes. Views are told of each change and only show it; a view that responds with a
 * change of its own causes an error.
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
   * Registers a view, which is told of every change from now on.
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
   * Advances the time. No view is told, because moving scenes are drawn in each frame anyway.
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
