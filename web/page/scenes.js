// @ts-check
// Scenes: a picture of each shipped one, the editor, and dropped models.

import { group, messageOf } from "./common.js";
import { element, isStill, make } from "./elements.js";
import { PalettedCanvas } from "./picture.js";

/**
 * @import { Page } from "./page.js"
 * @import { SceneAbout } from "./types.d.ts"
 */

/** Milliseconds without a key press before the text is tried. */
const PAUSE = 300;

/** The extensions of files that may be dropped. */
const TAKEN = [".obj", ".mtl", ".png", ".toml"];

/**
 * Whether a scene's text names a file, in any folder.
 * @param {string} toml
 * @param {string} file
 */
const names = (toml, file) => ["'", '"'].some((quote) => [quote, "/"].some((before) => toml.includes(before + file + quote)));

export class Scenes {
  #timer = 0;
  /** @type {Map<string, Uint8Array>} */
  #files = new Map();

  /** @param {Page} page */
  constructor(page) {
    this.page = page;
    this.text = element("toml");
    this.text.addEventListener("input", () => {
      clearTimeout(this.#timer);
      this.#timer = setTimeout(() => this.#try(), PAUSE);
      this.#number();
    });
    this.text.addEventListener("scroll", () => (element("lines").scrollTop = this.text.scrollTop));
    const drop = element("drop");
    // The whole page accepts files, so that a drop that misses its target does not leave the page.
    addEventListener("dragover", (event) => {
      // Text can be dragged as usual.
      if (!event.dataTransfer?.types.includes("Files")) return;
      event.preventDefault();
      drop.classList.add("over");
    });
    addEventListener("dragleave", ({ relatedTarget }) => relatedTarget ?? drop.classList.remove("over"));
    addEventListener("drop", (event) => {
      drop.classList.remove("over");
      if (!event.dataTransfer?.types.includes("Files")) return;
      event.preventDefault();
      const files = [...event.dataTransfer.files];
      if (files.length) this.take(files);
    });
    const chosen = element("files");
    chosen.addEventListener("change", () => {
      this.take([...(chosen.files ?? [])]);
      chosen.value = "";
    });
    this.#gallery();
  }

  #gallery() {
    const cards = this.page.engine.shipped.map(({ name, toml, shows }) => {
      const card = make("button", { type: "button", className: "card", title: shows });
      card.dataset.scene = name;
      const canvas = make("canvas");
      card.append(canvas, make("span", {}, name));
      card.addEventListener("click", () => {
        this.page.open(toml, name);
        element("instrument").scrollIntoView({ behavior: isStill() ? "auto" : "smooth" });
      });
      return { card, canvas, toml };
    });
    element("gallery").replaceChildren(...cards.map(({ card }) => card));
    // One at a time, whenever the page is idle.
    /** @param {() => void} work */
    const idle = (work) => ("requestIdleCallback" in globalThis ? requestIdleCallback(work) : setTimeout(work, 50));
    const next = () => {
      const card = cards.shift();
      if (!card) return;
      const { canvas, toml } = card;
      const scene = this.page.engine.open(toml);
      scene.show(scene.about.picture);
      scene.draw();
      new PalettedCanvas(canvas).show(scene.frame());
      scene.free();
      idle(next);
    };
    idle(next);
  }

  /** Shows the text of the scene that was opened. */
  follow() {
    const { toml, name } = this.page.state;
    if (this.text.value !== toml) this.text.value = toml;
    for (const card of element("gallery").querySelectorAll("button")) card.setAttribute("aria-current", `${card.dataset.scene === name}`);
    this.#number();
    this.verdict(this.page.scene.about);
  }

  /** @param {number} [wrong] */
  #number(wrong = 0) {
    const count = this.text.value.split("\n").length;
    const lines = Array.from({ length: count }, (_, at) => [make(at + 1 === wrong ? "b" : "span", {}, at + 1), "\n"]);
    element("lines").replaceChildren(...lines.flat());
    element("lines").scrollTop = this.text.scrollTop;
  }

  #try() {
    try {
      this.page.open(this.text.value, this.#nameOf(this.text.value), true);
    } catch (error) {
      const { line, column, message } = /** @type {Error & { line?: number, column?: number }} */ (error);
      element("verdict").className = "wrong";
      element("verdict").textContent = line ? `Line ${line}, column ${column}: ${message}` : message;
      this.text.setAttribute("aria-invalid", "true");
      this.#number(line);
    }
  }

  /**
   * The name of a scene that was edited: its own, unless the text is the present one or that of a shipped one.
   * @param {string} toml
   */
  #nameOf(toml) {
    if (toml === this.page.state.toml) return this.page.state.name;
    const shipped = this.page.engine.shipped.find((scene) => scene.toml === toml);
    return shipped?.name ?? `${this.page.state.name.replace(/-edited$/, "")}-edited`;
  }

  /** @param {SceneAbout} about */
  verdict({ faces, objects, warnings }) {
    const counts = `${objects} ${objects === 1 ? "object" : "objects"}, ${group(faces)} faces.`;
    element("verdict").className = warnings.length ? "warned" : "";
    element("verdict").textContent = [counts, ...warnings].join(" ");
    this.text.removeAttribute("aria-invalid");
  }

  /**
   * Accepts files: a scene, or a model with the files that it names.
   * @param {File[]} dropped
   */
  async take(dropped) {
    const files = dropped.filter(({ name }) => TAKEN.some((extension) => name.toLowerCase().endsWith(extension)));
    const others = dropped.filter((file) => !files.includes(file)).map(({ name }) => name);
    try {
      if (files.length) await this.#open(files);
      if (others.length) this.page.trouble("files", `${others.join(", ")}: not read. This page takes OBJ, MTL, PNG and TOML.`);
    } catch (error) {
      this.page.trouble("files", `${files.map((file) => file.name).join(", ")}: ${messageOf(error)}`);
    }
  }

  /** @param {File[]} files */
  async #open(files) {
    for (const file of files) this.#files.set(file.name, new Uint8Array(await file.arrayBuffer()));
    this.page.setFiles(this.#files);
    element("dropped").replaceChildren(...[...this.#files].map(([name, bytes]) => make("li", { className: "mono" }, `${name}, ${group(bytes.length)} bytes`)));
    // A link that waited for these files brings its scene, pose and settings.
    if (this.page.retry((toml) => files.some((file) => names(toml, file.name)))) return;
    /** @param {string} extension */
    const find = (extension) => files.find((file) => file.name.toLowerCase().endsWith(extension));
    const [scene, model] = [find(".toml"), find(".obj")];
    const text = this.text.value;
    if (scene) this.page.open(await scene.text(), scene.name.replace(/\.toml$/i, ""));
    else if (model && !names(text, model.name)) this.page.open(this.#showing(model.name), model.name.replace(/\.obj$/i, ""));
    else this.page.open(text, this.#nameOf(text), true);
    element("instrument").scrollIntoView({ behavior: isStill() ? "auto" : "smooth" });
  }

  /**
   * The scene of a turning model, in its own colours if its materials have any.
   * @param {string} name
   */
  #showing(name) {
    const materials = [...this.#files].filter(([file]) => file.toLowerCase().endsWith(".mtl"));
    const texts = materials.map(([, bytes]) => new TextDecoder().decode(bytes)).join("\n");
    const isColored = /^\s*map_Kd\s/m.test(texts) || [...texts.matchAll(/^\s*Kd\s+(\S+)\s+(\S+)\s+(\S+)/gm)].some(([, red, green, blue]) => red !== green || green !== blue);
    const palette = isColored ? "auto" : "grey";
    return `palette = "${palette}"\nobjects = [{ model = ${JSON.stringify(name)}, spin = 1 }]\nlights = [{ sun = [0.4, 0.6, 1] }]\n`;
  }
}
