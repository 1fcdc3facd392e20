// What hands do with the page, in Chromium: hands.mjs PAGE.html
//
// The slider by every key at every stop; presses as long as a hand's while the picture turns; where the focus is then; the
// banner; the pixel's account and the picture in one window.
import { openScene, Suite, wait } from "./suite.mjs";

const suite = new Suite(process.argv[2]);
suite.run(async () => {
  const tab = await suite.open();
  await sweep(tab);
  await slider(tab);
  await presses(tab);
  await focus(tab);
  await chart(tab);
  await words(tab);
  await banner(tab);
  await pose(tab);
  await names(tab);
  await account();
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

/** Presses for 110 ms, as a hand does, while the picture turns. */
async function press(tab, selector) {
  const { x, y, width, height } = await tab.box(selector);
  const at = [x + width / 2, y + height / 2];
  await tab.mouse("mousePressed", ...at);
  await wait(110);
  await tab.mouse("mouseReleased", ...at);
}

async function presses(tab) {
  await openScene(tab, "teapot");
  await tab.value("page.choose({ ...settingAt(9), playing: true, beside: '', pixel: { x: 160, y: 100 } })");
  await tab.value("element('account').scrollIntoView({ block: 'center', behavior: 'instant' })");
  await tab.until("element('account').textContent.includes('Pixel 160')");
  const targets = [
    ["the plan", "#effect-back-face-culling", "element('effect-back-face-culling').checked"],
    ["the account", "#account summary", "document.querySelector('#account details').open"],
  ];
  for (const [what, selector, state] of targets) {
    let took = 0;
    for (let i = 0; i < 24; i++) {
      const before = await tab.value(state);
      await press(tab, selector);
      await tab.value("new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn)))");
      took += (await tab.value(state)) !== before;
    }
    suite.check(`24 presses on ${what} all take while the picture turns`, took === 24 && (await tab.value("page.state.playing")), took);
  }
  await tab.value("page.choose({ effects: {} })");
}

async function focus(tab) {
  await tab.value("element('effect-back-face-culling').focus()");
  await tab.key(" ", "Space", " ");
  await wait(700);
  suite.check("a switch of the plan keeps the focus", (await tab.value("document.activeElement.id")) === "effect-back-face-culling");
  await tab.value("page.choose({ effects: {} })");
  await tab.value("document.querySelector('#account summary').focus()");
  await wait(700);
  suite.check("and so does the account", (await tab.value("document.activeElement.tagName")) === "SUMMARY");
}

/** Where the slider changes nothing the page says why. */
async function words(tab) {
  for (const [name, said] of [["cube", "Flat faces: already exact"], ["flash", "only the cheapest method differs"]]) {
    await openScene(tab, name);
    await tab.value("page.choose({ maxError: 4, beside: '' })");
    await tab.until(`element('why').textContent.includes(${JSON.stringify(said)})`, 40);
    suite.check(`${name}: the page says why the slider changes nothing`, true);
  }
}

/** The banner is there as long as its cause, and can be closed. */
async function banner(tab) {
  const drop = (name, text) => tab.value(`page.scenes.take([new File([${JSON.stringify(text)}], ${JSON.stringify(name)})])`);
  const isThere = () => tab.value("!element('trouble').hidden");
  await drop("bad.obj", "v 0 0 0\nf 1 2 3\n");
  suite.check("a bad model is named in the banner", (await isThere()) && (await tab.value("element('trouble').textContent")).includes("bad.obj"));
  await openScene(tab, "cube");
  suite.check("a scene that works takes it away", !(await isThere()));
  await tab.value("location.hash = '#scene=nothing'");
  await tab.until("!element('trouble').hidden");
  await drop("good.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  suite.check("and so does a model, after a link that leads nowhere", !(await isThere()));
  await drop("bad.obj", "v 0 0 0\nf 1 2 3\n");
  await tab.click("#trouble-close");
  suite.check("its button closes it", !(await isThere()));
}

/** A click on the picture opens the pixel's account where the picture still is; and it begins on an object. */
async function account() {
  for (const [width, height] of [[1280, 800], [390, 844], [360, 640]]) {
    const tab = await suite.open({ width, height });
    await openScene(tab, "torus");
    // The divider, which at first moves by itself, must not be under the click.
    await tab.value("page.choose({ beside: '' })");
    await tab.until("page.accuracy.lastMap.asked.toml === page.state.toml");
    await tab.value("element('pixel').scrollIntoView({ behavior: 'instant' })");
    await tab.until("element('account').textContent.includes('Triangle')");
    suite.check(`${width}: the magnifier begins on an object`, true);
    await tab.value("scrollTo({ top: 0, behavior: 'instant' })");
    // The small picture goes when the browser next looks what is in the window.
    await wait(500);
    await tab.until("!element('bezel').classList.contains('mini')");
    await tab.click("#picture", 0.3, 0.5);
    await tab.until("page.state.pixel");
    // The page scrolls there smoothly.
    const seen = "(box, least) => Math.min(box.bottom, innerHeight) - Math.max(box.top, 0) >= least";
    await tab.until(`(${seen})(element('account').getBoundingClientRect(), 100)`);
    await wait(900);
    for (const [what, id, least] of [["account", "account", 100], ["picture", "picture", 90]]) {
      const box = await tab.value(`(({ top, bottom }) => ({ top, bottom }))(element(${JSON.stringify(id)}).getBoundingClientRect())`);
      suite.check(`${width}: after a click the ${what} is in the window`, await tab.value(`(${seen})(${JSON.stringify(box)}, ${least})`), JSON.stringify(box));
    }
    await tab.value("element('plan').scrollIntoView({ behavior: 'instant' })");
    await wait(300);
    suite.check(`${width}: and at the plan the picture is still there`, await tab.value(`(${seen})(element('picture').getBoundingClientRect(), 90)`));
    await tab.close();
  }
}

/** The wheel zooms the picture that has the focus, a button leads back; the theme is kept. */
async function pose(tab) {
  await openScene(tab, "torus");
  await tab.value("scrollTo({ top: 0, behavior: 'instant' }), element('picture').focus()");
  const { x, y, width, height } = await tab.box("#picture");
  await tab.ask("Input.dispatchMouseEvent", { type: "mouseWheel", x: x + width / 3, y: y + height / 2, deltaX: 0, deltaY: -200 });
  await tab.until("page.state.pose.zoom > 1.05");
  suite.check("the wheel zooms the picture that has the focus", true);
  await tab.click("#first-pose");
  suite.check("a button leads back to the first pose", await tab.value("page.state.pose.zoom === 1 && element('first-pose').hidden"));
  await tab.click("#theme");
  const theme = await tab.value("document.documentElement.dataset.theme");
  await tab.open(suite.address);
  await tab.until("globalThis.page?.scenes");
  suite.check("the theme is kept", (await tab.value("document.documentElement.dataset.theme")) === theme && theme !== "", theme);
  await tab.value("localStorage.removeItem('theme')");
}

/** What an edited scene is called, what a link cannot carry, and what cannot be read. */
async function names(tab) {
  await openScene(tab, "cube");
  await tab.value("(() => { const area = element('toml'); area.value += '\\n# mine'; area.dispatchEvent(new Event('input')); })()");
  await tab.until("page.state.name === 'cube-edited'");
  suite.check("an edited scene has another name, and no card", (await tab.value("document.querySelectorAll('.card[aria-current=true]').length")) === 0);
  await tab.value("page.scenes.take([new File(['v 0 0 0\\nv 1 0 0\\nv 0 1 0\\nf 1 2 3\\n'], 'mine.obj'), new File(['?'], 'mine.jpg')])");
  suite.check("a file that cannot be read is named", (await tab.value("element('trouble').textContent")).includes("mine.jpg: not read"));
  await tab.click("#copy-link");
  await tab.until("element('saved').textContent.includes('cannot carry mine.obj')");
  suite.check("a link says what it cannot carry", true);
}

/** The divider moves once by itself and stops in the middle; where less motion is asked for it does not. */
async function sweep(tab) {
  const places = (tab) => tab.value(`(async () => {
    const places = new Set();
    for (const end = performance.now() + 1500; performance.now() < end; ) {
      places.add(page.state.divider);
      await new Promise((later) => setTimeout(later, 50));
    }
    return places.size;
  })()`);
  await tab.open(suite.address);
  await tab.until("globalThis.page?.scenes");
  suite.check("the divider moves by itself at first", (await places(tab)) > 3);
  await wait(4000);
  suite.check("and then stands in the middle", (await places(tab)) === 1 && Math.abs((await tab.value("page.state.divider")) - 0.5) < 0.001);
  const still = await suite.open({ isStill: true });
  suite.check("where less motion is asked for it stands", (await places(still)) === 1);
  await still.close();
  await tab.front();
}

/** Points of the chart by keys: the chart is drawn again and again under the focus. */
async function chart(tab) {
  await openScene(tab, "torus");
  await tab.value("page.choose({ ...settingAt(9), playing: true, beside: '' })");
  await tab.until("document.querySelectorAll('#chart [data-key]').length >= 6", 40);
  await tab.value("document.querySelector('#chart [data-key=\"max-error 1\"]').focus()");
  await wait(900);
  suite.check("a point of the chart keeps the focus", (await tab.value("document.activeElement.dataset.key")) === "max-error 1");
  await tab.key("Enter", "Enter", "\r");
  suite.check("and Enter chooses it", (await tab.value("page.state.maxError")) === 1);
}
