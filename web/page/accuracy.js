// The slider: how wrong a pixel may be. Its figures, the error map, and the chart on which the point moves.

/** Budgets from the slider's left to its right: off, a gap, then 16 shades to ½ in quarters of an octave. */
const STOPS = 24;
const FIRST_STOP = 3;
const budgetAt = (stop) => (stop <= FIRST_STOP - 2 ? null : Number((16 * 2 ** (-(Math.max(stop, FIRST_STOP) - FIRST_STOP) / 4)).toPrecision(3)));
const stopOf = (budget) => (budget ? clamp(Math.round(FIRST_STOP - 4 * Math.log2(budget / 16)), FIRST_STOP, STOPS - 1) : 0);
const shadesText = (shades) => (shades === 0.5 ? "½" : `${Number(shades.toPrecision(2))}`);
const budgetText = (budget) => `${shadesText(budget)} ${budget <= 1 ? "shade" : "shades"}`;

/** Colours of the techniques, from cheap to exact. */
const TECHNIQUES = ["flat", "gouraud-vintage", "gouraud-8.8", "gouraud-8.8-reseeded", "gouraud-16.16", "gouraud-hyperbolic", "gouraud-tessellated", "phong-table", "float", "phong-quadratic", "phong-every-16", "phong-every-8", "phong-every-4", "phong"];
const techniqueColor = (name) => `hsl(${205 - 190 * (TECHNIQUES.indexOf(name) / (TECHNIQUES.length - 1))} 62% ${TECHNIQUES.indexOf(name) % 2 ? 46 : 56}%)`;

/** Rounds in which all are measured. */
const ROUNDS = 5;

/** Milliseconds over which frames are counted. */
const WINDOW = 500;

class Accuracy {
  #frames = [];
  #points = new Map();
  #judged = null;
  #drawn = 0;

  /** `page` has state, engine, background, and question() for the worker. */
  constructor(page) {
    this.page = page;
    const slider = element("accuracy");
    slider.max = STOPS - 1;
    const names = [["off", 0], ...[16, 8, 4, 2, 1, 0.5].map((budget) => [shadesText(budget), stopOf(budget)])];
    element("octaves").replaceChildren(...names.map(([label, stop]) => new Option(label, stop)));
    document.querySelector(".scale").replaceChildren(...names.map(([label, stop]) => {
      const mark = make("span", {}, label);
      mark.style.setProperty("--stop", stop / (STOPS - 1));
      return mark;
    }));
    slider.addEventListener("input", () => page.choose({ maxError: budgetAt(Number(slider.value)) }));
    const shadings = element("shading");
    shadings.replaceChildren(new Option("what the scene asks for", ""), ...page.engine.shadings.map((name) => new Option(name, name)));
    shadings.addEventListener("change", () => page.choose({ maxError: null, shading: shadings.value }));
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

  /** Shows what is set. */
  follow() {
    const { maxError, shading } = this.page.state;
    const slider = element("accuracy");
    slider.value = stopOf(maxError);
    const wish = maxError ? `at most ${budgetText(maxError)}` : "off: one shading for all faces";
    element("wish").textContent = wish;
    slider.setAttribute("aria-valuetext", wish);
    element("choice").hidden = Boolean(maxError);
    element("shading").value = shading ?? "";
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
    const bar = shares.map(([name, faces]) => {
      const part = make("i", { title: `${name}: ${faces} faces` });
      part.style.cssText = `flex:${faces};background:${techniqueColor(name)}`;
      return part;
    });
    element("shares").replaceChildren(...bar);
    const words = shares.map(([name, faces]) => [name, `${name} ${faces * 200 < all ? "under 1" : Math.round((100 * faces) / all)} %`]);
    element("shares-key").replaceChildren(...words.map(([name, text]) => keyItem(techniqueColor(name), text)));
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
    const points = others.map((point) => ({ ...point, choose: () => this.page.choose(point.settings) }));
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
      ...[16, 8, 4, 2, 1, 0.5].map((maxError) => ({ maxError })),
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
      scene.set({ ...this.page.settings(), maxError: budgetAt(stop) });
      return median([1, 2, 3].map(() => scene.time(state.seconds, state.pose, 8)));
    };
    let [fits, beyond] = [FIRST_STOP - 1, STOPS];
    const times = new Map();
    while (beyond - fits > 1) {
      const middle = (fits + beyond) >> 1;
      times.set(middle, takes(middle));
      if (times.get(middle) <= limit) fits = middle;
      else beyond = middle;
    }
    if (fits < FIRST_STOP) {
      element("found").textContent = `Not here: 16 shades take ${timeText(times.get(FIRST_STOP) ?? takes(FIRST_STOP))}.`;
      this.page.choose({ maxError: 16 });
      return;
    }
    element("found").textContent = `${budgetText(budgetAt(fits))}, in ${timeText(times.get(fits))}.`;
    this.page.choose({ maxError: budgetAt(fits) });
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
