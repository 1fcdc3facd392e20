// @ts-check
// The slider: how wrong a pixel may be. Its figures and the error map.

import { clamp, group } from "./common.js";
import { element, keyed, keyItem, make, setText } from "./elements.js";
import { PalettedCanvas } from "./picture.js";
import {
  budgetText, CHEAPEST, errorText, fullName, LAST_STOP, MARKS, OCTAVES, plainName, settingAt, settingName, shadesText, stopOf, techniqueColor,
} from "./stops.js";
import { CLOCK_STEP, KEPT_LAPS, msText, Stopwatch } from "./stopwatch.js";
import { timeOf } from "./versus.js";

/**
 * @import { Page } from "./page.js"
 * @import { Counts, Errors, Level, Mark, Picture, Question, Setting } from "./types.d.ts"
 */

/** The value of the choice that leaves shadings to the slider. */
const SLIDER = "slider";

/** Milliseconds between two updates of the figures, as nobody can read them in every frame. */
const TELLING = 250;

/**
 * The setting in words, as part of a sentence.
 * @param {Setting} setting
 */
function wishText({ maxError, shading }) {
  if (maxError) return `at most ${shadesText(maxError)} of 255 shades`;
  if (shading === CHEAPEST) return "cheapest: one shade a face";
  return shading ? `every face ${fullName(shading)}` : "whatever the scene asks for";
}

/** Colour of pixels on faces that are seen edge-on, in the error map. */
const EDGE_ON = "#3f9ea8";

/** How far a byte may be off where light is computed at the pixel: no budget can be kept more closely. */
const LIT = 0.52;

/**
 * Says in words whether the promise is kept; errors beyond the budget are always explained.
 * @param {Errors} errors
 */
function promiseText({ max, maxError, beyond, edgeOn }) {
  if (!maxError) return "No limit is promised: the largest error is whatever it turns out to be.";
  if (beyond) return `The promise is broken at ${group(beyond)} pixels, by up to ${errorText(max)} shades: please report this.`;
  const kept = `Kept: no pixel is off by more than ${maxError < LIT ? "0.52: ½ for rounding to a byte, 0.02 for arithmetic" : shadesText(maxError)}`;
  const faces = edgeOn.pixels === 1 ? "1 pixel of a face" : `${group(edgeOn.pixels)} pixels of faces`;
  if (!edgeOn.pixels) return `${kept}.`;
  return `${kept}, except for ${faces} seen edge on, off by up to ${errorText(Math.ceil(100 * edgeOn.max) / 100)}: rounding corners to 1/256 pixel moves their light that far.`;
}

/**
 * Why the slider changes nothing here, or makes a frame slower, if it does; judged by the measurements at its marks.
 * @param {Setting} state
 * @param {(Mark | undefined)[]} found
 */
function whyText(state, found) {
  const marks = found.filter((mark) => mark !== undefined);
  if (marks.length < MARKS.length) return "";
  const [cheapest, ...budgets] = marks;
  const finest = marks[marks.length - 1];
  /** @param {Mark} mark */
  const isFinest = (mark) => Math.abs(mark.rms - finest.rms) < 0.005 && Math.abs(mark.max - finest.max) < 0.05;
  // The first mark from which on nothing changes.
  const from = marks.findIndex((_, at) => marks.slice(at).every(isFinest));
  if (from === 0) return "Flat faces: already exact. The slider changes nothing here.";
  if (from === 1) {
    const how = finest.lit ? "Every budget already lights what needs it at every pixel" : "Straight blends are already exact here";
    return `${how}: only the cheapest method differs (${cheapest.rms.toFixed(1)} shades off, r.m.s.).`;
  }
  if (!state.maxError) return "";
  if (from < budgets.length && state.maxError <= OCTAVES[from - 1]) return `Already as exact as it gets: from ${budgetText(OCTAVES[from - 1])} on the slider changes nothing.`;
  const here = budgets[clamp(Math.round(Math.log2(OCTAVES[0] / state.maxError)), 0, budgets.length - 1)];
  const isSlower = here.isRedrawn && (here.ms ?? 0) > SLOWER * (finest.ms ?? Infinity);
  return isSlower ? "Slower than ½ shade here: bounding the error of a blend takes longer than lighting its pixels." : "";
}

/** How much longer a coarser picture must take for the page to say why. */
const SLOWER = 1.08;

export class Accuracy {
  /**
   * The errors of the last frame that was compared with the truth.
   * @type {Errors | null}
   */
  judged = null;
  /**
   * The levels of its pixels, and the question that was asked.
   * @type {{ map: Uint8Array, asked: Question } | undefined}
   */
  lastMap;
  #told = 0;
  #isAsking = false;

  /** @param {Page} page */
  constructor(page) {
    this.page = page;
    this.#offerStops();
    const shadings = element("shading");
    const methods = page.engine.shadings.map((name) => new Option(fullName(name), name));
    shadings.replaceChildren(new Option("as the slider says", SLIDER), new Option("as the scene asks", ""), ...methods);
    shadings.addEventListener("change", () => {
      if (shadings.value === SLIDER) page.choose(settingAt(page.state.stop));
      else page.choose({ maxError: null, shading: shadings.value });
    });
    element("within").addEventListener("submit", (event) => {
      event.preventDefault();
      this.within(Number(element("limit").value));
    });
    const levels = [...page.engine.levels, { label: "not compared", color: page.engine.notTaken }, { label: "edge on", color: EDGE_ON }];
    element("levels").replaceChildren(...levels.map(({ label, color }) => keyItem(color, label)));
    setText(element("clock"), `Times are lower quartiles of ${KEPT_LAPS} laps of redrawing; the clock’s step is ${CLOCK_STEP} ms.`);
    this.map = new PalettedCanvas(element("errors"));
  }

  #offerStops() {
    const slider = element("accuracy");
    slider.max = `${LAST_STOP}`;
    const marks = MARKS.map((mark) => ({ label: mark.maxError ? shadesText(mark.maxError) : "cheapest", stop: stopOf(mark) ?? 0 }));
    element("octaves").replaceChildren(...marks.map(({ label, stop }) => new Option(label, `${stop}`)));
    const scale = /** @type {HTMLElement} */ (document.querySelector(".scale"));
    scale.replaceChildren(...marks.map(({ label, stop }) => {
      const mark = make("span", {}, label);
      mark.style.setProperty("--stop", `${stop / LAST_STOP}`);
      return mark;
    }));
    const choose = () => this.page.choose(settingAt(Number(slider.value)));
    slider.addEventListener("input", choose);
    // A shading that is not on the slider leaves the thumb where it was: any key or touch takes the slider up again, even
    // at its ends, where there is no input.
    const takeUp = () => stopOf(this.page.state) === null && choose();
    const keys = ["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown", "PageUp", "PageDown", "Home", "End"];
    slider.addEventListener("keydown", ({ key }) => keys.includes(key) && takeUp());
    slider.addEventListener("pointerdown", takeUp);
  }

  /** Shows the setting. The thumb stays where it is if the setting is not a stop of the slider. */
  follow() {
    const { state } = this.page;
    const slider = element("accuracy");
    const isAside = stopOf(state) === null;
    slider.value = `${state.stop}`;
    slider.classList.toggle("aside", isAside);
    const wish = wishText(state);
    setText(element("wish"), wish);
    slider.setAttribute("aria-valuetext", wish);
    element("shading").value = isAside ? state.shading : SLIDER;
  }

  /**
   * Shows the time that the picture takes.
   * @param {number} now
   */
  tell(now) {
    if (now - this.#told < TELLING) return;
    this.#told = now;
    const { left } = this.page;
    const cell = element("ms");
    setText(cell, timeOf(left));
    cell.classList.toggle("settling", !left.isSettled);
    setText(element("once"), left.isRedrawn || left.ms === null ? "" : `Drawn once, in ${msText(left.ms)}, and then kept.`);
    const rate = left.ms === null ? "…" : left.isRedrawn ? group(Math.round(1000 / left.ms)) : "–";
    setText(element("rate"), rate);
    this.page.curve.draw();
    const marks = MARKS.map((mark) => this.page.curve.at(mark));
    this.page.versus.tell(marks);
    setText(element("why"), whyText(this.page.state, marks));
  }

  /**
   * Shows the engine's counts for a frame.
   * @param {Counts} counts
   */
  counts({ shares, shading, lit, pixels }) {
    const all = shares.reduce((sum, [, faces]) => sum + faces, 0) || 1;
    /** @param {string} name */
    const colored = (name) => {
      const part = make("i");
      part.style.background = techniqueColor(name);
      return part;
    };
    /** @param {[string, number]} share */
    const words = ([name, faces]) => `${plainName(name)} ${faces * 200 < all ? "under 1" : Math.round((100 * faces) / all)} %`;
    keyed(element("shares"), shares, ([name]) => name, ([name]) => colored(name), (part, [, faces]) => (part.style.flex = `${faces}`));
    keyed(element("shares-key"), shares, ([name]) => name, ([name]) => keyItem(techniqueColor(name), ""),
      (item, share) => setText(/** @type {Element} */ (item.lastElementChild), words(share)));
    element("shares").setAttribute("aria-label", `Share of faces by technique: ${shares.map(words).join(", ") || shading}`);
    setText(element("lit"), `Light computed ${group(lit)} times for ${group(pixels)} pixels drawn.`);
  }

  /** Asks the worker for the errors of the present frame, if it is idle. Returns the question. */
  async judge() {
    if (this.#isAsking) return null;
    const asked = this.page.question();
    this.#isAsking = true;
    const answer = await this.page.ask("judge", asked);
    this.#isAsking = false;
    if (!answer || asked.toml !== this.page.state.toml) return asked;
    const { map, ...judged } = answer;
    this.judged = judged;
    setText(element("worst"), errorText(judged.max));
    setText(element("rms"), judged.rms.toFixed(2));
    setText(element("promise"), promiseText(judged));
    this.map.show(mapPicture(map, this.page.engine));
    this.lastMap = { map, asked };
    const age = Math.abs(this.page.state.seconds - asked.seconds);
    const isOld = age >= 0.05 && this.page.state.playing && this.page.left.isRedrawn;
    setText(element("errors-age"), isOld ? `Error in shades, ${age.toFixed(1)} s ago` : "Error in shades");
    return asked;
  }

  /** Forgets the errors of the previous scene. */
  forget() {
    this.judged = null;
  }

  /**
   * The smallest error whose frame takes no longer: the slider's stops, halved again and again.
   * @param {number} limit
   */
  async within(limit) {
    if (!(limit > 0)) return;
    const { engine, version } = this.page;
    const { toml, seconds, pose } = this.page.state;
    setText(element("found"), "Measuring …");
    // A separate scene, so that the picture is not disturbed.
    const scene = engine.open(toml);
    /** @type {Map<number, number | null>} */
    const times = new Map();
    /** @param {number} stop */
    const takes = async (stop) => {
      scene.set({ ...this.page.settings(), ...settingAt(stop) });
      const watch = new Stopwatch();
      watch.add(...Stopwatch.laps(scene, seconds, pose, LAPS_OF_SEARCH));
      times.set(stop, watch.ms);
      await new Promise((drawn) => setTimeout(drawn));
    };
    let [fits, beyond] = [-1, LAST_STOP + 1];
    while (beyond - fits > 1) {
      const middle = (fits + beyond) >> 1;
      await takes(middle);
      if ((times.get(middle) ?? Infinity) <= limit) fits = middle;
      else beyond = middle;
    }
    scene.free();
    if (toml !== this.page.state.toml || version !== this.page.version) return setText(element("found"), "");
    const stop = Math.max(fits, 0);
    const took = msText(times.get(stop) ?? 0);
    setText(element("found"), fits < 0 ? `Not here: the cheapest takes ${took}.` : `${settingName(settingAt(stop))}, in ${took}.`);
    this.page.choose(settingAt(stop));
  }
}

/** Number of laps that a search times at each stop. */
const LAPS_OF_SEARCH = 16;

/**
 * An error map in the colours of its levels.
 * @param {Uint8Array} map
 * @param {{ levels: Level[], notTaken: string }} engine
 * @returns {Picture}
 */
export function mapPicture(map, { levels, notTaken }) {
  const colors = [...levels.map((level) => level.color), notTaken, EDGE_ON].map((color) => [1, 3, 5].map((at) => parseInt(color.slice(at, at + 2), 16)));
  const palette = new Uint8Array(768);
  colors.forEach((color, at) => palette.set(color, 3 * at));
  palette.set([22, 22, 26], 3 * 255);
  return { bytes: map, palette };
}
