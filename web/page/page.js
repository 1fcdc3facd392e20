// @ts-check
// The page: what its views show, and the loop that draws it.

import "../text/figures/all.js";
import { divide } from "../../lab/src/cost/report/shared/divider.js";
import { mountFigures } from "../text/figures/00-shared.js";
import { Accuracy, mapPicture } from "./accuracy.js";
import { Background } from "./background.js";
import { clamp, messageOf } from "./common.js";
import { Curve } from "./curve.js";
import { element, isStill, showTrouble } from "./elements.js";
import { Engine, EngineStopped, FIRST_POSE, HEIGHT, settingLines, WIDTH } from "./engine.js";
import { linkOf, stateOf } from "./link.js";
import { Magnifier } from "./magnifier.js";
import { MiniPicture } from "./mini.js";
import { handle, PalettedCanvas } from "./picture.js";
import { PlanTable } from "./plan.js";
import { offerFiles } from "./save.js";
import { Scenes } from "./scenes.js";
import { FIRST_SCENE, FIRST_STATE, Store } from "./state.js";
import { budgetText, fullName, OCTAVES, settingOf } from "./stops.js";
import { Stopwatch } from "./stopwatch.js";
import { besideSetting, Versus } from "./versus.js";

/**
 * @import { Scene } from "./engine.js"
 * @import { Frame, Parts, Pixel, Question, Settings, State } from "./types.d.ts"
 */

/** Milliseconds for which the divider moves by itself. */
const SWEEP = 4500;

export class Page {
  #store = new Store({ ...FIRST_STATE, playing: !isStill() });
  /** @type {Scene} */
  scene;
  /**
   * The scene under the divider, if there is one.
   * @type {Scene | null}
   */
  other = null;
  /** The times of the picture, and of the one under the divider. */
  left = new Stopwatch();
  right = new Stopwatch();
  /** @type {Scenes | undefined} */
  scenes;
  /** Counts the changes of the files that scenes may name. */
  version = 0;
  /**
   * The last link written.
   * @type {string | undefined}
   */
  written;
  /**
   * The state of a link whose scene could not be opened, perhaps because of files that have yet to be dropped.
   * @type {NonNullable<Awaited<ReturnType<typeof stateOf>>> | null}
   */
  #waiting = null;
  /** @type {Map<string, Uint8Array>} */
  #files = new Map();
  #last = 0;
  #told = 0;
  #stops = 0;
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  #linkTimer;
  #turn = 0;
  /**
   * Error messages, by cause.
   * @type {Map<string, string>}
   */
  #troubles = new Map();
  /** @type {{ key: string, frame: Frame } | null} */
  #exact = null;
  #isAskingExact = false;
  #isStale = true;
  /**
   * When the divider began to move by itself; null once it has moved, or if nothing should move.
   * @type {number | null}
   */
  #swept = isStill() ? null : 0;
  /** True while the error map covers the picture. */
  #showsErrors = false;
  /** Whether the last picture could be drawn; only then is it timed. */
  #isDrawn = false;

  /**
   * @param {Engine} engine
   * @param {Background} background
   */
  constructor(engine, background) {
    this.engine = engine;
    this.background = background;
    const first = engine.shipped.find(({ name }) => name === FIRST_SCENE) ?? engine.shipped[0];
    this.scene = engine.open(first.toml);
    this.canvas = new PalettedCanvas(element("picture"));
    this.overlay = /** @type {CanvasRenderingContext2D} */ (element("overlay").getContext("2d"));
    Object.assign(element("overlay"), { width: WIDTH, height: HEIGHT });
    this.accuracy = new Accuracy(this);
    this.curve = new Curve(this);
    this.versus = new Versus(this);
    this.plan = new PlanTable(this);
    this.magnifier = new Magnifier(this);
    this.mini = new MiniPicture();
    this.moveDivider = divide(element("screen"), "How much of the picture is the left one", (divider) => this.choose({ divider }));
    this.#handle();
    this.#store.listen((state, before) => this.#follow(state, before));
    offerFiles(this);
    this.open(first.toml, first.name);
  }

  get state() {
    return this.#store.state;
  }

  /**
   * Changes the state, which shows it.
   * @param {Partial<State>} change
   */
  choose(change) {
    this.#store.choose(change);
  }

  #handle() {
    /** @param {Partial<import("./types.d.ts").Pose>} change */
    const pose = (change) => this.choose({ pose: { ...this.state.pose, ...change } });
    const play = () => this.choose({ playing: !this.state.playing });
    handle(this.canvas, {
      turn: (turn, tilt) => pose({ turn: this.state.pose.turn + turn, tilt: this.state.pose.tilt + tilt }),
      zoom: (factor) => pose({ zoom: clamp(this.state.pose.zoom * factor, 0.05, 20) }),
      choose: (pixel) => this.#choosePixel(pixel ?? this.magnifier.at),
      move: (dx, dy) => this.movePixel(dx, dy),
      play,
    });
    element("play").addEventListener("click", play);
    const time = element("time");
    time.addEventListener("input", () => this.choose({ seconds: Number(time.value), playing: false }));
    const beside = element("beside");
    const budgets = OCTAVES.map((budget) => [`max-error ${budget}`, `at most ${budgetText(budget)}`]);
    const shadings = this.engine.shadings.map((name) => [`shading ${name}`, fullName(name)]);
    beside.append(new Option("exact (64-bit)", "truth"), ...[...budgets, ...shadings].map(([value, text]) => new Option(text, value)));
    beside.addEventListener("change", () => this.choose({ beside: beside.value }));
    for (const touched of ["pointerdown", "keydown"]) element("screen").addEventListener(touched, () => (this.#swept = null), { capture: true });
    this.#offerErrors();
    element("trouble-close").addEventListener("click", () => this.#forgetTroubles());
    element("first-pose").addEventListener("click", () => this.choose({ pose: FIRST_POSE }));
    this.#offerTheme();
  }

  /** Light or dark: the system's setting until the user chooses one, which is stored. */
  #offerTheme() {
    const root = document.documentElement;
    const button = element("theme");
    const isDark = () => (root.dataset.theme || (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light")) === "dark";
    const tell = () => button.setAttribute("aria-pressed", `${isDark()}`);
    button.addEventListener("click", () => {
      const theme = isDark() ? "light" : "dark";
      root.dataset.theme = theme;
      tell();
      this.redraw();
      try {
        localStorage.setItem("theme", theme);
      } catch {
        // A page opened from disk may have no storage: then the choice lasts as long as the page.
      }
    });
    tell();
  }

  /** Lays the error map over the picture while a button is held. */
  #offerErrors() {
    const button = element("show-errors");
    /** @param {boolean} isHeld */
    const show = (isHeld) => {
      this.#showsErrors = isHeld;
      button.classList.toggle("held", isHeld);
      this.redraw();
    };
    button.addEventListener("pointerdown", (event) => {
      button.setPointerCapture(event.pointerId);
      show(true);
    });
    for (const end of ["pointerup", "pointercancel", "blur"]) button.addEventListener(end, () => show(false));
    /** @param {KeyboardEvent} event */
    const isKey = ({ key }) => key === " " || key === "Enter";
    button.addEventListener("keydown", (event) => isKey(event) && show(true));
    button.addEventListener("keyup", (event) => isKey(event) && show(false));
    button.addEventListener("contextmenu", (event) => event.preventDefault());
  }

  /**
   * How the picture on the left is drawn.
   * @returns {Settings}
   */
  settings() {
    return { ...settingOf(this.state), effects: this.state.effects };
  }

  /** The data of the present frame that the worker needs. */
  question() {
    const { toml, seconds, pose } = this.state;
    return { toml, version: this.version, seconds, pose, settings: this.settings() };
  }

  /**
   * Asks the worker; an error is shown, unless another scene has been opened since.
   * @param {string} kind
   * @param {Question} question
   * @param {(part: number) => void} [onProgress]
   */
  async ask(kind, question, onProgress) {
    try {
      const answer = await this.background.ask(kind, question, onProgress);
      this.trouble(kind);
      return answer;
    } catch (error) {
      if (question.toml === this.state.toml) this.trouble(kind, messageOf(error));
      return null;
    }
  }

  /** @param {Map<string, Uint8Array>} files */
  setFiles(files) {
    this.#files = files;
    this.version++;
    this.engine.setFiles(files);
    this.background.setFiles(files);
  }

  /** Dropped files that the scene or a file of its names; links do not contain them. */
  namedFiles() {
    const texts = [this.state.toml];
    const left = new Set(this.#files.keys());
    for (const text of texts) {
      for (const name of left) {
        if (!text.includes(name)) continue;
        left.delete(name);
        if (/\.(obj|mtl)$/i.test(name)) texts.push(new TextDecoder().decode(this.#files.get(name)));
      }
    }
    return [...this.#files.keys()].filter((name) => !left.has(name));
  }

  /**
   * Opens a scene; after an error the present one stays.
   * @param {string} toml
   * @param {string} name
   * @param {boolean} keepsMoment
   */
  open(toml, name, keepsMoment = false) {
    const scene = this.engine.open(toml);
    this.#waiting = null;
    this.scene.free();
    this.other?.free();
    this.scene = scene;
    this.other = null;
    // Starts at the moment that shows what the scene is about.
    const start = { seconds: scene.about.picture, pose: FIRST_POSE, pixel: null, effects: {} };
    this.accuracy.forget();
    this.plan.forget();
    this.#forgetTroubles();
    this.left.reset();
    this.right.reset();
    element("time").max = `${scene.about.duration}`;
    this.choose({ toml, name, ...(keepsMoment ? {} : start) });
    this.curve.forget();
    this.scenes?.follow();
  }

  /**
   * Shows the state after a change.
   * @param {State} state
   * @param {State} before
   */
  #follow(state, before) {
    /** @param {State} of */
    const lines = (of) => [settingOf(of), besideSetting(of.beside)].map((setting) => settingLines({ ...setting, effects: of.effects }));
    const [now, then] = [lines(state), lines(before)];
    for (const [side, watch] of [this.left, this.right].entries()) {
      if (now[side] !== then[side]) watch.reset();
      if (state.seconds !== before.seconds || state.pose !== before.pose) watch.renew();
    }
    this.accuracy.follow();
    const play = element("play");
    play.textContent = state.playing ? "❚❚" : "▶";
    play.setAttribute("aria-label", state.playing ? "Pause" : "Play");
    const { turn, tilt, zoom } = state.pose;
    element("first-pose").hidden = turn === FIRST_POSE.turn && tilt === FIRST_POSE.tilt && zoom === FIRST_POSE.zoom;
    element("beside").value = state.beside;
    element("screen").classList.toggle("divided", Boolean(state.beside));
    // Shown at once; figures that are shown with the times wait for them.
    this.versus.compare();
    this.moveDivider(state.divider);
    this.#isStale = true;
    clearTimeout(this.#linkTimer);
    // A link that waits for its files stays in the address bar.
    this.#linkTimer = setTimeout(() => this.#waiting ?? this.link(), 400);
  }

  /**
   * Stops at a pixel, and shows its explanation beside the picture.
   * @param {Pixel} pixel
   */
  #choosePixel(pixel) {
    this.choose({ pixel, playing: false });
    // Beside the picture, scroll only as far as needed, to keep the picture in view; below it, scroll to the start.
    const block = matchMedia("(min-width: 60rem)").matches ? "nearest" : "start";
    element("pixel").scrollIntoView({ behavior: isStill() ? "auto" : "smooth", block });
  }

  /** Requests that the picture be drawn again. */
  redraw() {
    this.#isStale = true;
  }

  /**
   * @param {number} dx
   * @param {number} dy
   */
  movePixel(dx, dy) {
    const { x, y } = this.magnifier.at;
    this.choose({ pixel: { x: clamp(x + dx, 0, WIDTH - 1), y: clamp(y + dy, 0, HEIGHT - 1) }, playing: false });
  }

  /** Writes the link into the address bar. */
  async link() {
    const link = await linkOf(this.state, this.engine.shipped);
    this.written = link;
    try {
      history.replaceState(null, "", link);
    } catch {
      location.hash = link;
    }
  }

  /**
   * Applies the state of a link.
   * @param {string} hash
   */
  async follow(hash) {
    if (hash === this.written) return;
    this.#waiting = null;
    this.#waiting = await stateOf(hash, this.engine);
    this.#openLinked();
  }

  #openLinked() {
    if (!this.#waiting) return;
    const { toml, name, ...rest } = this.#waiting;
    this.open(toml, name);
    this.#swept = null;
    this.choose({ ...rest, playing: false });
  }

  /**
   * Opens the link that waits for files, if any, now that these are there. Returns whether it is open.
   * @param {(toml: string) => boolean} isNamed  whether a scene's text names one of the new files
   */
  retry(isNamed) {
    const waiting = this.#waiting;
    if (!waiting) return false;
    try {
      this.#openLinked();
    } catch (error) {
      if (isNamed(waiting.toml)) throw error;
    }
    return !this.#waiting;
  }

  /**
   * Sets the error message of one cause, or removes it if there is none. The last one is shown.
   * @param {string} cause
   * @param {string} message
   */
  trouble(cause, message = "") {
    this.#troubles.delete(cause);
    if (message) this.#troubles.set(cause, message);
    showTrouble([...this.#troubles.values()].at(-1) ?? "");
  }

  #forgetTroubles() {
    this.#troubles.clear();
    showTrouble("");
  }

  /** Draws the picture on the left, at the present moment. */
  drawLeft() {
    this.scene.set(this.settings());
    this.scene.show(this.state.seconds, this.state.pose);
    this.scene.draw();
  }

  /**
   * Draws a frame of the page.
   * @param {number} now
   */
  frame(now) {
    const { state } = this;
    const step = Math.min(now - this.#last, 100) / 1000;
    this.#last = now;
    try {
      this.#sweep(now);
      const { isSeen } = this.mini;
      if (state.playing && isSeen) this.#store.pass((state.seconds + step) % this.scene.about.duration);
      // Out of view only changes are drawn, not motion.
      if ((state.playing && isSeen) || this.#isStale) this.#show(now);
      if (this.#isDrawn && isSeen) this.#time();
      this.accuracy.tell(now);
      this.#stops = 0;
      if (this.#isDrawn && this.#troubles.has("picture")) this.trouble("picture");
    } catch (error) {
      this.#isDrawn = false;
      // A single trap may be chance; a scene that traps the engine again is given up.
      if (error instanceof EngineStopped && ++this.#stops > 2) this.open(this.engine.shipped[0].toml, this.engine.shipped[0].name);
      this.trouble(error instanceof EngineStopped ? "engine" : "picture", messageOf(error));
      // Once: each change writes the link anew.
      if (!(error instanceof EngineStopped) && state.playing) this.choose({ playing: false });
    }
    requestAnimationFrame((next) => this.frame(next));
  }

  /**
   * Moves the divider back and forth once, so that nobody misses it.
   * @param {number} now
   */
  #sweep(now) {
    if (this.#swept === null) return;
    this.#swept ||= now;
    const part = (now - this.#swept) / SWEEP;
    if (part >= 1) this.#swept = null;
    this.choose({ divider: 0.5 - 0.34 * Math.sin(2 * Math.PI * Math.min(part, 1)) });
  }

  /** @param {number} now */
  #show(now) {
    const { state } = this;
    const wasStale = this.#isStale;
    this.#isStale = false;
    this.drawLeft();
    const frame = this.scene.frame();
    const counts = this.scene.counts();
    const edge = state.beside ? Math.round(state.divider * WIDTH) : WIDTH;
    this.canvas.show(frame, 0, edge);
    if (state.beside) this.#showBeside(edge);
    if (this.#showsErrors && this.accuracy.lastMap) this.canvas.show(mapPicture(this.accuracy.lastMap.map, this.engine));
    this.#mark();
    element("time").value = `${state.seconds}`;
    element("seconds").textContent = `${state.seconds.toFixed(2)} s`;
    if (wasStale || now - this.#told > 250) {
      this.#told = now;
      if (counts.redrawn) this.accuracy.counts(counts);
      this.plan.show(this.scene.plan());
      this.magnifier.follow(this.scene, frame);
    }
    this.#isDrawn = true;
    this.#judge();
  }

  /** Takes laps of the pictures: of one per frame while they move; of still ones until they are settled. */
  #time() {
    const { seconds, pose, playing } = this.state;
    const sides = [{ watch: this.left, scene: this.scene }];
    if (this.other && this.#isBesideDrawn()) sides.push({ watch: this.right, scene: this.other });
    this.#turn = (this.#turn + 1) % sides.length;
    for (const { watch, scene } of playing ? [sides[this.#turn]] : sides) {
      if (playing || !watch.isSettled) watch.add(Stopwatch.lap(scene, seconds, pose));
    }
  }

  /** Whether the engine draws the other side of the divider. */
  #isBesideDrawn() {
    return this.state.beside && this.state.beside !== "truth";
  }

  /** Has the frame compared with the truth. For a still picture the final figures are its own. */
  async #judge() {
    const asked = await this.accuracy.judge();
    if (asked && JSON.stringify(asked) !== JSON.stringify(this.question()) && !this.state.playing) this.#isStale = true;
  }

  /** @param {number} edge */
  #showBeside(edge) {
    const { state } = this;
    if (state.beside === "truth") {
      const key = JSON.stringify([state.toml, this.version, state.seconds, state.pose]);
      if (this.#exact) this.canvas.show(this.#exact.frame, edge);
      if (this.#exact?.key !== key) this.#askExact(key);
      return;
    }
    this.other ??= this.engine.open(state.toml);
    this.other.set({ ...besideSetting(state.beside), effects: state.effects });
    this.other.show(state.seconds, state.pose);
    this.other.draw();
    this.canvas.show(this.other.frame(), edge);
  }

  /** @param {string} key */
  async #askExact(key) {
    if (this.#isAskingExact) return;
    this.#isAskingExact = true;
    const frame = await this.ask("exact", this.question());
    this.#isAskingExact = false;
    if (!frame) return;
    this.#exact = { key, frame };
    this.#isStale = true;
  }

  /** Marks the chosen pixel. */
  #mark() {
    this.overlay.clearRect(0, 0, WIDTH, HEIGHT);
    if (!this.state.pixel) return;
    const { x, y } = this.state.pixel;
    this.overlay.strokeStyle = "#ff3060";
    this.overlay.strokeRect(x - 1.5, y - 1.5, 4, 4);
  }
}

/**
 * Starts the page from its packed parts.
 * @param {Parts} parts
 */
export async function begin({ wasm, worker }) {
  if (!WebAssembly.validate(wasm)) throw new Error("this browser does not support 128-bit vectors in WebAssembly");
  const engine = new Engine(await WebAssembly.compile(wasm));
  const page = new Page(engine, new Background(worker, wasm));
  globalThis.page = page;
  const follow = () => page.follow(location.hash).catch((error) => page.trouble("link", messageOf(error)));
  await follow();
  addEventListener("hashchange", follow);
  requestAnimationFrame((now) => page.frame(now));
  page.scenes = new Scenes(page);
  page.scenes.follow();
  for (const part of /** @type {NodeListOf<HTMLElement>} */ (document.querySelectorAll("[data-needs-text]"))) part.hidden = !element("text").firstElementChild;
  mountFigures(engine);
  // A place in the text, which was not there when the page was opened.
  if (!location.hash.includes("=")) document.getElementById(location.hash.slice(1))?.scrollIntoView();
}
