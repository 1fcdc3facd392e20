// @ts-check
// The worker, for work that takes longer than a frame. It has its own engine, and answers one question at a time.

import { messageOf } from "./common.js";
import { Engine, RATE } from "./engine.js";
import { Stopwatch } from "./stopwatch.js";

/**
 * @import { Scene } from "./engine.js"
 * @import { MeasureQuestion, Question } from "./types.d.ts"
 */

/** @type {Engine} */
let engine;
/**
 * Questions that arrive before the engine is ready wait for it.
 * @type {Promise<unknown>}
 */
let ready;
/**
 * The scene of the last question.
 * @type {{ key: string, scene: Scene | null }}
 */
let known = { key: "", scene: null };

/** @param {Question} question */
function sceneOf({ toml, version }) {
  const key = `${version}\n${toml}`;
  if (known.key !== key) {
    known.scene?.free();
    known = { key: "", scene: null };
    const scene = engine.open(toml);
    known = { key, scene };
    return scene;
  }
  return /** @type {Scene} */ (known.scene);
}

/**
 * How far a frame is from the truth, and its counts.
 * @param {Scene} scene
 * @param {Question} question
 */
function judge(scene, { seconds, pose, settings }) {
  scene.set(settings);
  scene.show(seconds, pose);
  scene.draw();
  return { ...scene.judge(), counts: scene.counts() };
}

/** @type {Record<string, (question: any, say: (part: number) => void) => unknown>} */
const questions = {
  /** @param {Question} question */
  judge: (question) => judge(sceneOf(question), question),
  /**
   * Laps of one setting and, if requested, its errors and counts.
   * @param {MeasureQuestion} question
   */
  measure(question) {
    const scene = sceneOf(question);
    let judged;
    if (question.judges) {
      const { map, counts, ...errors } = judge(scene, question);
      judged = { ...errors, lit: counts.lit, pixels: counts.pixels };
    }
    scene.set(question.settings);
    return { laps: Stopwatch.laps(scene, question.seconds, question.pose, question.laps), judged };
  },
  /** @param {Question} question */
  exact(question) {
    const scene = sceneOf(question);
    scene.show(question.seconds, question.pose);
    return scene.truth();
  },
  /**
   * @param {Question} question
   * @param {(part: number) => void} say
   */
  film(question, say) {
    const scene = sceneOf(question);
    scene.set(question.settings);
    scene.show(question.seconds, question.pose);
    const frames = Math.max(1, Math.round(scene.about.duration * RATE));
    let file = null;
    for (let number = 0; number < frames; number++) {
      file = scene.film(number, frames);
      if (number % 8 === 7) say((number + 1) / frames);
    }
    return { file, frames };
  },
};

onmessage = async ({ data }) => {
  if (data.wasm) {
    ready = WebAssembly.compile(data.wasm).then((module) => (engine = new Engine(module)));
    return;
  }
  await ready;
  if (data.files) {
    engine.setFiles(data.files);
    known.scene?.free();
    known = { key: "", scene: null };
    return;
  }
  const { number, kind } = data;
  try {
    const answer = questions[kind](data, (progress) => postMessage({ number, progress }));
    postMessage({ number, answer });
  } catch (error) {
    postMessage({ number, error: messageOf(error) });
  }
};
