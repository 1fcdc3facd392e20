// @ts-check
// The slider's stops, and the names of their settings.

import { clamp } from "./common.js";

/** @import { Setting } from "./types.d.ts" */

/** The cheapest shading, the slider's left end on every scene. */
export const CHEAPEST = "flat";
/** Budgets that are measured, and marked on the slider. */
export const OCTAVES = [16, 8, 4, 2, 1, 0.5];
/** Stop 0 is the cheapest shading. Budgets follow, from the widest to ½ shade in quarters of an octave. */
const WIDEST = 32;
export const LAST_STOP = 25;

/**
 * The setting that a stop stands for.
 * @param {number} stop
 * @returns {Setting}
 */
export function settingAt(stop) {
  if (stop < 1) return { maxError: null, shading: CHEAPEST };
  return { maxError: Number((WIDEST * 2 ** (-(stop - 1) / 4)).toPrecision(3)), shading: "" };
}

/**
 * The setting of a state.
 * @param {Setting} state
 * @returns {Setting}
 */
export const settingOf = ({ maxError, shading }) => ({ maxError, shading });

/**
 * The nearest stop; null for a shading that is not on the slider.
 * @param {Setting} setting
 */
export function stopOf({ maxError, shading }) {
  if (maxError) return clamp(Math.round(1 - 4 * Math.log2(maxError / WIDEST)), 1, LAST_STOP);
  return shading === CHEAPEST ? 0 : null;
}

/**
 * A bound, rounded up to two digits.
 * @param {number} shades
 */
export function shadesText(shades) {
  if (shades === 0.5) return "½";
  const unit = 10 ** (Math.floor(Math.log10(shades)) - 1);
  // A quotient that should be whole may be a little more.
  return `${Number((Math.ceil(shades / unit - 1e-9) * unit).toPrecision(2))}`;
}
/** @param {number} budget */
export const budgetText = (budget) => `${shadesText(budget)} ${budget <= 1 ? "shade" : "shades"}`;

/** Techniques from cheap to exact, in plain words. */
export const TECHNIQUES = new Map([
  ["flat", "one shade a face"],
  ["gouraud-vintage", "straight blend of 1994"],
  ["gouraud-8.8", "straight blend, 8.8"],
  ["gouraud-8.8-reseeded", "straight blend"],
  ["gouraud-16.16", "straight blend, 16.16"],
  ["gouraud-hyperbolic", "straight in space, exact"],
  ["gouraud-tessellated", "straight blend, faces split"],
  ["phong-table", "lit from a table"],
  ["gouraud-float", "straight in space"],
  ["phong-quadratic", "curve"],
  ["phong-every-16", "lit at every 16th pixel"],
  ["phong-every-8", "lit at every 8th pixel"],
  ["phong-every-4", "lit at every 4th pixel"],
  ["phong", "lit at every pixel"],
]);
/** @param {string} technique */
export const plainName = (technique) => TECHNIQUES.get(technique) ?? technique;
/** @param {string} technique */
export const fullName = (technique) => `${plainName(technique)} (${technique})`;

/**
 * Colours of the techniques, from cheap to exact.
 * @param {string} name
 */
export function techniqueColor(name) {
  const at = [...TECHNIQUES.keys()].indexOf(name);
  return `hsl(${205 - 190 * (at / (TECHNIQUES.size - 1))} 62% ${at % 2 ? 46 : 56}%)`;
}

/**
 * An error in three digits.
 * @param {number} error
 */
export const errorText = (error) => error.toFixed(error < 9.995 ? 2 : error < 99.95 ? 1 : 0);

/**
 * A setting's name, short enough for the picture's edge.
 * @param {Setting} setting
 */
export function settingName({ maxError, shading }) {
  if (maxError) return `at most ${budgetText(maxError)}`;
  if (shading === CHEAPEST) return "cheapest";
  return shading ? plainName(shading) : "as the scene asks";
}

/** The slider's marks, from the cheapest to half a shade. */
export const MARKS = [settingAt(0), ...OCTAVES.map((maxError) => ({ maxError, shading: "" }))];
