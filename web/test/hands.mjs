// What hands do with the page, in Chromium: hands.mjs PAGE.html
//
// The slider by every key at every stop.
import { openScene, Suite } from "./suite.mjs";

const suite = new Suite(process.argv[2]);
suite.run(async () => {
  const tab = await suite.open();
  await slider(tab);
  suite.check("nothing was said on the console", tab.said.length === 0, tab.said.join("; "));
});

async function slider(tab) {
  await openScene(tab, "cube");
  const wrong = [];
  const last = await tab.value("LAST_STOP");
  await tab.value("element('accuracy').focus()");
  for (const [key, step] of [["ArrowRight", 1], ["ArrowUp", 1], ["ArrowLeft", -1], ["ArrowDown", -1]]) {
    for (let stop = 0; stop <= last; stop++) {
      await tab.value(`page.choose(settingAt(${stop}))`);
      await tab.key(key);
      const found = await tab.value("stopOf(page.state)");
      if (found !== Math.min(Math.max(stop + step, 0), last)) wrong.push(`${key} at ${stop}: ${found}`);
    }
  }
  suite.check("every arrow moves the slider by one stop, at each stop, both ways", wrong.length === 0, wrong.join("; "));
  await tab.key("Home");
  suite.check("its left end is the cheapest", await tab.value("page.state.maxError === null && page.state.shading === 'flat'"));
  await tab.key("End");
  suite.check("its right end is half a shade", await tab.value("page.state.maxError === 0.5"));
  await tab.value("page.choose({ maxError: null, shading: 'phong' })");
  suite.check("a shading that is not on it leaves the thumb where it was", await tab.value("element('accuracy').value === String(LAST_STOP)"));
  await tab.key("ArrowRight");
  suite.check("and a key takes it up again, at its end too", await tab.value("page.state.maxError === 0.5"));
}
