// @ts-check
// A small picture in the corner, shown while the large one is out of view but a control that changes it is in view.

import { element } from "./elements.js";

/** The parts of the page that change the picture. */
const ACTS = "#panel, #pixel, #scenes, #plan";

export class MiniPicture {
  #isOut = false;
  /**
   * Those of these parts that are in the window.
   * @type {Set<Element>}
   */
  #acting = new Set();

  constructor() {
    new IntersectionObserver(([{ isIntersecting }]) => {
      this.#isOut = !isIntersecting;
      this.#follow();
    }).observe(element("holder"));
    const acts = new IntersectionObserver((entries) => {
      for (const { target, isIntersecting } of entries) this.#acting[isIntersecting ? "add" : "delete"](target);
      this.#follow();
    });
    for (const part of document.querySelectorAll(ACTS)) acts.observe(part);
  }

  /** Whether the picture is in the window, large or small. */
  get isSeen() {
    return !this.#isOut || this.#acting.size > 0;
  }

  #follow() {
    const isMini = this.#isOut && this.isSeen;
    const [holder, bezel] = [element("holder"), element("bezel")];
    if (bezel.classList.contains("mini") === isMini) return;
    // The space that the picture leaves keeps its height.
    holder.style.height = isMini ? `${holder.offsetHeight}px` : "";
    bezel.classList.toggle("mini", isMini);
  }
}
