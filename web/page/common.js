// @ts-check
// What page and worker share: numbers, and what an error says.

/**
 * @param {number} number
 * @param {number} low
 * @param {number} high
 */
export const clamp = (number, low, high) => Math.min(Math.max(number, low), high);

/**
 * A number with its thousands apart.
 * @param {number} number
 */
export const group = (number) => number.toLocaleString("en");

/**
 * What an error says.
 * @param {unknown} error
 */
export const messageOf = (error) => (error instanceof Error ? error.message : String(error));
