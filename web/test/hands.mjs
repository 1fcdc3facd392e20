// The page used by hand, in Chromium: hands.mjs PAGE.html
//
// The slider by every key at every stop; presses of human length while the picture turns, and the focus after them; the
// banner; a pixel's explanation and the picture visible together.
import { LAST_STOP, settingAt, stopOf } from "../page/stops.js";
import { box, click, frames, openScene, scrolled, Suite, until } from "./suite.mjs";

const suite = new Suite(process.argv[2]);
suite.run(async () => {
  const tab = await suite.open();
  await sweep();
  await slider(tab);
  await presses(tab);
  await focus(tab);
  await chart(tab);
  await words(tab);
  await banner(tab);
  await pose(tab);
  await pinch();
  await names(tab);
  await waiting(tab);
  await measuring(tab);
  await explained(tab);
  await account();
  suite.check("nothing was said on the console", tab.said.length === 0, tab.said.join("; "));
});

async function slider(tab) {
  await openScene(tab, "cube");
  const wrong = [];
  await tab.evaluate("element('accuracy').focus()");
  for (const [key, step] of [["ArrowRight", 1], ["ArrowUp", 1], ["ArrowLeft", -1], ["ArrowDown", -1]]) {
    for (let stop = 0; stop <= LAST_STOP; stop++) {
      await tab.evaluate(`page.choose(${JSON.stringify(settingAt(stop))})`);
      await tab.keyboard.press(key);
      const found = stopOf(await tab.evaluate("page.state"));
      if (found !== Math.min(Math.max(stop + step, 0), LAST_STOP)) wrong.push(`${key} at ${stop}: ${found}`);
    }
  }
  suite.check("every arrow moves the slider by one stop, at each stop, both ways", wrong.length === 0, wrong.join("; "));
  await tab.keyboard.press("Home");
  suite.check("its left end is the cheapest", await tab.evaluate("page.state.maxError === null && page.state.shading === 'flat'"));
  await tab.keyboard.press("End");
  suite.check("its right end is half a shade", await tab.evaluate("page.state.maxError === 0.5"));
  await tab.evaluate("page.choose({ maxError: null, shading: 'phong' })");
  suite.check("a shading that is not on it leaves the thumb where it was", (await tab.evaluate("element('accuracy').value")) === `${LAST_STOP}`);
  await tab.keyboard.press("ArrowRight");
  suite.check("and a key takes it up again, at its end too", await tab.evaluate("page.state.maxError === 0.5"));
}

/** Frames of a press: 110 ms, as long as a human's. */
const PRESS = 7;

/** Presses as long as a human does, while the picture turns. */
async function press(tab, selector) {
  const { x, y, width, height } = await box(tab, selector);
  await tab.mouse.move(x + width / 2, y + height / 2);
  await tab.mouse.down();
  await frames(tab, PRESS);
  await tab.mouse.up();
}

async function presses(tab) {
  await openScene(tab, "teapot");
  await tab.evaluate(`page.choose({ ...${JSON.stringify(settingAt(9))}, playing: true, beside: '', pixel: { x: 160, y: 100 } })`);
  await tab.evaluate("element('account').scrollIntoView({ block: 'center', behavior: 'instant' })");
  await until(tab, "element('account').textContent.includes('Pixel 160')");
  const targets = [
    ["the plan", "#effect-back-face-culling", "element('effect-back-face-culling').checked"],
    ["the account", "#account summary", "document.querySelector('#account details').open"],
  ];
  for (const [what, selector, state] of targets) {
    let took = 0;
    for (let i = 0; i < 24; i++) {
      const before = await tab.evaluate(state);
      await press(tab, selector);
      await frames(tab);
      took += (await tab.evaluate(state)) !== before;
    }
    suite.check(`24 presses on ${what} all take while the picture turns`, took === 24 && (await tab.evaluate("page.state.playing")), took);
  }
  await tab.evaluate("page.choose({ effects: {} })");
}

/** Frames after which all displayed values have been updated twice. */
const TOLD = 40;

async function focus(tab) {
  await tab.evaluate("element('effect-back-face-culling').focus()");
  await tab.keyboard.press("Space");
  await frames(tab, TOLD);
  suite.check("a switch of the plan keeps the focus", (await tab.evaluate("document.activeElement.id")) === "effect-back-face-culling");
  await tab.evaluate("page.choose({ effects: {} })");
  await tab.evaluate("document.querySelector('#account summary').focus()");
  await frames(tab, TOLD);
  suite.check("and so does the account", (await tab.evaluate("document.activeElement.tagName")) === "SUMMARY");
}

/** If the slider changes nothing, the page says why. */
async function words(tab) {
  for (const [name, said] of [["cube", "Flat faces: already exact"], ["flash", "only the cheapest method differs"]]) {
    await openScene(tab, name);
    await tab.evaluate("page.choose({ maxError: 4, beside: '' })");
    await until(tab, `element('why').textContent.includes(${JSON.stringify(said)})`);
    suite.check(`${name}: the page says why the slider changes nothing`, true);
  }
}

/** The banner stays as long as its cause, and can be closed. */
async function banner(tab) {
  const drop = (name, text) => tab.evaluate(`page.scenes.take([new File([${JSON.stringify(text)}], ${JSON.stringify(name)})])`);
  const isThere = () => tab.evaluate("!element('trouble').hidden");
  await drop("bad.obj", "v 0 0 0\nf 1 2 3\n");
  suite.check("a bad model is named in the banner", (await isThere()) && (await tab.evaluate("element('trouble').textContent")).includes("bad.obj"));
  await openScene(tab, "cube");
  suite.check("a scene that works takes it away", !(await isThere()));
  await tab.evaluate("location.hash = '#scene=nothing'");
  await until(tab, "!element('trouble').hidden");
  await drop("good.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  suite.check("and so does a model, after a link that leads nowhere", !(await isThere()));
  await drop("bad.obj", "v 0 0 0\nf 1 2 3\n");
  await click(tab, "#trouble-close");
  suite.check("its button closes it", !(await isThere()));
}

/** A click on the picture opens the pixel's explanation with the picture still in view; it starts on an object. */
async function account() {
  for (const [width, height] of [[1280, 800], [390, 844], [360, 640]]) {
    const tab = await suite.open({ width, height });
    await openScene(tab, "torus");
    // The divider, which at first moves by itself, must not be under the click.
    await tab.evaluate("page.choose({ beside: '' })");
    await until(tab, "page.accuracy.lastMap.asked.toml === page.state.toml");
    await tab.evaluate("element('pixel').scrollIntoView({ behavior: 'instant' })");
    await until(tab, "element('account').textContent.includes('Triangle')");
    suite.check(`${width}: the magnifier begins on an object`, true);
    await tab.evaluate("scrollTo({ top: 0, behavior: 'instant' })");
    await scrolled(tab);
    await until(tab, "!element('bezel').classList.contains('mini')");
    await click(tab, "#picture", 0.3, 0.5);
    await until(tab, "page.state.pixel");
    // The page scrolls there smoothly.
    const seen = "(box, least) => Math.min(box.bottom, innerHeight) - Math.max(box.top, 0) >= least";
    await until(tab, `(${seen})(element('account').getBoundingClientRect(), 100)`);
    await scrolled(tab);
    for (const [what, id, least] of [["account", "account", 100], ["picture", "picture", 90]]) {
      const box = await tab.evaluate(`(({ top, bottom }) => ({ top, bottom }))(element(${JSON.stringify(id)}).getBoundingClientRect())`);
      suite.check(`${width}: after a click the ${what} is in the window`, await tab.evaluate(`(${seen})(${JSON.stringify(box)}, ${least})`), JSON.stringify(box));
    }
    await tab.evaluate("element('plan').scrollIntoView({ behavior: 'instant' })");
    await scrolled(tab);
    suite.check(`${width}: and at the plan the picture is still there`, await tab.evaluate(`(${seen})(element('picture').getBoundingClientRect(), 90)`));
    await tab.context().close();
  }
}

/** The wheel zooms a focused picture, and a button resets it; the theme is stored. */
async function pose(tab) {
  await openScene(tab, "torus");
  await tab.evaluate("scrollTo({ top: 0, behavior: 'instant' }), element('picture').focus()");
  const { x, y, width, height } = await box(tab, "#picture");
  await tab.mouse.move(x + width / 3, y + height / 2);
  await tab.mouse.wheel(0, -200);
  await until(tab, "page.state.pose.zoom > 1.05");
  suite.check("the wheel zooms the picture that has the focus", true);
  await tab.evaluate("document.activeElement.blur(), page.choose({ pose: { turn: 0, tilt: 0, zoom: 1 } })");
  await tab.keyboard.down("Control");
  await tab.mouse.wheel(0, -50);
  await tab.keyboard.up("Control");
  await until(tab, "page.state.pose.zoom > 1.05");
  suite.check("a pinch on a touchpad, which is a wheel with Control, zooms it without the focus", true);
  const zoom = await tab.evaluate("page.state.pose.zoom");
  await tab.mouse.wheel(0, 200);
  await until(tab, "scrollY > 0");
  suite.check("and the wheel alone then scrolls the page", (await tab.evaluate("page.state.pose.zoom")) === zoom);
  await click(tab, "#first-pose");
  suite.check("a button leads back to the first pose", await tab.evaluate("page.state.pose.zoom === 1 && element('first-pose').hidden"));
  await click(tab, "#theme");
  const theme = await tab.evaluate("document.documentElement.dataset.theme");
  await tab.reload();
  await until(tab, "globalThis.page?.scenes");
  suite.check("the theme is kept", (await tab.evaluate("document.documentElement.dataset.theme")) === theme && theme !== "", theme);
  await tab.evaluate("localStorage.removeItem('theme')");
}

/** Two fingers zoom the picture by as much as they spread, and do nothing else; one finger up or down scrolls the page. */
async function pinch() {
  const tab = await suite.open({ width: 390, height: 844 });
  await openScene(tab, "torus");
  await tab.evaluate("page.choose({ beside: '', playing: false })");
  const { x, y, width, height } = await box(tab, "#picture");
  const place = await tab.evaluate("scrollY");
  const middle = [x + width / 2, y + height / 2];
  const client = await tab.context().newCDPSession(tab);
  const touch = (type, ...points) => client.send("Input.dispatchTouchEvent", { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
  /** Puts two fingers on either side of the middle, and moves them from one distance to another. */
  const part = async ([dx, dy], from, to) => {
    const points = (far) => [-1, 1].map((side) => [middle[0] + side * far * dx, middle[1] + side * far * dy]);
    await touch("touchStart", ...points(from));
    for (let step = 1; step <= 8; step++) await touch("touchMove", ...points(from + ((to - from) * step) / 8));
    await touch("touchEnd");
    return tab.evaluate("page.state.pose.zoom");
  };
  const isNear = (zoom, wanted) => Math.abs(zoom / wanted - 1) < 0.001;
  const wider = await part([1, 0], 20, 60);
  suite.check("two fingers three times as far apart enlarge the picture three times", isNear(wider, 3), wider);
  const back = await part([1, 0], 60, 20);
  suite.check("and as near again they make it as small as it was", isNear(back, 1), back);
  const slanting = await part([0.8, 0.6], 25, 50);
  suite.check("on a slant, too", isNear(slanting, 2), slanting);
  const rest = await tab.evaluate("[page.state.pixel, page.state.pose.turn, page.state.pose.tilt, visualViewport.scale, scrollY]");
  suite.check("nothing else comes of it: no pixel, no turn, no zoom or scroll of the page", JSON.stringify(rest) === JSON.stringify([null, 0, 0, 1, place]), rest.join());
  await touch("touchStart", middle);
  for (let step = 1; step <= 8; step++) await touch("touchMove", [middle[0], middle[1] - 15 * step]);
  await touch("touchEnd");
  await scrolled(tab);
  suite.check("one finger upward scrolls the page, and leaves the pose", await tab.evaluate("scrollY > 50 && page.state.pose.turn === 0 && page.state.pose.tilt === 0"));
  await tab.evaluate("scrollTo({ top: 0, behavior: 'instant' })");
  await touch("touchStart", middle);
  for (let step = 1; step <= 8; step++) await touch("touchMove", [middle[0] + 10 * step, middle[1]]);
  await touch("touchEnd");
  suite.check("one finger to the right rotates it", await tab.evaluate("page.state.pose.turn > 0.1"));
  await tab.context().close();
}

/** The name of an edited scene, files that a link cannot contain, and files that cannot be read. */
async function names(tab) {
  await openScene(tab, "cube");
  await tab.evaluate("(() => { const area = element('toml'); area.value += '\\n# mine'; area.dispatchEvent(new Event('input')); })()");
  await until(tab, "page.state.name === 'cube-edited'");
  suite.check("an edited scene has another name, and no card", (await tab.evaluate("document.querySelectorAll('.card[aria-current=true]').length")) === 0);
  await tab.evaluate("page.scenes.take([new File(['v 0 0 0\\nv 1 0 0\\nv 0 1 0\\nf 1 2 3\\n'], 'mine.obj'), new File(['?'], 'mine.jpg')])");
  suite.check("a file that cannot be read is named", (await tab.evaluate("element('trouble').textContent")).includes("mine.jpg: not read"));
  await click(tab, "#copy-link");
  await until(tab, "element('saved').textContent.includes('does not include mine.obj')");
  suite.check("a link says what it cannot carry", true);
}

/** A text or a link that names files which are dropped afterwards. */
async function waiting(tab) {
  const drop = (name, text) => tab.evaluate(`page.scenes.take([new File([${JSON.stringify(text)}], ${JSON.stringify(name)})])`);
  const triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const texts = ["first", "second"].map((name) => `objects = [{ model = "${name}.obj" }]\nlights = [{ sun = [0.4, 0.6, 1] }]\n`);
  await openScene(tab, "cube");
  await tab.evaluate(`(() => { const area = element('toml'); area.value = ${JSON.stringify(texts[0])}; area.dispatchEvent(new Event('input')); })()`);
  await until(tab, "element('verdict').textContent.includes('not on the page')");
  await drop("other.mtl", "newmtl any\n");
  suite.check("a file that is dropped leaves the text that is being written", (await tab.evaluate("element('toml').value")) === texts[0]);
  await drop("first.obj", triangle);
  suite.check("and the model that the text names is shown by that text", await tab.evaluate(`page.state.toml === ${JSON.stringify(texts[0])} && page.scene.about.faces === 1`));
  const link = await tab.evaluate(`(async () => {
    page.open(${JSON.stringify(texts[0])}, "linked");
    page.choose({ pose: { turn: 0.5, tilt: 0, zoom: 2 }, maxError: 4, pixel: { x: 20, y: 30 } });
    await page.link();
    return location.hash;
  })()`);
  const other = await suite.open({ link });
  await until(other, "element('trouble').textContent.includes('not on the page')");
  await frames(other, TOLD);
  suite.check("a link that lacks its model stays in the address", (await other.evaluate("location.hash")) === link);
  await other.evaluate(`page.scenes.take([new File([${JSON.stringify(triangle)}], "first.obj")])`);
  const shown = await other.evaluate("[page.state.name, page.state.pose.turn, page.state.pose.zoom, page.state.maxError, page.state.pixel.x]");
  suite.check("and opens with its pose and settings once that is dropped", shown.join() === "linked,0.5,2,4,20", shown.join());
  await other.context().close();
  for (const [wrong, said] of [["effect=zzz:on", "the effect zzz"], ["shading=none", "the shading none"], ["beside=nothing", "the other side nothing"]]) {
    await tab.evaluate(`location.hash = '#scene=torus&${wrong}'`);
    await until(tab, `element('trouble').textContent.includes(${JSON.stringify(said)})`);
  }
  suite.check("a link with an unknown name says which", true);
}

/** What was measured of one scene is not said of another. */
async function measuring(tab) {
  await openScene(tab, "teapot");
  await tab.evaluate("page.choose({ maxError: 4, beside: '' })");
  await tab.evaluate("(async () => { const found = page.accuracy.within(0.0001); await new Promise((done) => setTimeout(done)); page.open(page.engine.shipped.find(({ name }) => name === 'cube').toml, 'cube'); await found; })()");
  suite.check("a search is given up when another scene is opened", await tab.evaluate("page.state.maxError === 4 && element('found').textContent === ''"));
  await openScene(tab, "teapot");
  await tab.evaluate("page.redraw()");
  await until(tab, "page.plan.rows[0]?.object !== 'cube'");
  await tab.evaluate("(async () => { const prices = page.plan.measure(); await new Promise((done) => setTimeout(done)); page.open(page.engine.shipped.find(({ name }) => name === 'cube').toml, 'cube'); await prices; })()");
  await frames(tab, TOLD);
  const prices = await tab.evaluate("[...document.querySelectorAll('#plan tbody td.number')].map((cell) => cell.textContent).join('')");
  suite.check("and prices of one scene are not shown for another", prices === "", prices);
}

/** The explanation of a pixel says nothing of a shade where there is none. */
async function explained(tab) {
  const account = (name, setting) => tab.evaluate(`(() => {
    page.open(page.engine.shipped.find(({ name }) => name === ${JSON.stringify(name)}).toml, ${JSON.stringify(name)});
    page.choose(${JSON.stringify({ maxError: null, shading: "", ...setting, playing: false })});
    page.drawLeft();
    for (let y = 5; y < 200; y += 10) for (let x = 5; x < 320; x += 10) {
      const account = page.scene.explain(x, y);
      if (account.object !== undefined) return account;
    }
  })()`);
  const table = await account("phong-table", {});
  suite.check("a table of normals has no exact shade", table.exact === undefined && table.registers === null, JSON.stringify(table.exact));
  const channels = await account("rgb", {});
  suite.check("nor have three channels, or registers", channels.exact === undefined && channels.registers === null, JSON.stringify(channels.registers));
  const ramp = await account("cube", { shading: "gouraud-8.8" });
  suite.check("the value of a ramp is called an entry", ramp.isRamp === true, JSON.stringify(ramp));
  const wide = await account("torus", { shading: "gouraud-16.16" });
  suite.check("in 16.16 the registers are wide", wide.registers.isWide === true, JSON.stringify(wide.registers));
}

/** The divider moves once by itself and stops in the middle, unless the reader asks for less motion. */
async function sweep() {
  for (const isStill of [false, true]) {
    const tab = await suite.tab({ isStill });
    await tab.addInitScript(() => {
      globalThis.places = [];
      const look = () => {
        const place = globalThis.page?.state.divider;
        if (place !== undefined && place !== places.at(-1)) places.push(place);
        requestAnimationFrame(look);
      };
      look();
    });
    await tab.goto(suite.address);
    await until(tab, "globalThis.page?.scenes");
    /** Whether it stays still for a second. */
    const stands = async () => {
      const count = await tab.evaluate("places.length");
      await frames(tab, 60);
      return count === (await tab.evaluate("places.length"));
    };
    for (let second = 0; second < 60 && !(await stands()); second++);
    const places = await tab.evaluate("places");
    if (isStill) suite.check("where less motion is asked for the divider stands", places.join() === "0.5", places.join());
    else {
      suite.check("the divider moves to and fro by itself at first", Math.min(...places) < 0.3 && Math.max(...places) > 0.7, places.join());
      suite.check("and then stands in the middle", Math.abs(places.at(-1) - 0.5) < 1e-9, places.at(-1));
    }
    await tab.context().close();
  }
}

/** Points of the chart by keys, while the chart is redrawn under the focus. */
async function chart(tab) {
  await openScene(tab, "torus");
  await tab.evaluate(`page.choose({ ...${JSON.stringify(settingAt(9))}, playing: true, beside: '' })`);
  await until(tab, "document.querySelectorAll('#chart [data-key]').length >= 6");
  await tab.evaluate("document.querySelector('#chart [data-key=\"max-error 1\"]').focus()");
  await frames(tab, TOLD);
  suite.check("a point of the chart keeps the focus", (await tab.evaluate("document.activeElement.dataset.key")) === "max-error 1");
  await tab.keyboard.press("Enter");
  suite.check("and Enter chooses it", (await tab.evaluate("page.state.maxError")) === 1);
}
