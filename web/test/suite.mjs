// Shared by the tests in a browser: Debian's Chromium, driven by Playwright, and checks that are counted.
import { existsSync } from "node:fs";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const program = process.env.CHROMIUM ?? ["/usr/bin/chromium", "/usr/bin/google-chrome"].find(existsSync);

/** A browser that shows a page from disk, each time in a new tab that shares nothing with the others. */
export class Suite {
  failures = 0;

  constructor(page) {
    this.address = pathToFileURL(resolve(page)).href;
  }

  check(what, holds, found = "") {
    if (!holds) this.failures++;
    console.log(`${holds ? "ok  " : "FAIL"}  ${what}${holds ? "" : `: ${found}`}`);
  }

  /** Runs the tests in a browser, and ends with 1 if any failed. */
  async run(tests) {
    this.browser = await chromium.launch({ executablePath: program, args: ["--no-sandbox", "--disable-gpu"] });
    try {
      await tests(this);
    } catch (error) {
      this.check("the tests run to their end", false, error.stack);
    } finally {
      await this.browser.close();
    }
    console.log(`${this.failures} failures`);
    process.exit(this.failures ? 1 : 0);
  }

  /** A tab whose console is recorded in `said`. Tests name elements as the page does, by `element(id)`. */
  async tab({ width = 1280, height = 800, isDark = false, isStill = false, javaScriptEnabled = true } = {}) {
    const context = await this.browser.newContext({
      viewport: { width, height }, isMobile: width < 500, hasTouch: width < 500, javaScriptEnabled,
      colorScheme: isDark ? "dark" : "light", reducedMotion: isStill ? "reduce" : "no-preference",
    });
    // A limit for tests that hang; a busy machine takes its time.
    context.setDefaultTimeout(180_000);
    await context.addInitScript("globalThis.element = (id) => document.getElementById(id)");
    const tab = await context.newPage();
    tab.said = [];
    tab.on("console", (message) => tab.said.push(message.text()));
    tab.on("pageerror", (error) => tab.said.push(error.stack));
    return tab;
  }

  /** A tab with the page, once its error figures are there. */
  async open({ link = "", ...window } = {}) {
    const tab = await this.tab(window);
    await tab.goto(this.address + link);
    await until(tab, "globalThis.page?.scenes && page.accuracy.lastMap !== undefined");
    return tab;
  }
}

/** Waits until an expression is true in a tab. */
export async function until(tab, expression) {
  try {
    await tab.waitForFunction(expression);
  } catch (error) {
    const trouble = await tab.evaluate("element('trouble')?.textContent");
    throw new Error(`never: ${expression}; trouble: ${trouble}; said: ${tab.said.join("; ")}`, { cause: error });
  }
}

/** Waits until a tab has drawn this many frames. */
export const frames = (tab, count = 2) =>
  tab.evaluate((count) => new Promise((done) => {
    const next = () => (count-- > 0 ? requestAnimationFrame(next) : done());
    next();
  }), count);

/** Waits until a tab no longer scrolls: its position is the same in ten frames. */
export const scrolled = (tab) =>
  tab.evaluate(() => new Promise((done) => {
    let [place, frames] = [NaN, 0];
    const next = () => {
      frames = scrollY === place ? frames + 1 : 0;
      place = scrollY;
      if (frames < 10) requestAnimationFrame(next);
      else done();
    };
    next();
  }));

/** The position of an element from the window's upper left corner, after scrolling it to the window's middle. */
export const box = (tab, selector) =>
  tab.locator(selector).first().evaluate((element) => {
    element.scrollIntoView({ block: "center", behavior: "instant" });
    const { x, y, width, height } = element.getBoundingClientRect();
    return { x, y, width, height };
  });

/** Clicks at a part of an element. */
export async function click(tab, selector, across = 0.5, down = 0.5) {
  const { x, y, width, height } = await box(tab, selector);
  await tab.mouse.click(x + across * width, y + down * height);
}

/** Drags from one part of an element to another, in six steps. */
export async function drag(tab, selector, from, to, within = selector) {
  const start = await box(tab, selector);
  const area = await box(tab, within);
  await tab.mouse.move(start.x + from[0] * start.width, start.y + from[1] * start.height);
  await tab.mouse.down();
  await tab.mouse.move(area.x + to[0] * area.width, area.y + to[1] * area.height, { steps: 6 });
  await tab.mouse.up();
}

/** Opens a shipped scene in a tab. */
export const openScene = (tab, name) => tab.evaluate(`page.open(page.engine.shipped.find(({ name }) => name === ${JSON.stringify(name)}).toml, ${JSON.stringify(name)})`);
