// Drags every handle, moves every slider, presses every button and radio of the figures in a real
// browser, by mouse and by keyboard, and fails if something does not respond or the console prints.
//
//   web/text/preview && node web/text/drag.mjs target/preview.html [DIR for a picture of each figure]
//
// It can test the page itself as well: web/build && node web/text/drag.mjs target/web/mode13h.html
import { Suite, until } from "../test/suite.mjs";

const [file, pictures] = process.argv.slice(2);
const suite = new Suite(file);
const faults = [];
let compared = 0;
const counts = { figures: 0, handles: 0, sliders: 0, choices: 0, buttons: 0 };
await suite.run(async () => {
  const page = await suite.tab({ height: 900, isStill: true });
  await page.goto(suite.address);
  await until(page, 'document.querySelectorAll("[data-figure]").length === 12 && document.readyState === "complete"');
  // Two frames: one in which the change is drawn, and one to be sure that it has been.
  await page.evaluate("globalThis.settled = () => new Promise((r) => requestAnimationFrame(() => requestAnimationFrame(r))); 0");
  for (const name of await page.evaluate('[...document.querySelectorAll("[data-figure]")].map((f) => f.dataset.figure)')) {
    const figure = `document.querySelector('[data-figure="${name}"]')`;
    await page.evaluate(`${figure}.scrollIntoView({ behavior: "instant" }); settled().then(settled)`);
    await until(page, `!!${figure}.querySelector("canvas")`);
    const count = (selector) => page.evaluate(`${figure}.querySelectorAll('${selector}').length`);
    const nth = (selector, i) => `${figure}.querySelectorAll('${selector}')[${i}]`;
    // The contents of the figure: its text, its pictures, and the text for screen readers.
    const state = async () => {
      const shown = await page.evaluate(`settled().then(() => ${figure}.innerText
        + [...${figure}.querySelectorAll("canvas")].map((c) => c.toDataURL()).join()
        + [...${figure}.querySelectorAll("[aria-label]")].map((e) => e.ariaLabel).join())`);
      for (const [words] of shown.matchAll(/The engine \w+ other \w+/g)) faults.push(`${name}: ${words}`);
      // The promise, on the engine's own picture; rounding the exact light to a byte adds half a shade.
      const [, worst] = shown.match(/Worst pixel of the picture: (\d+)/) ?? [];
      const [, E] = shown.match(/allowed error: ([\d.]+) shades/) ?? [];
      if (worst > +E + .5) faults.push(`${name}: ${worst} shades off within ${E}`);
      compared += worst !== undefined && E !== undefined;
      return shown;
    };
    // Does the first of these; if nothing changes, the next, because a point may be at its limit.
    const changes = async (what, ...deeds) => {
      const before = await state();
      for (const deed of deeds) {
        await deed();
        if (before !== await state()) return;
      }
      faults.push(`${name}: ${what} changes nothing`);
    };
    const middle = (element) => page.evaluate(`(() => { ${element}.scrollIntoView({ block: "center", behavior: "instant" });
      const b = ${element}.getBoundingClientRect(); return [b.x + b.width / 2, b.y + b.height / 2]; })()`);
    const keys = (element, key, times) => async () => {
      await page.evaluate(`${element}.focus()`);
      for (let i = 0; i < times; i++) await page.keyboard.press(key);
    };
    counts.figures++;
    for (let i = 0; i < await count("input[type=radio]"); i++) {
      const radio = nth("input[type=radio]", i);
      if (await page.evaluate(`${radio}.checked`)) continue;
      await changes(`choice ${i}`, async () => {
        const at = await middle(radio);
        await page.mouse.click(...at);
      });
      counts.choices++;
    }
    for (let i = 0; i < await count(".fig-handle"); i++) {
      const handle = nth(".fig-handle", i);
      await changes(`dragging handle ${i}`, async () => {
        const [x, y] = await middle(handle);
        await page.mouse.move(x, y);
        await page.mouse.down();
        await page.mouse.move(x - 36, y - 24, { steps: 4 });
        await page.mouse.up();
      });
      await changes(`handle ${i} by arrow keys`, keys(handle, "ArrowRight", 2), keys(handle, "ArrowDown", 2), keys(handle, "ArrowLeft", 2));
      if (await page.evaluate(`${handle}.classList.contains("anywhere")`)) {
        await changes(`a press beside handle ${i}`, async () => {
          await middle(handle);
          const [x, y] = await page.evaluate(`(() => { const b = ${handle}.parentElement.getBoundingClientRect(); return [b.x + .31 * b.width, b.y + .42 * b.height]; })()`);
          await page.mouse.click(x, y);
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
        await page.evaluate(`${nth(".fig-button", i)}.focus()`);
        await page.keyboard.press("Enter");
      };
      for (let i = 0; i < buttons; i++) {
        // A control's effect may already have been reached by the one before it, which is then undone.
        await changes(`button ${i}`, press(i), press((i + 1) % buttons));
        counts.buttons++;
      }
    }
    const silent = await page.evaluate(`[...${figure}.querySelectorAll("canvas, .fig-handle")].filter((e) => !e.ariaLabel).length`);
    if (silent) faults.push(`${name}: ${silent} pictures or handles have no words`);
    if (pictures) {
      await page.evaluate(`${figure}.scrollIntoView({ behavior: "instant" }); settled()`);
      await page.screenshot({ path: `${pictures}/${name}.png` });
    }
  }
  const first = () => page.evaluate('settled().then(() => document.querySelector("[data-figure] canvas").toDataURL())');
  const light = await first();
  await page.evaluate('document.documentElement.dataset.theme = "dark"; 0');
  if (light === await first()) faults.push("the dark theme changes no canvas");
  for (const width of [1280, 768, 390, 360]) {
    await page.setViewportSize({ width, height: 800 });
    const over = await page.evaluate("settled().then(() => document.documentElement.scrollWidth - document.documentElement.clientWidth)");
    if (over > 0) faults.push(`${width} pixels wide: ${over} pixels too many`);
  }
  if (await page.evaluate('!!document.querySelector("[data-figure=budget] .fig-pair")') && compared < 10) faults.push(`the promise was compared ${compared} times`);
  faults.push(...page.said.map((words) => `console: ${words}`));
  suite.check(Object.entries(counts).map(([name, n]) => `${n} ${name}`).join(", "), faults.length === 0, faults.join("\n"));
});
