// Drives the page in Chromium: browser.mjs PAGE.html MODE13H [FOLDER]
//
// MODE13H is the program: the pictures that the page saves must equal its files. Screenshots go to FOLDER.
import { execFileSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { box, click, drag, frames, openScene, Suite, until } from "./suite.mjs";

const [page, program, folder = "target/web/screenshots"] = process.argv.slice(2);
const scratch = mkdtempSync(join(tmpdir(), "mode13h-saved-"));
mkdirSync(folder, { recursive: true });
process.on("exit", () => rmSync(scratch, { recursive: true, force: true }));

const suite = new Suite(page);
const check = suite.check.bind(suite);
const text = (tab, id) => tab.locator(`#${id}`).textContent();
const HASH = "page.canvas.words.reduce((sum, word) => (Math.imul(sum, 31) + word) | 0, 7)";
const hash = (tab) => tab.evaluate(HASH);
const screenshot = (tab, name) => tab.screenshot({ path: join(folder, name) });

/** The file that a button of the page saves. */
async function saved(tab, button) {
  const [download] = await Promise.all([tab.waitForEvent("download"), tab.evaluate(`element(${JSON.stringify(button)}).click()`)]);
  return readFileSync(await download.path());
}

/** The page's layout: nothing overflows, and everything important is on the first screen. */
async function looks(width, height, { isDark = false, isStill = false }) {
  const who = `${width} × ${height}${isDark ? ", dark" : ""}${isStill ? ", less motion" : ""}`;
  const tab = await suite.open({ width, height, isDark, isStill });
  const wide = await tab.evaluate("document.documentElement.scrollWidth");
  check(`${who}: nothing sticks out`, wide <= width, `${wide} wide`);
  const bottoms = await tab.evaluate("['versus', 'accuracy'].map((id) => element(id).getBoundingClientRect().bottom)");
  check(`${who}: the pictures, their ratio and the slider are on the first screen`, Math.max(...bottoms) < height, bottoms.join());
  await until(tab, "/^[\\d.]+ ×$/.test(element('times').textContent)");
  check(`${who}: the ratio is told`, true);
  const paper = await tab.evaluate("getComputedStyle(document.body).backgroundColor");
  const [red] = paper.match(/\d+/g).map(Number);
  check(`${who}: the paper is ${isDark ? "dark" : "light"}`, isDark ? red < 64 : red > 192, paper);
  const seconds = await tab.evaluate("page.state.seconds");
  await frames(tab, 30);
  check(`${who}: the picture ${isStill ? "stands" : "moves"}`, ((await tab.evaluate("page.state.seconds")) === seconds) === isStill);
  check(`${who}: no message on the console`, tab.said.length === 0, tab.said.join("; "));
  await screenshot(tab, `${width}${isDark ? "-dark" : ""}${isStill ? "-still" : ""}.png`);
  await tab.context().close();
}

await suite.run(async () => {
  const tab = await suite.open();
  const first = await hash(tab);
  await until(tab, `${HASH} !== ${first}`);
  check("the picture turns", true);
  await until(tab, "/^[\\d.]+ ×$/.test(element('times').textContent)");
  check("the first screen says how many times the time accuracy takes", (await text(tab, "times-words")) === "the time →" && (await text(tab, "left-name")) === "cheapest", await text(tab, "versus"));
  await until(tab, "page.curve.at({ maxError: 0.5 }) && document.querySelectorAll('#chart .chart-point.budget').length >= 5");
  check("the curve is measured without being asked for", true);
  await openScene(tab, "torus");

  // The slider, by pointer and by key.
  await drag(tab, "#accuracy", [0.48, 0.5], [0.97, 0.5]);
  check("dragged to its right end the slider allows half a shade", (await tab.evaluate("page.state.maxError")) === 0.5, await tab.evaluate("page.state.maxError"));
  await until(tab, "page.accuracy.lastMap.asked.settings.maxError === 0.5");
  const fine = await tab.evaluate("Number(element('worst').textContent)");
  // Half a shade, plus half a shade of rounding; single pixels of faces that are seen edge-on may exceed it.
  const rms = await tab.evaluate("Number(element('rms').textContent)");
  check("and pixels are off by no more than that and rounding, r.m.s.", rms > 0 && rms <= 1, rms);
  check("the share of each technique is shown", /lit at every pixel \d+ %/.test(await text(tab, "shares-key")), await text(tab, "shares-key"));
  await tab.evaluate("element('accuracy').focus()");
  await tab.keyboard.press("Home");
  check("its left end is the cheapest", await tab.evaluate("page.state.maxError === null && page.state.shading === 'flat'"));
  await until(tab, "page.accuracy.lastMap.asked.settings.shading === 'flat' && page.accuracy.lastMap.asked.settings.maxError === null");
  const coarse = await tab.evaluate("Number(element('worst').textContent)");
  check("a flat picture is farther off", coarse > 4 * fine, `${coarse} against ${fine}`);
  await until(tab, "document.querySelectorAll('#chart .chart-point.now').length === 1");
  check("the chart shows where it is", true);

  // All shadings, measured on the page.
  await click(tab, "#measure");
  await until(tab, "!element('measure').disabled");
  const points = await tab.evaluate("document.querySelectorAll('#chart .chart-point.shading').length");
  check("every shading is a point of the chart", points === (await tab.evaluate("page.engine.shadings.length - 1")), points); // Flat is the budgets' left end.

  // The best picture in a given time.
  await tab.evaluate("element('limit').value = 1000");
  await click(tab, "#within button");
  await until(tab, "element('found').textContent.includes(', in ')");
  check("in a second the best picture is the finest", (await tab.evaluate("page.state.maxError")) === 0.5, await text(tab, "found"));
  await tab.evaluate("element('limit').value = 0.0001");
  await tab.evaluate("page.accuracy.within(0.0001)");
  check("in no time there is none, and it says so", (await text(tab, "found")).startsWith("Not here"), await text(tab, "found"));

  // The divider.
  await tab.evaluate("page.choose({ beside: 'shading flat', maxError: 0.5, playing: false, seconds: 0.5 })");
  await frames(tab);
  const half = await hash(tab);
  await drag(tab, "#screen .divider", [0.5, 0.5], [0.2, 0.5], "#screen");
  const place = await tab.evaluate("page.state.divider");
  check("the divider follows the pointer", Math.abs(place - 0.2) < 0.02, place);
  await frames(tab);
  check("and the picture right of it is another", (await hash(tab)) !== half);
  await tab.evaluate("document.querySelector('#screen .divider').focus()");
  await tab.keyboard.press("ArrowRight");
  check("and it follows keys", (await tab.evaluate("page.state.divider")) > place);
  await screenshot(tab, "divided.png");
  await tab.evaluate("page.choose({ beside: 'truth' })");
  await until(tab, "element('right-name').textContent.includes('64-bit')");

  // The magnifier: its byte is the frame's.
  await tab.evaluate("page.choose({ beside: '', maxError: null, shading: 'gouraud-8.8' })");
  await click(tab, "#picture", 0.3, 0.5);
  check("a click chooses a pixel", await tab.evaluate("page.state.pixel !== null && !page.state.playing"));
  await box(tab, "#pixel");
  await until(tab, "element('account').textContent.includes(`Pixel ${page.state.pixel.x}, ${page.state.pixel.y}:`) && document.querySelector('.register b')");
  const [byte, shown] = await tab.evaluate("(() => { const { x, y } = page.state.pixel; return [Number(/byte (\\d+)/.exec(element('account').textContent)[1]), page.scene.frame().bytes[y * 320 + x]]; })()");
  check("the pixel's byte is the frame's", byte === shown, `${byte}, ${shown}`);
  const ah = await tab.evaluate("parseInt(document.querySelector('.register b').textContent, 16)");
  check("and it is what AH holds", ah === byte, `${ah}, ${byte}`);
  const before = await tab.evaluate("page.state.pixel.x");
  await tab.evaluate("element('lens').focus()");
  await tab.keyboard.press("ArrowRight");
  check("an arrow goes to the next pixel", (await tab.evaluate("page.state.pixel.x")) === before + 1);
  await screenshot(tab, "pixel.png");

  // The plan.
  await tab.evaluate("[...document.querySelectorAll('#effects input')].find((box) => box.ariaLabel === 'lighting').click()");
  await until(tab, "page.scene.plan().find((row) => row.effect === 'lighting').on === false");
  check("lighting is switched off in the plan", true);
  await click(tab, "#as-planned");
  await until(tab, "page.scene.plan().find((row) => row.effect === 'lighting').on");
  await click(tab, "#price");
  await until(tab, "!element('price').disabled");
  check("effects have prices", (await tab.evaluate("[...document.querySelectorAll('#effects td.number')].filter((cell) => /s\\)?$/.test(cell.textContent)).length")) > 0);

  // The editor.
  await tab.evaluate("(() => { const area = element('toml'); area.value = area.value.replace('spin', 'spim'); area.dispatchEvent(new Event('input')); })()");
  await until(tab, "element('verdict').classList.contains('wrong')");
  const verdict = await text(tab, "verdict");
  check("an error stands with its line and column", /^Line 10, column 1: key `objects\[0\]\.spim`: unknown key; known are /.test(verdict), verdict);
  check("and the line is marked", (await tab.evaluate("document.querySelector('#lines b')?.textContent.trim()")) === "10");
  await tab.evaluate("element('verdict').scrollIntoView({ block: 'center' })");
  await screenshot(tab, "error.png");
  await tab.evaluate("(() => { const area = element('toml'); area.value = area.value.replace('spim', 'spin').replace('torus', 'ball').replace('shape = \"torus\"', 'shape = \"sphere\"'); area.dispatchEvent(new Event('input')); })()");
  await until(tab, "!element('verdict').classList.contains('wrong') && page.state.toml.includes('sphere')");
  check("and once it is mended the picture follows", true);

  // The link: another tab shows the same bytes.
  await tab.evaluate("page.choose({ seconds: 1.25, pose: { turn: 0.5, tilt: 0.25, zoom: 1.1 }, maxError: 2, beside: 'shading flat', divider: 0.4 })");
  await tab.evaluate("page.link()");
  await frames(tab);
  const link = await tab.evaluate("location.hash");
  const other = await suite.open({ link });
  await frames(other);
  check("a link shows the same picture", (await hash(other)) === (await hash(tab)), link);
  check("and has the same budget", (await other.evaluate("page.state.maxError")) === 2);
  check("a link has nothing to say", other.said.length === 0, other.said.join("; "));
  await other.evaluate("page.open(`${page.state.toml}\\n# ${Array.from({ length: 250_000 }, () => Math.random().toString(36)[2]).join('')}`, page.state.name)");
  await other.evaluate("page.link()");
  const length = await other.evaluate("location.hash.length");
  check("a link holds a long scene", length > 200_000, `${length} letters`);

  // A dropped model: OBJ, MTL and PNG together.
  const texture = await tab.evaluate("(async () => { const c = new OffscreenCanvas(8, 8); const x = c.getContext('2d'); x.fillStyle = '#c04020'; x.fillRect(0, 0, 8, 8); x.fillStyle = '#20a060'; x.fillRect(0, 0, 4, 4); x.fillRect(4, 4, 4, 4); return [...new Uint8Array(await (await c.convertToBlob()).arrayBuffer())]; })()");
  const model = {
    "tile.obj": "mtllib tile.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl tile\nf 1/1 2/2 3/3 4/4\n",
    "tile.mtl": "newmtl tile\nKd 1 1 1\nmap_Kd textures\\tile.png\n",
  };
  await tab.evaluate(`(() => { const data = new DataTransfer(); for (const [name, text] of Object.entries(${JSON.stringify(model)})) data.items.add(new File([text], name)); data.items.add(new File([new Uint8Array(${JSON.stringify(texture)})], "tile.png")); element("drop").dispatchEvent(new DragEvent("drop", { bubbles: true, cancelable: true, dataTransfer: data })); })()`);
  await until(tab, "page.state.name === 'tile'");
  check("a dropped model is shown", (await tab.evaluate("page.scene.about.faces")) === 2 && (await tab.evaluate("page.scene.about.warnings.length")) === 0, await tab.evaluate("page.scene.about.warnings.join()"));
  check("with its texture", await tab.evaluate("page.scene.show(0), page.scene.draw(), page.scene.plan().find((row) => row.effect === 'texture').on"));
  await tab.evaluate("page.choose({ beside: '' })");
  await until(tab, "page.accuracy.lastMap.asked.toml === page.state.toml");
  check("a file that is missing is named", /is not on the page/.test(await tab.evaluate("(() => { try { page.engine.open('objects = [{ model = \"none.obj\" }]'); } catch (error) { return error.message; } })()")));

  // A trap: the page reports it, and goes on.
  const trapped = await tab.evaluate("(() => { try { page.engine.call('room', 4294967295); } catch (error) { return error.message; } })()");
  check("a trap says why, and that another engine was started", /^The engine stopped at room: .*capacity overflow.* Another one was started\.$/s.test(trapped), trapped);
  await tab.evaluate("page.choose({ seconds: 0.4 })");
  const after = await hash(tab);
  await tab.evaluate("page.choose({ seconds: 1.1 })");
  await until(tab, `${HASH} !== ${after}`);
  check("and the page goes on", (await tab.evaluate("page.engine.generation")) === 2);

  // Saved files, against the program's.
  for (const [name, seconds, settings, options] of [
    ["torus", 1.25, { maxError: null, shading: "" }, []],
    ["teapot", 0.5, { maxError: 2 }, ["--max-error", "2"]],
    ["still", 0, { maxError: null, shading: "phong" }, ["--shading", "phong"]],
    ["cycle", 1, { maxError: null, shading: "" }, []],
  ]) {
    await tab.evaluate(`page.open(page.engine.shipped.find(({ name }) => name === "${name}").toml, "${name}")`);
    await tab.evaluate(`page.choose(${JSON.stringify({ ...settings, seconds, playing: false, beside: "" })})`);
    const file = await saved(tab, "save-png");
    const wanted = join(scratch, `program-${name}.png`);
    execFileSync(program, ["render", name, "--time", `${seconds}`, ...options, "-o", wanted]);
    check(`the saved PNG of ${name} is the file that the program writes`, file.equals(readFileSync(wanted)), `${file.length} bytes, ${readFileSync(wanted).length}`);
  }
  await tab.evaluate("page.open(page.engine.shipped.find(({ name }) => name === 'cube').toml, 'cube'), page.choose({ maxError: null, shading: '' })");
  const film = await saved(tab, "save-gif");
  execFileSync(program, ["render", "cube", "-o", join(scratch, "program.gif")]);
  check("the saved GIF is the file that the program writes", film.equals(readFileSync(join(scratch, "program.gif"))), `${film.length} bytes`);
  check("nothing was said on the console", tab.said.length === 0, tab.said.join("; "));

  // 60 frames a second with the teapot lit at every pixel.
  await tab.evaluate("page.open(page.engine.shipped.find(({ name }) => name === 'teapot').toml, 'teapot'), page.choose({ maxError: null, shading: 'phong', playing: true })");
  await until(tab, "page.left.isSettled && !element('ms').classList.contains('settling')");
  console.log(`      the teapot lit at every pixel: ${await text(tab, "ms")} each`);

  // Layout: three sizes, light, dark, with less motion.
  for (const [width, height] of [[1280, 800], [390, 844], [360, 640]]) {
    for (const look of [{}, { isDark: true }, { isStill: true }]) {
      await looks(width, height, look);
    }
  }
  const still = await suite.open({ isStill: true });
  check("who asks for less motion gets a picture that stands", (await still.evaluate("page.state.playing")) === false);
  await frames(still);
  const wrong = await still.evaluate(() => {
    const under = new OffscreenCanvas(320, 200).getContext("2d");
    const [left, right] = document.querySelectorAll(".ready");
    under.drawImage(left, 0, 0);
    under.drawImage(right, 160, 0, 160, 200, 160, 0, 160, 200);
    const [ready, drawn] = [under, page.canvas.context].map((context) => new Uint32Array(context.getImageData(0, 0, 320, 200).data.buffer));
    return ready.filter((pixel, at) => pixel !== drawn[at]).length;
  });
  check("the picture that is there before the engine is the engine's first", wrong === 0, `${wrong} pixels differ`);
  const early = await suite.tab({ javaScriptEnabled: false });
  await early.goto(suite.address);
  check("it is there without any script", await early.locator(".ready").first().isVisible());
  const linked = await suite.open({ link: "#scene=torus&t=1" });
  check("and never under a link to another scene", !(await linked.locator(".ready").first().isVisible()));
  console.log(`screenshots in ${folder}: ${readdirSync(folder).join(", ")}`);
});
