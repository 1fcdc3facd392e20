// @ts-check
// The chart: the time and the error of each setting, with the present one marked.

import { drawChart, markEfficient } from "../../lab/src/cost/report/shared/chart.js";
import { element, setText } from "./elements.js";
import { settingLines } from "./engine.js";
import { CHEAPEST, fullName, MARKS, settingName, settingOf, shadesText, stopOf } from "./stops.js";
import { msText, Stopwatch } from "./stopwatch.js";

/**
 * @import { Page } from "./page.js"
 * @import { Point } from "../../lab/src/cost/report/shared/chart.js"
 * @import { Mark, Setting } from "./types.d.ts"
 */

/** Laps of a setting in each turn, and turns of all settings: enough for the first, while the browser still compiles, to leave. */
const LAPS_A_TURN = 5;
const TURNS = 12;
/** Milliseconds after which a new scene's curve is measured; its picture comes first. */
const SETTLING = 400;

export class Curve {
  /**
   * By their lines: settings, their stopwatch, and their errors and counts once judged.
   * @type {Map<string, { settings: Setting, watch: Stopwatch, judged?: Omit<Mark, "ms" | "isRedrawn"> }>}
   */
  #points = new Map();
  /** Number of the current measurement: an older one ends when a newer begins. */
  #number = 0;
  #timer = 0;

  /** @param {Page} page */
  constructor(page) {
    this.page = page;
    element("measure").addEventListener("click", () => this.#measureAll());
    new ResizeObserver(() => this.draw()).observe(element("chart"));
  }

  /** Forgets another scene, and measures this one's curve in the background. */
  forget() {
    this.#points.clear();
    this.#number++;
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => this.#measure(MARKS), SETTLING);
    this.draw();
  }

  /**
   * What is known about a setting: milliseconds, errors, counts; undefined if nothing is yet.
   * @param {Setting} settings
   * @returns {Mark | undefined}
   */
  at(settings) {
    const point = this.#points.get(settingLines(settings));
    return point?.judged && { ...point.judged, ms: point.watch.ms, isRedrawn: point.watch.isRedrawn };
  }

  async #measureAll() {
    const button = element("measure");
    button.disabled = true;
    const shadings = this.page.engine.shadings.filter((shading) => shading !== CHEAPEST).map((shading) => ({ maxError: null, shading }));
    await this.#measure([...MARKS, ...shadings], (part) => setText(button, `Measuring, ${Math.round(100 * part)} %`));
    button.disabled = false;
    setText(button, "Measure all methods again");
  }

  /**
   * Measures settings in turn, so that other load on the machine affects all of them.
   * @param {Setting[]} settings
   * @param {(part: number) => void} onProgress
   */
  async #measure(settings, onProgress = () => {}) {
    const number = ++this.#number;
    const question = this.page.question();
    // A moving scene is measured at the moment of its picture: at time 0 there may be nothing to see.
    if (this.page.state.playing) question.seconds = this.page.scene.about.picture;
    const watches = settings.map(() => new Stopwatch());
    const all = TURNS * settings.length;
    for (let turn = 0; turn < all; turn++) {
      const at = turn % settings.length;
      onProgress(turn / all);
      const asked = { ...question, settings: { ...question.settings, ...settings[at] }, judges: turn < settings.length, laps: LAPS_A_TURN };
      const answer = await this.page.ask("measure", asked);
      if (!answer || number !== this.#number) return;
      watches[at].add(...answer.laps);
      const lines = settingLines(settings[at]);
      const judged = answer.judged ?? this.#points.get(lines)?.judged;
      this.#points.set(lines, { settings: settings[at], watch: watches[at], judged });
      this.draw();
    }
  }

  /** Draws the chart. A frame that is not redrawn takes no time, and is not on it. */
  draw() {
    const { state, left, accuracy } = this.page;
    const judged = left?.isRedrawn ? accuracy?.judged : null;
    const now = judged && left.ms ? { ms: left.ms, error: judged.rms } : null;
    const present = settingLines(settingOf(state));
    /** @type {Point[]} */
    const points = [];
    for (const [lines, { settings, watch, judged }] of this.#points) {
      if (!watch.isRedrawn || !watch.ms || !judged) continue;
      const point = this.#point(lines, settings, watch.ms, judged.rms);
      // The present setting's name is shown at the present point.
      points.push(now && lines === present ? { ...point, name: "" } : point);
    }
    if (now) points.push({ ...now, kind: "now", name: `${this.#name(state)}, now` });
    element("still").hidden = left?.isRedrawn !== false;
    drawChart(element("chart"), markEfficient(points), { height: 250, time: (/** @type {number} */ ms) => `${Number(ms.toPrecision(3))} ms` });
  }

  /** @param {Setting} setting */
  #name({ maxError, shading }) {
    return maxError ? `≤ ${shadesText(maxError)}` : settingName({ maxError, shading });
  }

  /**
   * @param {string} key
   * @param {Setting} settings
   * @param {number} ms
   * @param {number} error
   * @returns {Point}
   */
  #point(key, settings, ms, error) {
    const stop = stopOf(settings);
    return {
      key, ms, error,
      // The cheapest is the slider's left end: its line begins there.
      ...(stop === null ? { kind: "shading" } : { kind: "budget", budget: settings.maxError ?? 255 }),
      name: this.#name(settings),
      title: `${settings.maxError ? settingName(settings) : fullName(settings.shading)}: ${msText(ms)}, off by ${error.toFixed(2)} shades r.m.s.`,
      choose: () => this.page.choose(settings),
    };
  }
}
