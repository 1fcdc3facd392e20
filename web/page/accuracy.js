// The slider: how wrong a pixel may be. Its figures, the error map, and the chart on which the point moves.

/** Rounds in which all are measured. */
const ROUNDS = 5;

/** Milliseconds over which frames are counted. */
const WINDOW = 500;

/** The value of the choice that leaves shadings to the slider. */
const SLIDER = "slider";

/** What is asked for, in a sentence's words. */
function wishText({ maxError, shading }) {
  if (maxError) return `at most ${shadesText(maxError)} of 255 shades`;
  if (shading === CHEAPEST) return "as cheap as it gets: one shade a face";
  return shading ? `every face ${fullName(shading)}` : "whatever the scene asks for";
}

class Accuracy {
  #frames = [];
  #points = new Map();
  #judged = null;
  #drawn = 0;

  /** `page` has state, engine, background, and question() for the worker. */
  constructor(page) {
    this.page = page;
    this.#offerStops();
    const shadings = element("shading");
    const methods = page.engine.shadings.map((name) => new Option(fullName(name), name));
    shadings.replaceChildren(new Option("as the slider says", SLIDER), new Option("as the scene asks", ""), ...methods);
    shadings.addEventListener("change", () => {
      if (shadings.value === SLIDER) page.choose(settingAt(Number(element("accuracy").value)));
      else page.choose({ maxError: null, shading: shadings.value });
    });
    element("measure").addEventListener("click", () => this.measureAll());
    element("within").addEventListener("submit", (event) => {
      event.preventDefault();
      this.within(Number(element("limit").value));
    });
    const levels = [...page.engine.levels, { label: "not taken", color: page.engine.notTaken }];
    element("levels").replaceChildren(...levels.map(({ label, color }) => keyItem(color, label)));
    this.map = new PalettedCanvas(element("errors"));
    new ResizeObserver(() => this.#draw()).observe(element("chart"));
  }

  #offerStops() {
    const slider = element("accuracy");
    slider.max = LAST_STOP;
    const marks = [["cheapest", 0], ...OCTAVES.map((budget) => [shadesText(budget), stopOf({ maxError: budget })])];
    element("octaves").replaceChildren(...marks.map(([label, stop]) => new Option(label, stop)));
    document.querySelector(".scale").replaceChildren(...marks.map(([label, stop]) => {
      const mark = make("span", {}, label);
      mark.style.setProperty("--stop", stop / LAST_STOP);
      return mark;
    }));
    const choose = () => this.page.choose(settingAt(Number(slider.value)));
    slider.addEventListener("input", choose);
    // A shading that is not on the slider leaves the thumb where it was: any key or touch takes the slider up again, even
    // at its ends, where there is no input.
    for (const touched of ["keydown", "pointerdown"]) {
      slider.addEventListener(touched, ({ key }) => key !== "Tab" && key !== "Shift" && stopOf(this.page.state) === null && choose());
    }
  }

  /** Shows what is set. The thumb stays where it is if that is no stop of the slider. */
  follow() {
    const { state } = this.page;
    const slider = element("accuracy");
    const stop = stopOf(state);
    if (stop !== null) slider.value = stop;
    slider.classList.toggle("aside", stop === null);
    const wish = wishText(state);
    element("wish").textContent = wish;
    slider.setAttribute("aria-valuetext", wish);
    element("shading").value = stop === null ? state.shading : SLIDER;
  }

  /** Takes in the time of a frame. */
  count(ms, now) {
    this.#frames.push({ ms, now });
    while (this.#frames[0].now < now - WINDOW) this.#frames.shift();
    if (now - this.#drawn < 200) return;
    this.#drawn = now;
    element("ms").textContent = timeText(this.mean());
    const [first, last] = [this.#frames[0].now, now];
    element("rate").textContent = this.#frames.length > 1 ? Math.round(((this.#frames.length - 1) * 1000) / (last - first)) : "–";
    this.#draw();
  }

  /** Takes in the time of a picture that stands. */
  stand(ms) {
    this.#frames = [{ ms, now: 0 }];
    element("ms").textContent = timeText(ms);
    element("rate").textContent = "–";
    this.#draw();
  }

  mean() {
    return this.#frames.reduce((sum, { ms }) => sum + ms, 0) / Math.max(this.#frames.length, 1);
  }

  /** Forgets the times of other settings. */
  restart() {
    this.#frames = [];
  }

  /** Forgets what was measured of another scene. */
  forget() {
    this.#points.clear();
    this.#judged = null;
    this.restart();
  }

  shares({ shares, shading }) {
    const all = shares.reduce((sum, [, faces]) => sum + faces, 0) || 1;
    const colored = (name) => {
      const part = make("i");
      part.style.background = techniqueColor(name);
      return part;
    };
    const words = shares.map(([name, faces]) => [name, `${plainName(name)} ${faces * 200 < all ? "under 1" : Math.round((100 * faces) / all)} %`]);
    keyed(element("shares"), shares, ([name]) => name, ([name]) => colored(name), (part, [, faces]) => (part.style.flex = faces));
    keyed(element("shares-key"), words, ([name]) => name, ([name]) => keyItem(techniqueColor(name), ""), (item, [, text]) => setText(item.lastElementChild, text));
    element("shares").setAttribute("aria-label", `Share of faces by technique: ${words.map(([, text]) => text).join(", ") || shading}`);
  }

  /** Asks the worker for the errors of the present frame, if it is idle. Returns what was asked. */
  async judge() {
    if (this.asking) return null;
    const asked = this.page.question();
    this.asking = true;
    const answer = await this.page.ask("judge", asked);
    this.asking = false;
    if (!answer || asked.toml !== this.page.state.toml) return asked;
    const { max, rms, frame, map } = answer;
    this.#judged = { max, rms };
    const { maxError } = asked.settings;
    const isOwn = settingLines(asked.settings) === settingLines(this.page.settings()) && Object.keys(asked.settings.effects).length === 0;
    // The curve of budgets grows as the slider is dragged.
    if (maxError && isOwn && (this.#frames.length > 3 || !this.page.state.playing) && !this.measuring) this.#take({ maxError }, this.mean(), rms);
    element("worst").textContent = max.toFixed(2);
    element("rms").textContent = rms.toFixed(2);
    const within = !asked.settings.maxError || max <= asked.settings.maxError + 0.5;
    element("worst").classList.toggle("beyond", !within);
    element("worst").title = within ? "" : "Beyond the budget and rounding: on faces seen edge on rounded vertices are off by themselves.";
    this.map.show(mapPicture(map, frame, this.page.engine));
    this.lastMap = { map, asked };
    const age = Math.abs(this.page.state.seconds - asked.seconds);
    element("errors-age").textContent = age < 0.02 || !this.page.state.playing ? "Error in shades" : `Error in shades, ${age.toFixed(1)} s ago`;
    this.#draw();
    return asked;
  }

  #draw() {
    const { state } = this.page;
    const isShown = this.#judged && this.#frames.length > 0;
    const present = settingLines({ maxError: state.maxError, shading: state.shading });
    // The present point stands for what was measured of its setting.
    const others = [...this.#points].filter(([lines]) => !isShown || lines !== present).map(([, point]) => point);
    const points = others.map((point) => ({ ...point, key: settingLines(point.settings), choose: () => this.page.choose(point.settings) }));
    if (isShown) {
      const name = state.maxError ? `≤ ${shadesText(state.maxError)}` : state.shading || "the scene’s";
      points.push({ ms: this.mean(), error: this.#judged.rms, kind: "now", name: `${name}, now` });
    }
    drawChart(element("chart"), markEfficient(points), { height: 250 });
  }

  /** Takes a measured point. Budgets between whole octaves have no name. */
  #take({ maxError, shading }, ms, error) {
    const isWhole = maxError && Number.isInteger(Math.log2(maxError));
    const name = !maxError ? shading : isWhole ? `≤ ${shadesText(maxError)}` : "";
    const settings = maxError ? { maxError } : { maxError: null, shading };
    const title = `${maxError ? `at most ${budgetText(maxError)}` : shading}: ${timeText(ms)}, off by ${error.toFixed(2)} shades r.m.s.`;
    this.#points.set(settingLines(settings), { kind: maxError ? "budget" : "shading", budget: maxError, name, title, settings, ms, error });
  }

  /** Measures every shading and the budgets at whole octaves, one after the other. */
  async measureAll() {
    const button = element("measure");
    const settings = [
      ...this.page.engine.shadings.map((shading) => ({ shading, maxError: null })),
      ...OCTAVES.map((maxError) => ({ maxError })),
    ];
    button.disabled = true;
    this.measuring = true;
    const { toml } = this.page.state;
    const question = this.page.question();
    const times = settings.map(() => []);
    const errors = [];
    // Round by round, so that what else the computer does meets all of them.
    for (let turn = 0; turn < ROUNDS * settings.length; turn++) {
      const at = turn % settings.length;
      button.textContent = `Measuring, ${Math.round((100 * turn) / (ROUNDS * settings.length))} %`;
      const asked = { ...question, settings: { ...question.settings, ...settings[at] }, judges: turn < settings.length };
      const answer = await this.page.ask("measure", asked);
      if (!answer || toml !== this.page.state.toml) break;
      times[at].push(answer.ms);
      errors[at] ??= answer.rms;
      this.#take(settings[at], median(times[at]), errors[at]);
      this.#draw();
    }
    this.measuring = false;
    button.disabled = false;
    button.textContent = "Measure all shadings again";
  }

  /** The smallest error whose frame takes no longer: the slider's stops, halved again and again. */
  within(limit) {
    if (!(limit > 0)) return;
    const { scene, state } = this.page;
    const takes = (stop) => {
      scene.set({ ...this.page.settings(), ...settingAt(stop) });
      return median([1, 2, 3].map(() => scene.time(state.seconds, state.pose, 8)));
    };
    let [fits, beyond] = [-1, LAST_STOP + 1];
    const times = new Map();
    while (beyond - fits > 1) {
      const middle = (fits + beyond) >> 1;
      times.set(middle, takes(middle));
      if (times.get(middle) <= limit) fits = middle;
      else beyond = middle;
    }
    const stop = Math.max(fits, 0);
    const took = timeText(times.get(stop));
    element("found").textContent = fits < 0 ? `Not here: the cheapest takes ${took}.` : `${settingName(settingAt(stop))}, in ${took}.`;
    this.page.choose(settingAt(stop));
  }
}

const median = (numbers) => [...numbers].sort((a, b) => a - b)[numbers.length >> 1];

/** An error map in the colours of its levels; pixels that show nothing are as the frame has them. */
function mapPicture(map, frame, { levels, notTaken }) {
  const colors = [...levels.map((level) => level.color), notTaken].map((color) => [1, 3, 5].map((at) => parseInt(color.slice(at, at + 2), 16)));
  const palette = new Uint8Array(768);
  colors.forEach((color, at) => palette.set(color, 3 * at));
  palette.set([22, 22, 26], 3 * 255);
  return { bytes: map, palette };
}
