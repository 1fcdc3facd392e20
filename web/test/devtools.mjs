// Chromium through its DevTools protocol: a pipe, JSON, and a zero byte behind each message.
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

/** Removes a browser's folder. Its last processes may still write there: then it stays in the system's temporary folder. */
export function removeProfile(profile) {
  try {
    rmSync(profile, { recursive: true, force: true, maxRetries: 10, retryDelay: 100 });
  } catch (error) {
    console.log(`${profile} stays: ${error.code}`);
  }
}

export class Browser {
  #number = 0;
  #asked = new Map();
  #heard = [];
  #rest = "";

  static async launch(program = process.env.CHROMIUM ?? "chromium") {
    const browser = new Browser();
    browser.profile = mkdtempSync(join(tmpdir(), "mode13h-web-"));
    const options = ["--headless=new", "--remote-debugging-pipe", "--no-sandbox", "--hide-scrollbars", "--no-first-run", "--disable-gpu", `--user-data-dir=${browser.profile}`, "about:blank"];
    browser.process = spawn(program, options, { stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"] });
    const [, , , to, from] = browser.process.stdio;
    browser.to = to;
    from.setEncoding("utf8").on("data", (text) => browser.#hear(text));
    await browser.ask("Browser.getVersion");
    return browser;
  }

  #hear(text) {
    const messages = (this.#rest + text).split("\0");
    this.#rest = messages.pop();
    for (const message of messages.map((text) => JSON.parse(text))) {
      const asked = this.#asked.get(message.id);
      if (!asked) {
        for (const listener of this.#heard) listener(message);
      } else {
        this.#asked.delete(message.id);
        if (message.error) asked.reject(new Error(`${asked.method}: ${message.error.message}`));
        else asked.resolve(message.result);
      }
    }
  }

  ask(method, params = {}, sessionId) {
    const id = ++this.#number;
    this.to.write(`${JSON.stringify({ id, method, params, sessionId })}\0`);
    return new Promise((resolve, reject) => this.#asked.set(id, { method, resolve, reject }));
  }

  listen(listener) {
    this.#heard.push(listener);
  }

  /** A new page. Everything that it says on the console, and every error, is kept in `said`. */
  async page() {
    const { targetId } = await this.ask("Target.createTarget", { url: "about:blank" });
    const { sessionId } = await this.ask("Target.attachToTarget", { targetId, flatten: true });
    const page = new Tab(this, sessionId);
    this.listen((message) => message.sessionId === sessionId && page.hear(message));
    for (const domain of ["Page", "Runtime", "Log", "DOM"]) await page.ask(`${domain}.enable`);
    return page;
  }

  async close() {
    await this.ask("Browser.close").catch(() => {});
    await new Promise((resolve) => (this.process.exitCode === null ? this.process.once("exit", resolve) : resolve()));
    removeProfile(this.profile);
  }
}

class Tab {
  said = [];
  #waiting = [];

  constructor(browser, session) {
    this.browser = browser;
    this.session = session;
  }

  hear({ method, params }) {
    if (method === "Runtime.consoleAPICalled") this.said.push(params.args.map((arg) => arg.value ?? arg.description).join(" "));
    if (method === "Runtime.exceptionThrown") this.said.push(params.exceptionDetails.exception?.description ?? params.exceptionDetails.text);
    if (method === "Log.entryAdded") this.said.push(params.entry.text);
    for (const waiting of this.#waiting.filter((waiting) => waiting.method === method)) waiting.resolve(params);
    this.#waiting = this.#waiting.filter((waiting) => waiting.method !== method);
  }

  ask(method, params) {
    return this.browser.ask(method, params, this.session);
  }

  /** Closes the page, so that it works no more. */
  close() {
    return this.ask("Page.close");
  }

  event(method) {
    return new Promise((resolve) => this.#waiting.push({ method, resolve }));
  }

  async open(address) {
    const loaded = this.event("Page.loadEventFired");
    await this.ask("Page.navigate", { url: address });
    await loaded;
  }

  /** The value of an expression in the page; promises are waited for. */
  async value(expression) {
    const { result, exceptionDetails } = await this.ask("Runtime.evaluate", { expression, awaitPromise: true, returnByValue: true });
    if (exceptionDetails) throw new Error(`${expression}: ${exceptionDetails.exception?.description ?? exceptionDetails.text}`);
    return result.value;
  }

  /** Waits until an expression is true. */
  async until(expression, seconds = 20) {
    for (let waited = 0; waited < seconds * 20; waited++) {
      if (await this.value(`Boolean(${expression})`)) return;
      await new Promise((resolve) => setTimeout(resolve, 50));
    }
    console.log(`      trouble: ${await this.value("document.getElementById('trouble')?.textContent")}; said: ${this.said.join("; ")}`);
    throw new Error(`after ${seconds} s still not: ${expression}`);
  }

  /** Puts the page before the others: one behind them draws nothing. */
  front() {
    return this.ask("Page.bringToFront");
  }

  async size(width, height, isDark = false, isStill = false) {
    await this.ask("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor: 1, mobile: width < 500 });
    const features = [
      { name: "prefers-color-scheme", value: isDark ? "dark" : "light" },
      { name: "prefers-reduced-motion", value: isStill ? "reduce" : "no-preference" },
    ];
    await this.ask("Emulation.setEmulatedMedia", { features });
  }

  /** Where an element is, from the window's upper left corner; it is scrolled to. */
  box(selector) {
    return this.value(`(() => { const e = document.querySelector(${JSON.stringify(selector)}); e.scrollIntoView({ block: "center", behavior: "instant" }); const b = e.getBoundingClientRect(); return { x: b.x, y: b.y, width: b.width, height: b.height }; })()`);
  }

  mouse(type, x, y) {
    return this.ask("Input.dispatchMouseEvent", { type, x, y, button: "left", buttons: type === "mouseReleased" ? 0 : 1, clickCount: 1 });
  }

  async click(selector, across = 0.5, down = 0.5) {
    const { x, y, width, height } = await this.box(selector);
    const at = [x + across * width, y + down * height];
    await this.mouse("mousePressed", ...at);
    await this.mouse("mouseReleased", ...at);
  }

  /** Drags from one part of an element to another, in six steps. */
  async drag(selector, from, to, within = selector) {
    const start = await this.box(selector);
    const area = await this.box(within);
    const a = [start.x + from[0] * start.width, start.y + from[1] * start.height];
    const b = [area.x + to[0] * area.width, area.y + to[1] * area.height];
    await this.mouse("mousePressed", ...a);
    for (let step = 1; step <= 6; step++) await this.mouse("mouseMoved", ...a.map((value, axis) => value + ((b[axis] - value) * step) / 6));
    await this.mouse("mouseReleased", ...b);
  }

  async key(key, code = key, text) {
    const names = { ArrowLeft: 37, ArrowUp: 38, ArrowRight: 39, ArrowDown: 40, Enter: 13, End: 35, Home: 36 };
    const common = { key, code, windowsVirtualKeyCode: names[key] ?? key.charCodeAt(0) };
    await this.ask("Input.dispatchKeyEvent", { type: text ? "keyDown" : "rawKeyDown", text, ...common });
    await this.ask("Input.dispatchKeyEvent", { type: "keyUp", ...common });
  }

  async screenshot(whole = false) {
    const { data } = await this.ask("Page.captureScreenshot", { format: "png", captureBeyondViewport: whole });
    return Buffer.from(data, "base64");
  }
}
