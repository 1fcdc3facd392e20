// Whether the page's numbers are true, in Chromium: numbers.mjs PAGE.html
//
// The time that is shown against one that is taken here in place, by other means, on five scenes in three states; scenes
// in which nothing is redrawn have none.
import { openScene, Suite, wait } from "./suite.mjs";

const suite = new Suite(process.argv[2]);

/** Part by which a shown time may differ from the one measured in place. */
const NEAR = 0.15;
/** Tries, as other programs run as well. */
const TRIES = 4;
const SETTINGS = [{ maxError: null, shading: "flat" }, { maxError: 4 }, { maxError: 0.5 }];
const SCENES = [["torus", 1.2], ["teapot", 0.5], ["cone", 1.2], ["phong", 1.5], ["rgb", 1.5]];

suite.run(async () => {
  await times();
  await notRedrawn();
});

/**
 * Milliseconds of a redraw of the picture that is shown, taken in place: the lower quartile of 40 batches. Every batch
 * redraws two moments in turn, as an animation does.
 */
const inPlace = (tab) => tab.value(`(() => {
  const { scene, state } = page;
  const batches = [];
  for (let batch = 0; batch < 40; batch++) {
    let frames = 0;
    const begun = performance.now();
    do {
      for (const seconds of [state.seconds + 1 / 70, state.seconds]) {
        scene.show(seconds, state.pose);
        scene.draw(true);
        frames++;
      }
    } while (performance.now() - begun < 5);
    batches.push((performance.now() - begun) / frames);
  }
  return batches.sort((a, b) => a - b)[10];
})()`);

const shown = (tab) => tab.value("Number(/^([\\d.]+) ms$/.exec(element('ms').textContent)?.[1])");

async function isNear(tab, what) {
  const found = [];
  for (let i = 0; i < TRIES; i++) {
    await tab.until("page.left.isSettled", 60);
    await wait(400);
    const [told, taken] = [await shown(tab), await inPlace(tab)];
    if (Math.abs(told - taken) <= NEAR * taken) return suite.check(`${what}: ${told.toFixed(2)} ms shown, ${taken.toFixed(2)} in place`, true);
    found.push(`${told} shown, ${taken.toFixed(3)} in place`);
    await tab.value("page.left.reset()");
  }
  suite.check(`${what}: the time shown is near the one in place`, false, found.join("; "));
}

async function times() {
  for (const [state, isStill] of [["turning", false], ["a link", false], ["less motion", true]]) {
    for (const [at, [name, seconds]] of SCENES.entries()) {
      const setting = SETTINGS[at % SETTINGS.length];
      const accuracy = setting.maxError ? `max-error=${setting.maxError}` : `shading=${setting.shading}`;
      const link = state === "a link" ? `#scene=${name}&t=${seconds}&${accuracy}` : "";
      const tab = await suite.open({ isStill, link });
      if (!link) {
        await openScene(tab, name);
        await tab.value(`page.choose(${JSON.stringify({ ...setting, beside: "" })})`);
      }
      await isNear(tab, `${name}, ${accuracy}, ${state}`);
      suite.check(`${name}, ${state}: no message on the console`, tab.said.length === 0, tab.said.join("; "));
      await tab.close();
    }
  }
}

async function notRedrawn() {
  const tab = await suite.open();
  for (const name of ["still", "fade", "cycle"]) {
    await openScene(tab, name);
    await tab.value("page.choose({ maxError: 4, playing: true })");
    await tab.until("element('ms').textContent === 'not redrawn'");
    await tab.until("page.curve.at({ maxError: 0.5 })");
    await wait(1500);
    const points = await tab.value("document.querySelectorAll('#chart .chart-point').length");
    suite.check(`${name}: says that it is not redrawn, and has no point on the chart`, points === 0, points);
  }
}
