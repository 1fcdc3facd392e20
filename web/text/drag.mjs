// Drags every handle, moves every slider, presses every button and radio of the figures in a real
// browser, by mouse and by keyboard, and fails where nothing answers or the console speaks.
//
//   web/text/preview && node web/text/drag.mjs target/preview.html [DIR for a picture of each figure]
//
// CHROMIUM names the browser; the default is `chromium`.
import { spawn } from "node:child_process";
import { writeFileSync } from "node:fs";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";

const [page, pictures] = process.argv.slice(2);
const browser = spawn(process.env.CHROMIUM ?? "chromium",
  ["--headless", "--no-sandbox", "--remote-debugging-pipe", "--window-size=1000,900", "about:blank"],
  { stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"] });
let last = 0;
let rest = "";
const waiting = new Map();
const faults = [];
browser.stdio[4].setEncoding("utf8");
browser.stdio[4].on("data", (data) => {
  const parts = (rest + data).split("\0");
  rest = parts.pop();
  for (const part of parts) {
    const { id, result, error, method, params } = JSON.parse(part);
    if (id) {
      const { yes, no } = waiting.get(id);
      waiting.delete(id);
      error ? no(new Error(error.message)) : yes(result);
    } else if (method === "Runtime.exceptionThrown") faults.push(`exception: ${params.exceptionDetails.exception?.description}`);
    else if (method === "Runtime.consoleAPICalled") faults.push(`console: ${params.args.map((a) => a.value ?? a.description).join(" ")}`);
    else if (method === "Log.entryAdded") faults.push(`log: ${params.entry.text}`);
  }
});
let session;
const send = (method, params = {}) => new Promise((yes, no) => {
  waiting.set(++last, { yes, no });
  browser.stdio[3].write(`${JSON.stringify({ id: last, method, params, sessionId: session })}\0`);
});
const run = async (expression) => {
  const { result, exceptionDetails } = await send("Runtime.evaluate", { expression, awaitPromise: true, returnByValue: true });
  if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
  return result.value;
};
const mouse = (type, x, y, buttons) => send("Input.dispatchMouseEvent", { type, x, y, button: "left", buttons, clickCount: 1 });
const key = async (name, code) => {
  for (const type of ["rawKeyDown", "keyUp"]) await send("Input.dispatchKeyEvent", { type, key: name, code: name, windowsVirtualKeyCode: code });
};
// What a figure says and shows: its words, and its canvases.
const state = (i) => run(`settled().then(() => { const f = document.querySelectorAll("[data-figure]")[${i}];
  return f.innerText + [...f.querySelectorAll("canvas")].map((c) => c.toDataURL()).join() + [...f.querySelectorAll("[aria-label]")].map((e) => e.ariaLabel).join(); })`);
const check = (figure, what, before, after) => {
  if (before === after) faults.push(`${figure}: ${what} changes nothing`);
};

try {
  const { targetInfos } = await send("Target.getTargets");
  const { sessionId } = await send("Target.attachToTarget", { targetId: targetInfos.find((t) => t.type === "page").targetId, flatten: true });
  session = sessionId;
  for (const domain of ["Page", "Runtime", "Log"]) await send(`${domain}.enable`);
  await send("Page.navigate", { url: pathToFileURL(resolve(page)).href });
  for (let i = 0; i < 100 && !(await run('document.readyState === "complete" && !!document.querySelector("[data-figure]")')); i++) await new Promise((r) => setTimeout(r, 50));
  await run("globalThis.settled = () => new Promise((r) => requestAnimationFrame(() => requestAnimationFrame(r))); 0");
  const names = await run('[...document.querySelectorAll("[data-figure]")].map((f) => f.dataset.figure)');
  const counts = { handles: 0, sliders: 0, buttons: 0, radios: 0 };
  for (const [i, name] of names.entries()) {
    const find = (selector, j) => `document.querySelectorAll("[data-figure]")[${i}].querySelectorAll('${selector}')[${j}]`;
    const count = (selector) => run(`document.querySelectorAll("[data-figure]")[${i}].querySelectorAll('${selector}').length`);
    await run(`document.querySelectorAll("[data-figure]")[${i}].scrollIntoView({ block: "start", behavior: "instant" }); settled().then(settled)`);
    const middle = (element) => run(`(() => { ${element}.scrollIntoView({ block: "center", behavior: "instant" });
      const b = ${element}.getBoundingClientRect(); return [b.x + b.width / 2, b.y + b.height / 2]; })()`);
    for (let j = 0; j < await count("input[type=radio]"); j++) {
      if (await run(`${find("input[type=radio]", j)}.checked`)) continue;
      const [x, y] = await middle(find("input[type=radio]", j));
      const before = await state(i);
      await mouse("mousePressed", x, y, 1);
      await mouse("mouseReleased", x, y, 0);
      check(name, `choice ${j}`, before, await state(i));
      counts.radios++;
    }
    for (let j = 0; j < await count(".fig-handle"); j++) {
      const [x, y] = await middle(find(".fig-handle", j));
      let before = await state(i);
      await mouse("mousePressed", x, y, 1);
      for (let k = 1; k <= 4; k++) await mouse("mouseMoved", x - 9 * k, y - 6 * k, 1);
      await mouse("mouseReleased", x - 36, y - 24, 0);
      let after = await state(i);
      check(name, `dragging handle ${j}`, before, after);
      for (const [arrow, code] of [["ArrowRight", 39], ["ArrowDown", 40]]) {
        before = await state(i);
        await run(`${find(".fig-handle", j)}.focus()`);
        await key(arrow, code);
        await key(arrow, code);
        after = await state(i);
        if (before !== after) break;
      }
      check(name, `handle ${j} by arrow keys`, before, after);
      counts.handles++;
    }
    for (let j = 0; j < await count("input[type=range]"); j++) {
      await run(`${find("input[type=range]", j)}.focus()`);
      const before = await state(i);
      for (let k = 0; k < 3; k++) await key("ArrowLeft", 37);
      let after = await state(i);
      if (before === after) {
        for (let k = 0; k < 3; k++) await key("ArrowRight", 39);
        after = await state(i);
      }
      check(name, `slider ${j} by arrow keys`, before, after);
      counts.sliders++;
    }
    const buttons = await count(".fig-button");
    let any = buttons === 0;
    for (let j = 0; j < buttons; j++) {
      const before = await state(i);
      await run(`${find(".fig-button", j)}.focus()`);
      await send("Input.dispatchKeyEvent", { type: "keyDown", key: "Enter", code: "Enter", windowsVirtualKeyCode: 13, text: "\r" });
      await send("Input.dispatchKeyEvent", { type: "keyUp", key: "Enter", code: "Enter", windowsVirtualKeyCode: 13 });
      any ||= before !== await state(i);
      counts.buttons++;
    }
    if (!any) faults.push(`${name}: no button changes anything`);
    const unnamed = await run(`[...document.querySelectorAll("[data-figure]")[${i}].querySelectorAll("canvas, .fig-handle")].filter((e) => !e.ariaLabel).length`);
    if (unnamed) faults.push(`${name}: ${unnamed} pictures or handles have no words`);
    if (pictures) {
      await run(`document.querySelectorAll("[data-figure]")[${i}].scrollIntoView({ block: "start", behavior: "instant" }); settled()`);
      const { data } = await send("Page.captureScreenshot", { format: "png" });
      writeFileSync(`${pictures}/${name}.png`, Buffer.from(data, "base64"));
    }
  }
  console.log(`${names.length} figures: ${Object.entries(counts).map(([k, n]) => `${n} ${k}`).join(", ")}`);
  if (names.length !== 12) faults.push(`${names.length} figures`);
} catch (error) {
  faults.push(String(error));
} finally {
  browser.kill();
}
for (const fault of faults) console.log(`FAULT  ${fault}`);
process.exit(faults.length ? 1 : 0);
