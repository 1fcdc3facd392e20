// The page's side of the worker: questions with promises. Of questions of one kind only the last waits.

class Background {
  #worker;
  #number = 0;
  #asked = new Map();
  #waiting = new Map();
  #busy = false;

  constructor(sources, wasm) {
    const address = URL.createObjectURL(new Blob(sources, { type: "text/javascript" }));
    this.#worker = new Worker(address);
    this.#worker.onmessage = ({ data }) => this.#hear(data);
    this.#worker.postMessage({ wasm });
  }

  setFiles(files) {
    this.#worker.postMessage({ files });
  }

  /** Asks. A question of the same kind that is still waiting is dropped, and its promise answers null. */
  ask(kind, question, onProgress) {
    return new Promise((resolve, reject) => {
      const lane = question.lane ?? kind;
      this.#waiting.get(lane)?.resolve(null);
      this.#waiting.delete(lane);
      this.#waiting.set(lane, { kind, question, resolve, reject, onProgress });
      this.#next();
    });
  }

  #next() {
    const [lane] = this.#waiting.keys();
    if (this.#busy || lane === undefined) return;
    const waiting = this.#waiting.get(lane);
    this.#waiting.delete(lane);
    this.#busy = true;
    const number = ++this.#number;
    this.#asked.set(number, waiting);
    this.#worker.postMessage({ number, kind: waiting.kind, ...waiting.question });
  }

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
