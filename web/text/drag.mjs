// Drags every handle, moves every slider, presses every button and radio of the figures in a real
// browser, by mouse and by keyboard, and fails where nothing answers or the console speaks.
//
//   web/text/preview && node web/text/drag.mjs target/preview.html [DIR for a picture of each figure]
//
// It tries the page itself as well: web/build && node web/text/drag.mjs target/web/mode13h.html
import { writeFileSync } from "node:fs";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { Browser } from "../test/devtools.mjs";

const [file, pictures] = process.argv.slice(2);
const browser = await Browser.launch();
const faults = [];
let compared = 0;
const counts = { figures: 0, handles: 0, sliders: 0, choices: 0, buttons: 0 };
try {
  const page = await browser.page();
  await page.size(1280, 900, false, true);
  await page.open(pathToFileURL(resolve(file)).href);
  await page.until('document.querySelectorAll("[data-figure]").length === 12 && document.readyState === "complete"');
  // Two frames: one to draw what was asked for, one more to have drawn it.
  await page.value("globalThis.settled = () => new Promise((r) => requestAnimationFrame(() => requestAnimationFrame(r))); 0");
  for (const name of await page.value('[...document.querySelectorAll("[data-figure]")].map((f) => f.dataset.figure)')) {
    const figure = `document.querySelector('[data-figure="${name}"]')`;
    await page.value(`${figure}.scrollIntoView({ behavior: "instant" }); settled().then(settled)`);
    await page.until(`!!${figure}.querySelector("canvas")`);
    const count = (selector) => page.value(`${figure}.querySelectorAll('${selector}').length`);
    const nth = (selector, i) => `${figure}.querySelectorAll('${selector}')[${i}]`;
    // What the figure says and shows: its words, its pictures, the words for those who do not see.
    const state = async () => {
      const shown = await page.value(`settled().then(() => ${figure}.innerText
        + [...${figure}.querySelectorAll("canvas")].map((c) => c.toDataURL()).join()
        + [...${figure}.querySelectorAll("[aria-label]")].map((e) => e.ariaLabel).join())`);
      for (const [words] of shown.matchAll(/The engine \w+ other \w+/g)) faults.push(`${name}: ${words}`);
      // The promise, on the engine's own picture; rounding the exact light to a byte adds a half.
      const [, worst] = shown.match(/Worst pixel of the picture: (\d+)/) ?? [];
      const [, E] = shown.match(/allowed: ([\d.]+) shades/) ?? [];
      if (worst > +E + .5) faults.push(`${name}: ${worst} shades off within ${E}`);
      compared += worst !== undefined && E !== undefined;
      return shown;
    };
    // Does the first of these; where nothing changes, the next. A point may stand at its limit.
    const changes = async (what, ...deeds) => {
      const before = await state();
      for (const deed of deeds) {
        await deed();
        if (before !== await state()) return;
      }
      faults.push(`${name}: ${what} changes nothing`);
    };
    const middle = (element) => page.value(`(() => { ${element}.scrollIntoView({ block: "center", behavior: "instant" });
      const b = ${element}.getBoundingClientRect(); return [b.x + b.width / 2, b.y + b.height / 2]; })()`);
    const keys = (element, key, times) => async () => {
      await page.value(`${element}.focus()`);
      for (let i = 0; i < times; i++) await page.key(key);
    };
    counts.figures++;
    for (let i = 0; i < await count("input[type=radio]"); i++) {
      const radio = nth("input[type=radio]", i);
      if (await page.value(`${radio}.checked`)) continue;
      await changes(`choice ${i}`, async () => {
        const at = await middle(radio);
        await page.mouse("mousePressed", ...at);
        await page.mouse("mouseReleased", ...at);
      });
      counts.choices++;
    }
    for (let i = 0; i < await count(".fig-handle"); i++) {
      const handle = nth(".fig-handle", i);
      await changes(`dragging handle ${i}`, async () => {
        const [x, y] = await middle(handle);
        await page.mouse("mousePressed", x, y);
        for (let k = 1; k <= 4; k++) await page.mouse("mouseMoved", x - 9 * k, y - 6 * k);
        await page.mouse("mouseReleased", x - 36, y - 24);
      });
      await changes(`handle ${i} by arrow keys`, keys(handle, "ArrowRight", 2), keys(handle, "ArrowDown", 2), keys(handle, "ArrowLeft", 2));
      if (await page.value(`${handle}.classList.contains("anywhere")`)) {
        await changes(`a press beside handle ${i}`, async () => {
          await middle(handle);
          const [x, y] = await page.value(`(() => { const b = ${handle}.parentElement.getBoundingClientRect(); return [b.x + .31 * b.width, b.y + .42 * b.height]; })()`);
          await page.mouse("mousePressed", x, y);
          await page.mouse("mouseReleased", x, y);
        });
      }
      counts.handles++;
    }
    for (let i = 0; i < await count("input[type=range]"); i++) {
      const range = nth("input[type=range]", i);
      await changes(`slider ${i} by arrow keys`, keys(range, "ArrowLeft", 3), keys(range, "ArrowRight", 3));
      counts.sliders++;
    }
    const buttons = await count(".fig-button");
    if (buttons) {
      const press = (i) => async () => {
        await page.value(`${nth(".fig-button", i)}.focus()`);
        await page.key("Enter", "Enter", "\r");
      };
      for (let i = 0; i < buttons; i++) {
        // One may find its work done by the one before, which it takes back.
        await changes(`button ${i}`, press(i), press((i + 1) % buttons));
        counts.buttons++;
      }
    }
    const silent = await page.value(`[...${figure}.querySelectorAll("canvas, .fig-handle")].filter((e) => !e.ariaLabel).length`);
    if (silent) faults.push(`${name}: ${silent} pictures or handles have no words`);
    if (pictures) {
      await page.value(`${figure}.scrollIntoView({ behavior: "instant" }); settled()`);
      writeFileSync(`${pictures}/${name}.png`, await page.screenshot());
    }
  }
  const first = () => page.value('settled().then(() => document.querySelector("[data-figure] canvas").toDataURL())');
  const light = await first();
  await page.value('document.documentElement.dataset.theme = "dark"; 0');
  if (light === await first()) faults.push("the dark theme changes no canvas");
  for (const width of [1280, 768, 390, 360]) {
    await page.size(width, 800);
    const over = await page.value("settled().then(() => document.documentElement.scrollWidth - document.documentElement.clientWidth)");
    if (over > 0) faults.push(`${width} pixels wide: ${over} pixels too many`);
  }
  if (await page.value('!!document.querySelector("[data-figure=budget] .fig-pair")') && compared < 10) faults.push(`the promise was compared ${compared} times`);
  faults.push(...page.said.map((words) => `console: ${words}`));
} catch (error) {
  faults.push(String(error.stack));
} finally {
  await browser.close();
}
console.log(Object.entries(counts).map(([name, n]) => `${n} ${name}`).join(", "));
for (const fault of faults) console.log(`FAULT  ${fault}`);
process.exit(faults.length ? 1 : 0);
