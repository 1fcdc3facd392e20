// @ts-check
// The plan: which effects the scene calls for, why, and what each costs here.

import { group } from "./common.js";
import { element, keyed, make, setText } from "./elements.js";
import { median, msText, Stopwatch } from "./stopwatch.js";

/**
 * @import { Scene } from "./engine.js"
 * @import { Page } from "./page.js"
 * @import { PlanRow, Settings } from "./types.d.ts"
 */

/** Effects that another setting chooses, or that keep triangles within what the rasterizer can draw. */
const FIXED = ["transform", "hidden-surfaces", "near-clipping", "screen-clipping"];

/** Why a budget draws faces by a technique, in plain words. */
const WHY = new Map([
  ["flat", "one shade is close enough"],
  ["gouraud-float", "straight in space, curved on the screen"],
  ["phong-quadratic", "a curve is close enough"],
  ["phong-every-16", "lit at every 16th pixel, straight between"],
  ["phong-every-8", "lit at every 8th pixel"],
  ["phong-every-4", "lit at every 4th pixel"],
  ["phong", "no proof, so lit at every pixel"],
]);

/**
 * A reason in plain words; if the engine counts faces by technique, a sentence for each.
 * @param {string} reason
 */
function plainReason(reason) {
  const counted = /: ((?:\d+ [\w.-]+ \([^)]*\), )+)(\d+) not drawn$/.exec(reason);
  if (!counted) return reason;
  const parts = [...counted[1].matchAll(/(\d+) ([\w.-]+) \(/g)].map(([, faces, technique], at) =>
    `${group(Number(faces))}${at ? "" : faces === "1" ? " face" : " faces"}: ${WHY.get(technique) ?? "a straight blend is provably close enough"}.`);
  return `${parts.join(" ")} ${group(Number(counted[2]))} not seen.`;
}

/** The number of times that each effect's frames are timed. */
const ROUNDS_OF_PRICE = 15;

export class PlanTable {
  /** @type {Map<string, number | null>} */
  #prices = new Map();
  /** @type {PlanRow[]} */
  rows = [];

  /** @param {Page} page */
  constructor(page) {
    this.page = page;
    this.body = /** @type {HTMLElement} */ (document.querySelector("#effects tbody"));
    element("object").addEventListener("change", () => this.show(this.rows));
    element("unused").addEventListener("click", () => {
      this.body.classList.toggle("all");
      this.show(this.rows);
    });
    element("price").addEventListener("click", () => this.measure());
    element("as-planned").addEventListener("click", () => page.choose({ effects: {} }));
  }

  forget() {
    this.#prices.clear();
  }

  /** @param {PlanRow[]} rows */
  show(rows) {
    this.rows = rows;
    const objects = [...new Map(rows.map((row) => [row.place, row.object])).entries()];
    const chosen = element("object");
    const names = objects.map(([place, name]) => `${place}: ${name}`).join("\n");
    if (chosen.dataset.names !== names) {
      chosen.dataset.names = names;
      chosen.replaceChildren(...objects.map(([place, name]) => new Option(objects.length > 1 ? `${place + 1}. ${name}` : name, `${place}`)));
      for (const part of [chosen, element("object-label")]) part.hidden = objects.length < 2;
    }
    const shown = rows.filter((row) => row.place === Number(chosen.value || 0));
    keyed(this.body, shown, ({ effect }) => effect, (row) => this.#make(row), (line, row) => this.#update(line, row));
    const unused = this.body.querySelectorAll(".unused").length;
    element("unused").hidden = !unused;
    setText(element("unused"), this.body.classList.contains("all") ? "Hide what no material has" : `Show ${unused} more, which no material has`);
    element("as-planned").hidden = Object.keys(this.page.state.effects).length === 0;
  }

  /** @param {PlanRow} row */
  #make({ effect }) {
    const row = make("tr");
    const box = make("input", { type: "checkbox", id: `effect-${effect}`, disabled: FIXED.includes(effect), ariaLabel: effect });
    box.addEventListener("change", () => this.page.choose({ effects: { ...this.page.state.effects, [effect]: box.checked } }));
    const [name, switched] = [make("th", { scope: "row" }), make("td")];
    name.append(make("label", { htmlFor: box.id }));
    switched.append(box);
    row.append(name, switched, make("td", { className: "number mono" }), make("td"));
    return row;
  }

  /**
   * @param {HTMLTableRowElement} line
   * @param {PlanRow} row
   */
  #update(line, { place, effect, on, choice, reason }) {
    const [name, switched, cost, why] = line.cells;
    const box = /** @type {HTMLInputElement} */ (switched.firstElementChild);
    line.classList.toggle("on", on);
    line.classList.toggle("unused", !on && reason === "no material has it");
    if (box.checked !== on) box.checked = on;
    setText(/** @type {Element} */ (name.firstElementChild), choice && on ? `${effect}: ${choice}` : effect);
    setText(cost, this.#priceText(this.#prices.get(`${place} ${effect}`), on));
    setText(why, plainReason(reason));
  }

  /**
   * A price in words: null if the effect cannot be switched, 0 if the price is within the noise.
   * @param {number | null | undefined} price
   * @param {boolean} on
   */
  #priceText(price, on) {
    if (!price) return price === undefined ? "" : price === null ? "–" : "0";
    return on ? msText(price) : `(${msText(price)})`;
  }

  /** Measures how much longer a frame takes with each effect than without, drawing the two in turn. */
  async measure() {
    const button = element("price");
    const { engine, version } = this.page;
    const { toml } = this.page.state;
    // A separate scene, so that the picture is not disturbed.
    const scene = engine.open(toml);
    button.disabled = true;
    const rows = this.rows.filter((row) => row.place === Number(element("object").value || 0));
    try {
      for (const [at, { place, effect, on }] of rows.entries()) {
        button.textContent = `Measuring ${at + 1} of ${rows.length}`;
        await new Promise((resolve) => setTimeout(resolve));
        if (toml !== this.page.state.toml || version !== this.page.version) break;
        this.#prices.set(`${place} ${effect}`, FIXED.includes(effect) ? null : this.#price(scene, place, effect, on));
        this.show(this.rows);
      }
    } finally {
      scene.free();
      button.disabled = false;
      button.textContent = "Measure again";
    }
  }

  /**
   * @param {Scene} scene
   * @param {number} place
   * @param {string} effect
   * @param {boolean} on
   */
  #price(scene, place, effect, on) {
    const { seconds, pose } = this.page.state;
    const usual = this.page.settings();
    const switched = { ...usual, effects: { ...usual.effects, [effect]: !on } };
    /** @type {number[]} */
    const differences = [];
    /** @param {Settings} settings */
    const lap = (settings) => {
      scene.set(settings);
      return Stopwatch.lap(scene, seconds, pose).ms;
    };
    lap(usual);
    lap(switched);
    if (scene.plan().find((row) => row.place === place && row.effect === effect)?.on === on) return null;
    for (let round = 0; round < ROUNDS_OF_PRICE; round++) {
      const [as, other] = [lap(usual), lap(switched)];
      differences.push(on ? as - other : other - as);
    }
    // By chance half of n differences are above 0, with a standard deviation of √n/2: unless there are more than three
    // times that above the half, the price is noise.
    const above = differences.filter((difference) => difference > 0).length;
    const isNoise = above <= differences.length / 2 + (3 * Math.sqrt(differences.length)) / 2;
    return isNoise ? 0 : median(differences);
  }
}
