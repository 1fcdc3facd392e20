// @ts-check
// Shared by page and worker: numbers, and the messages of errors.

/**
 * @param {number} number
 * @param {number} low
 * @param {number} high
 */
export const clamp = (number, low, high) => Math.min(Math.max(number, low), high);

/**
 * A number with its thousands separated.
 * @param {number} number
 */
export const group = (number) => number.toLocaleString("en");

/**
 * The message of an error.
 * @param {unknown} error
 */
export const messageOf = (error) => (error instanceof Error ? error.message : String(error));
