// The worker: what takes longer than a frame. It has an engine of its own, and answers one question at a time.
let engine;
/** What came before the engine was there waits for it. */
let ready;
/** The scene that was asked about last. */
let known = { key: "", scene: null };

function sceneOf({ toml, version }) {
  const key = `${version}\n${toml}`;
  if (known.key !== key) {
    known.scene?.free();
    known = { key: "", scene: null };
    known = { key, scene: engine.open(toml) };
  }
  return known.scene;
}

/** How far a frame is from the truth, and what was counted of it. */
function judge(scene, { seconds, pose, settings }) {
  scene.set(settings);
  scene.show(seconds, pose);
  scene.draw();
  return { ...scene.judge(), counts: scene.counts() };
}

const questions = {
  judge: (question) => judge(sceneOf(question), question),
  /** Laps of one setting and, if they are asked for, its errors and counts. */
  measure(question) {
    const scene = sceneOf(question);
    const { map, counts, ...errors } = question.judges ? judge(scene, question) : {};
    scene.set(question.settings);
    const judged = counts && { ...errors, lit: counts.lit, pixels: counts.pixels };
    return { laps: Stopwatch.laps(scene, question.seconds, question.pose, question.laps), judged };
  },
  exact(question) {
    const scene = sceneOf(question);
    scene.show(question.seconds, question.pose);
    return scene.truth();
  },
  film(question, say) {
    const scene = sceneOf(question);
    scene.set(question.settings);
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
    known = { key: "", scene: null };
    return;
  }
  const { number, kind } = data;
  try {
    const answer = questions[kind](data, (progress) => postMessage({ number, progress }));
    postMessage({ number, answer });
  } catch (error) {
    postMessage({ number, error: error.message });
  }
};
