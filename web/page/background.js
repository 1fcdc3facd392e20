// @ts-check
// The page's side of the worker: questions with promises. Only the last question of each kind is kept waiting.

/** @import { Question } from "./types.d.ts" */

/**
 * A question that was asked, or waits to be asked.
 * @typedef {object} Waiting
 * @property {string} kind
 * @property {Question} question
 * @property {(answer: unknown) => void} resolve
 * @property {(error: Error) => void} reject
 * @property {(part: number) => void} [onProgress]
 */

export class Background {
  #worker;
  #number = 0;
  /** @type {Map<number, Waiting>} */
  #asked = new Map();
  /** @type {Map<string, Waiting>} */
  #waiting = new Map();
  #busy = false;

  /**
   * @param {string} script
   * @param {Uint8Array} wasm
   */
  constructor(script, wasm) {
    const address = URL.createObjectURL(new Blob([script], { type: "text/javascript" }));
    this.#worker = new Worker(address);
    this.#worker.onmessage = ({ data }) => this.#hear(data);
    this.#worker.postMessage({ wasm });
  }

  /** @param {Map<string, Uint8Array>} files */
  setFiles(files) {
    this.#worker.postMessage({ files });
  }

  /**
   * Asks. A question of the same kind that is still waiting is dropped, and its promise answers null.
   * @param {string} kind
   * @param {Question} question
   * @param {(part: number) => void} [onProgress]
   * @returns {Promise<any>}
   */
  ask(kind, question, onProgress) {
    return new Promise((resolve, reject) => {
      this.#waiting.get(kind)?.resolve(null);
      this.#waiting.delete(kind);
      this.#waiting.set(kind, { kind, question, resolve, reject, onProgress });
      this.#next();
    });
  }

  #next() {
    const [waiting] = this.#waiting.values();
    if (this.#busy || !waiting) return;
    this.#waiting.delete(waiting.kind);
    this.#busy = true;
    const number = ++this.#number;
    this.#asked.set(number, waiting);
    this.#worker.postMessage({ number, kind: waiting.kind, ...waiting.question });
  }

  /** @param {{ number: number, answer?: unknown, error?: string, progress?: number }} said */
  #hear({ number, answer, error, progress }) {
    const asked = this.#asked.get(number);
    if (progress !== undefined) return asked?.onProgress?.(progress);
    this.#asked.delete(number);
    this.#busy = false;
    if (error === undefined) asked?.resolve(answer);
    else asked?.reject(new Error(error));
    this.#next();
  }
}
