// The plan: which effects the scene calls for, why, and what each costs here.

/** Effects that are chosen by another setting, or that keep triangles inside what the raster can draw. */
const FIXED = ["transform", "hidden-surfaces", "near-clipping", "screen-clipping"];

/** How often each effect's frames are timed. */
const ROUNDS_OF_PRICE = 15;

class PlanTable {
  #prices = new Map();
  #said = "";

  constructor(page) {
    this.page = page;
    this.body = document.querySelector("#effects tbody");
    element("object").addEventListener("change", () => this.show(this.rows, true));
    element("price").addEventListener("click", () => this.measure());
    element("as-planned").addEventListener("click", () => page.choose({ effects: {} }));
  }

  forget() {
    this.#prices.clear();
    this.#said = "";
  }

  show(rows, again = false) {
    this.rows = rows;
    const said = JSON.stringify(rows.map(({ on, choice, reason }) => [on, choice, reason])) + JSON.stringify(this.page.state.effects);
    if (said === this.#said && !again) return;
    this.#said = said;
    const objects = [...new Map(rows.map((row) => [row.place, row.object])).entries()];
    const chosen = element("object");
    const names = objects.map(([place, name]) => `${place}: ${name}`).join("\n");
    if (chosen.dataset.names !== names) {
      chosen.dataset.names = names;
      chosen.replaceChildren(...objects.map(([place, name]) => new Option(objects.length > 1 ? `${place + 1}. ${name}` : name, place)));
      for (const part of [chosen, element("object-label")]) part.hidden = objects.length < 2;
    }
    const place = Number(chosen.value || 0);
    this.body.replaceChildren(...rows.filter((row) => row.place === place).map((row) => this.#row(row)));
    element("as-planned").hidden = Object.keys(this.page.state.effects).length === 0;
  }

  #row({ effect, on, choice, reason }) {
    const row = make("tr", { className: on ? "on" : "" });
    const forced = this.page.state.effects[effect];
    const box = make("input", { type: "checkbox", checked: on, disabled: FIXED.includes(effect), ariaLabel: effect });
    box.addEventListener("change", () => this.page.choose({ effects: { ...this.page.state.effects, [effect]: box.checked } }));
    const name = make("th", { scope: "row" }, choice && on ? `${effect}: ${choice}` : effect);
    const price = this.#prices.get(effect);
    const cost = make("td", { className: "number mono" }, price === undefined ? "" : price === null ? "–" : on ? timeText(price) : `(${timeText(price)})`);
    if (price === 0) cost.textContent = "0";
    const switched = make("td");
    switched.append(box);
    row.append(name, switched, cost, make("td", {}, reason + (forced === undefined ? "" : " (switched by hand)")));
    return row;
  }

  /** Measures how much longer a frame is with each effect than without: the two drawn in turn. */
  async measure() {
    const button = element("price");
    const { scene, state } = this.page;
    const { toml } = state;
    button.disabled = true;
    const rows = this.rows.filter((row) => row.place === Number(element("object").value || 0));
    for (const [at, { effect, on }] of rows.entries()) {
      button.textContent = `Measuring ${at + 1} of ${rows.length}`;
      await new Promise((resolve) => setTimeout(resolve));
      if (toml !== state.toml) break;
      this.#prices.set(effect, FIXED.includes(effect) ? null : this.#price(scene, effect, on));
      this.show(this.rows, true);
    }
    button.disabled = false;
    button.textContent = "Measure again";
  }

  #price(scene, effect, on) {
    const { state } = this.page;
    const usual = this.page.settings();
    const switched = { ...usual, effects: { ...usual.effects, [effect]: !on } };
    const differences = [];
    try {
      for (let round = 0; round < ROUNDS_OF_PRICE; round++) {
        scene.set(usual);
        const as = scene.time(state.seconds, state.pose, 4);
        scene.set(switched);
        const other = scene.time(state.seconds, state.pose, 4);
        differences.push(on ? as - other : other - as);
      }
      if (scene.plan().find((row) => row.effect === effect)?.on === on) return null;
    } finally {
      scene.set(usual);
    }
    // Of n differences by chance half are above 0, with a standard deviation of √n/2: what is not three times that above
    // has no price.
    const above = differences.filter((difference) => difference > 0).length;
    const isNoise = above <= differences.length / 2 + (3 * Math.sqrt(differences.length)) / 2;
    return isNoise ? 0 : median(differences);
  }
}
