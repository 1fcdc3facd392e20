// @ts-check
// A small picture in the corner: there while the large one is out of the window, and something that acts on it is in it.

import { element } from "./elements.js";

/** What acts on the picture. */
const ACTS = "#panel, #pixel, #scenes, #plan";

export class MiniPicture {
  #isOut = false;
  /**
   * The parts that act on the picture and are in the window.
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
    // The place that the picture leaves stays as high as it was.
    holder.style.height = isMini ? `${holder.offsetHeight}px` : "";
    bezel.classList.toggle("mini", isMini);
  }
}
