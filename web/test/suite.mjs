// What the tests in a browser share: checks that are counted, and the page in a tab.
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { Browser } from "./devtools.mjs";

export const wait = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

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
    this.browser = await Browser.launch();
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

  /** A tab with the page, once its errors are there. */
  async open({ width = 1280, height = 800, isDark = false, isStill = false, link = "" } = {}) {
    const tab = await this.browser.page();
    await tab.front();
    await tab.size(width, height, isDark, isStill);
    await tab.open(this.address + link);
    await tab.until("globalThis.page?.scenes && page.accuracy.lastMap !== undefined");
    return tab;
  }
}

/** Opens a shipped scene in a tab. */
export const openScene = (tab, name) => tab.value(`page.open(page.engine.shipped.find(({ name }) => name === ${JSON.stringify(name)}).toml, ${JSON.stringify(name)})`);
