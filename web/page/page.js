// The page: its state, and the loop that draws it.

/** The scene of the first screen: one in which it is seen what accuracy is for. */
const FIRST_SCENE = "phong";

/** Milliseconds in which the divider moves by itself. */
const SWEEP = 4500;

class Page {
  state = {
    name: "", toml: "", seconds: 0, playing: !isStill(), pose: { ...FIRST_POSE }, ...settingAt(0), effects: {},
    beside: "max-error 0.5", divider: 0.5, pixel: null,
  };
  /** The scene under the divider, if there is one. */
  other = null;
  /** The times of the picture, and of the one under the divider. */
  left = new Stopwatch();
  right = new Stopwatch();
  #files = new Map();
  #last = 0;
  #told = 0;
  #stops = 0;
  #linkTimer = 0;
  #turn = 0;
  /** What is wrong, by its cause. */
  #troubles = new Map();
  #exact = null;
  #isStale = true;
  /** When the divider began to move by itself; null once it has, or where nothing should move. */
  #swept = isStill() ? null : 0;
  /** While the error map covers the picture. */
  #showsErrors = false;
  /** Whether the last picture could be drawn: only then is it timed. */
  #isDrawn = false;

  constructor(engine, background) {
    this.engine = engine;
    this.background = background;
    this.canvas = new PalettedCanvas(element("picture"));
    this.overlay = element("overlay").getContext("2d");
    Object.assign(element("overlay"), { width: WIDTH, height: HEIGHT });
    this.accuracy = new Accuracy(this);
    this.curve = new Curve(this);
    this.versus = new Versus(this);
    this.plan = new PlanTable(this);
    this.magnifier = new Magnifier(this);
    this.mini = new MiniPicture();
    this.#handle();
    offerFiles(this);
  }

  #handle() {
    const { state } = this;
    handle(this.canvas, {
      turn: (turn, tilt) => this.choose({ pose: { ...state.pose, turn: state.pose.turn + turn, tilt: state.pose.tilt + tilt } }),
      zoom: (factor) => this.choose({ pose: { ...state.pose, zoom: clamp(state.pose.zoom * factor, 0.05, 20) } }),
      choose: (pixel) => this.#choosePixel(pixel ?? this.magnifier.at),
      move: (dx, dy) => this.movePixel(dx, dy),
      play: () => this.choose({ playing: !state.playing }),
    });
    element("play").addEventListener("click", () => this.choose({ playing: !state.playing }));
    element("time").addEventListener("input", ({ target }) => this.choose({ seconds: Number(target.value), playing: false }));
    const beside = element("beside");
    const budgets = OCTAVES.map((budget) => [`max-error ${budget}`, `at most ${budgetText(budget)}`]);
    const shadings = this.engine.shadings.map((name) => [`shading ${name}`, fullName(name)]);
    beside.append(new Option("exact (64-bit)", "truth"), ...[...budgets, ...shadings].map(([value, text]) => new Option(text, value)));
    beside.addEventListener("change", () => this.choose({ beside: beside.value }));
    this.moveDivider = divide(element("screen"), "How much of the picture is the left one", (place) => {
      this.state.divider = place;
      this.#isStale = true;
    });
    for (const touched of ["pointerdown", "keydown"]) element("screen").addEventListener(touched, () => (this.#swept = null), { capture: true });
    this.#offerErrors();
    element("trouble-close").addEventListener("click", () => this.#forgetTroubles());
    element("first-pose").addEventListener("click", () => this.choose({ pose: { ...FIRST_POSE } }));
    this.#offerTheme();
  }

  /** Light or dark, as the system has it until one is chosen; that is kept. */
  #offerTheme() {
    const root = document.documentElement;
    const button = element("theme");
    const isDark = () => (root.dataset.theme || (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light")) === "dark";
    const tell = () => button.setAttribute("aria-pressed", isDark());
    button.addEventListener("click", () => {
      root.dataset.theme = isDark() ? "light" : "dark";
      tell();
      this.redraw();
      try {
        localStorage.setItem("theme", root.dataset.theme);
      } catch {
        // A page from a disk may have no storage: then the choice lasts as long as the page.
      }
    });
    tell();
  }

  /** Lays the error map over the picture while a button is held. */
  #offerErrors() {
    const button = element("show-errors");
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
    const isKey = ({ key }) => key === " " || key === "Enter";
    button.addEventListener("keydown", (event) => isKey(event) && show(true));
    button.addEventListener("keyup", (event) => isKey(event) && show(false));
    button.addEventListener("contextmenu", (event) => event.preventDefault());
  }

  /** How the picture on the left is drawn. */
  settings() {
    const { maxError, shading, effects } = this.state;
    return { maxError, shading, effects };
  }

  #besideSettings() {
    return { ...besideSetting(this.state.beside), effects: this.state.effects };
  }

  /** What the worker has to know of the present frame. */
  question() {
    const { toml, seconds, pose } = this.state;
    return { toml, version: this.version, seconds, pose: { ...pose }, settings: this.settings() };
  }

  /** Asks the worker; what goes wrong is said, unless another scene has been opened since. */
  async ask(kind, question, onProgress) {
    try {
      const answer = await this.background.ask(kind, question, onProgress);
      this.trouble(kind);
      return answer;
    } catch (error) {
      if (question.toml === this.state.toml) this.trouble(kind, error.message);
      return null;
    }
  }

  version = 0;

  setFiles(files) {
    this.#files = files;
    this.version++;
    this.engine.setFiles(files);
    this.background.setFiles(files);
  }

  /** Files that were dropped and that the scene names: no link carries them. */
  namedFiles() {
    return [...this.#files.keys()].filter((name) => this.state.toml.includes(name));
  }

  /** Opens a scene; an error leaves the one that is shown. */
  open(toml, name, keepsMoment = false) {
    const scene = this.engine.open(toml);
    this.scene?.free();
    this.other?.free();
    this.scene = scene;
    this.other = null;
    Object.assign(this.state, { toml, name });
    if (!keepsMoment) Object.assign(this.state, { seconds: isStill() ? scene.about.picture : 0, pose: { ...FIRST_POSE }, pixel: null, effects: {} });
    this.accuracy.forget();
    this.plan.forget();
    this.curve.forget();
    this.#forgetTroubles();
    this.left.reset();
    this.right.reset();
    element("time").max = scene.about.duration;
    this.scenes?.follow();
    this.choose({});
  }

  /** Changes the state, and shows that. */
  choose(change) {
    const { state } = this;
    const settings = () => [this.settings(), this.#besideSettings()].map(settingLines);
    const before = settings();
    Object.assign(state, change);
    settings().forEach((lines, side) => lines !== before[side] && [this.left, this.right][side].reset());
    if ("seconds" in change || "pose" in change) for (const watch of [this.left, this.right]) watch.renew();
    this.accuracy.follow();
    const play = element("play");
    play.textContent = state.playing ? "❚❚" : "▶";
    play.setAttribute("aria-label", state.playing ? "Pause" : "Play");
    element("first-pose").hidden = Object.keys(FIRST_POSE).every((axis) => state.pose[axis] === FIRST_POSE[axis]);
    element("beside").value = state.beside;
    element("screen").classList.toggle("divided", Boolean(state.beside));
    // At once: what is told with the times waits for them.
    this.versus.compare();
    if ("divider" in change) this.moveDivider(state.divider);
    this.#isStale = true;
    clearTimeout(this.#linkTimer);
    this.#linkTimer = setTimeout(() => this.link(), 400);
  }

  /** Stops at a pixel, and shows its account beside the picture. */
  #choosePixel(pixel) {
    this.choose({ pixel, playing: false });
    // Beside the picture no farther than it must be, so that the picture stays whole; under it from its beginning.
    const block = matchMedia("(min-width: 60rem)").matches ? "nearest" : "start";
    element("pixel").scrollIntoView({ behavior: isStill() ? "auto" : "smooth", block });
  }

  /** Has the picture drawn again. */
  redraw() {
    this.#isStale = true;
  }

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

  /** Takes on the state of a link. */
  async follow(hash) {
    if (hash === this.written) return;
    const linked = await stateOf(hash, this.engine.shipped);
    if (!linked) return;
    const { toml, name, ...rest } = linked;
    this.open(toml, name);
    this.#swept = null;
    this.choose({ ...rest, playing: false });
  }

  /** Says what is wrong, of one cause; without a message that cause is gone. The last one is shown. */
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

  /** Draws a frame of the page. */
  frame(now) {
    const { state } = this;
    const step = Math.min(now - this.#last, 100) / 1000;
    this.#last = now;
    try {
      this.#sweep(now);
      const { isSeen } = this.mini;
      if (state.playing && isSeen) state.seconds = (state.seconds + step) % this.scene.about.duration;
      // Nobody looks at what is out of the window; a change is drawn there as well.
      if ((state.playing && isSeen) || this.#isStale) this.#show(now);
      if (this.#isDrawn && isSeen) this.#time();
      this.accuracy.tell(now);
      this.#stops = 0;
    } catch (error) {
      this.#isDrawn = false;
      // One stop may be chance; a scene that stops the engine again is left.
      if (error instanceof EngineStopped && ++this.#stops > 2) this.open(this.engine.shipped[0].toml, this.engine.shipped[0].name);
      this.trouble("picture", error.message);
      if (!(error instanceof EngineStopped)) state.playing = false;
    }
    requestAnimationFrame((next) => this.frame(next));
  }

  /** Moves the divider to and fro once, so that nobody misses it. */
  #sweep(now) {
    if (this.#swept === null) return;
    this.#swept ||= now;
    const part = (now - this.#swept) / SWEEP;
    if (part >= 1) this.#swept = null;
    this.moveDivider(0.5 - 0.34 * Math.sin(2 * Math.PI * Math.min(part, 1)));
  }

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
    element("time").value = state.seconds;
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

  /** Takes laps of what is shown: of one picture in each frame while they move, and until they are settled where they stand. */
  #time() {
    const { seconds, pose, playing } = this.state;
    const sides = [[this.left, this.scene]];
    if (this.#isBesideDrawn()) sides.push([this.right, this.other]);
    this.#turn = (this.#turn + 1) % sides.length;
    for (const [watch, scene] of playing ? [sides[this.#turn]] : sides) {
      if (playing || !watch.isSettled) watch.add(Stopwatch.lap(scene, seconds, pose));
    }
  }

  /** Whether the engine draws what is beside the picture. */
  #isBesideDrawn() {
    return this.other && this.state.beside && this.state.beside !== "truth";
  }

  /** Has the frame compared with the truth. Of a picture that stands the last word is its own. */
  async #judge() {
    const asked = await this.accuracy.judge();
    if (asked && JSON.stringify(asked) !== JSON.stringify(this.question()) && !this.state.playing) this.#isStale = true;
  }

  #showBeside(edge) {
    const { state } = this;
    if (state.beside === "truth") {
      const key = JSON.stringify([state.toml, state.seconds, state.pose]);
      if (this.#exact) this.canvas.show(this.#exact.frame, edge);
      if (this.#exact?.key !== key) this.#askExact(key);
      return;
    }
    this.other ??= this.engine.open(state.toml);
    this.other.set(this.#besideSettings());
    this.other.show(state.seconds, state.pose);
    this.other.draw();
    this.canvas.show(this.other.frame(), edge);
  }

  async #askExact(key) {
    if (this.askingExact) return;
    this.askingExact = true;
    const frame = await this.ask("exact", this.question());
    this.askingExact = false;
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

async function begin() {
  const { wasm, engine: engineScript, worker } = PARTS;
  if (!WebAssembly.validate(wasm)) throw new Error("this browser has no WebAssembly with vectors of 128 bits");
  const engine = new Engine(await WebAssembly.compile(wasm));
  const page = new Page(engine, new Background([engineScript, "\n", worker], wasm));
  globalThis.page = page;
  const first = engine.shipped.find(({ name }) => name === FIRST_SCENE) ?? engine.shipped[0];
  page.open(first.toml, first.name);
  const follow = () => page.follow(location.hash).catch((error) => page.trouble("link", error.message));
  await follow();
  addEventListener("hashchange", follow);
  requestAnimationFrame((now) => page.frame(now));
  page.scenes = new Scenes(page);
  page.scenes.follow();
  for (const part of document.querySelectorAll("[data-needs-text]")) part.hidden = !element("text").firstElementChild;
  globalThis.mountFigures?.(engine);
}

begin().catch((error) => showTrouble(`The engine could not be started: ${error.message}`));
