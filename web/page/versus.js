// @ts-check
// What accuracy costs, at a glance: the times of the two pictures, their ratio, and two bars for time and error.

import { element, setText } from "./elements.js";
import { settingLines } from "./engine.js";
import { settingName, settingOf } from "./stops.js";
import { msText } from "./stopwatch.js";

/**
 * @import { Page } from "./page.js"
 * @import { Mark, Setting } from "./types.d.ts"
 */

/** Times that differ by no more than this share count as equal. */
const SAME = 0.05;

/**
 * How many times as long the slower of two takes, with an arrow that points to it.
 * @param {number} left
 * @param {number} right
 */
function ratioText(left, right) {
  const ratio = Math.max(left, right) / Math.min(left, right);
  if (ratio < 1 + SAME) return ["the same time", ""];
  const times = `${ratio < 9.95 ? ratio.toFixed(1) : Math.round(ratio)} ×`;
  return right > left ? [times, "the time →"] : [times, "← the time"];
}

export class Versus {
  #strip = element("versus");

  /** @param {Page} page */
  constructor(page) {
    this.page = page;
  }

  /**
   * Shows the times; `marks` holds the measurements at the slider's marks, undefined where there is none yet.
   * @param {(Mark | undefined)[]} marks
   */
  tell(marks) {
    const { left, state, accuracy } = this.page;
    this.compare();
    const known = marks.filter((mark) => mark !== undefined);
    const ms = (left.isRedrawn && left.ms) || 0;
    const max = accuracy.judged?.max ?? 0;
    this.#bar("time-bar", ms / Math.max(ms, ...known.map((mark) => mark.ms ?? 0)));
    this.#bar("error-bar", max / Math.max(max, ...known.map((mark) => mark.max)));
    this.#strip.classList.toggle("settling", state.playing ? left.ms === null : !left.isSettled);
  }

  /** Shows the two pictures' names, their times, and the ratio. */
  compare() {
    const { left, right, state } = this.page;
    const isTimed = state.beside && state.beside !== "truth";
    setText(element("left-name"), settingName(state));
    setText(element("left-ms"), timeOf(left));
    setText(element("right-name"), state.beside ? besideName(state.beside) : "");
    setText(element("right-ms"), isTimed ? timeOf(right) : state.beside ? "not timed" : "");
    const [times, words] = isTimed && left.ms !== null && right.ms !== null ? this.#ratio(left.ms, right.ms) : ["", ""];
    setText(element("times"), times);
    setText(element("times-words"), words);
  }

  /**
   * @param {number} leftMs
   * @param {number} rightMs
   */
  #ratio(leftMs, rightMs) {
    const { left, state } = this.page;
    if (!left.isRedrawn) return ["", "no pixel changes, so nothing is redrawn"];
    // Their times would differ only by noise.
    if (settingLines(besideSetting(state.beside)) === settingLines(settingOf(state))) return ["", "the same on both sides"];
    return ratioText(leftMs, rightMs);
  }

  /**
   * @param {"time-bar" | "error-bar"} id
   * @param {number} part
   */
  #bar(id, part) {
    // Two digits after the point are finer than a pixel.
    element(id).style.width = `${(100 * (part > 0 ? Math.min(part, 1) : 0)).toFixed(2)}%`;
  }
}

/** @param {{ ms: number | null, isRedrawn: boolean }} watch */
export const timeOf = ({ ms, isRedrawn }) => (ms === null ? "…" : isRedrawn ? msText(ms) : "not redrawn");

/**
 * The settings that `beside`, a kind and a value, stands for; the truth has none.
 * @param {string} beside
 * @returns {Setting}
 */
export function besideSetting(beside) {
  const [kind, value] = beside.split(" ");
  return kind === "max-error" ? { maxError: Number(value), shading: "" } : { maxError: null, shading: value };
}

/** @param {string} beside */
const besideName = (beside) => (beside === "truth" ? "exact (64-bit)" : settingName(besideSetting(beside)));
