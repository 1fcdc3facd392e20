// @ts-check
// Elements of the page.

/** @import { Elements } from "./types.d.ts" */

/**
 * The element with an id.
 * @template {keyof Elements} Id
 * @param {Id} id
 * @returns {Elements[Id]}
 */
export const element = (id) => /** @type {any} */ (document.getElementById(id));

/**
 * @template {keyof HTMLElementTagNameMap} Name
 * @param {Name} name
 * @param {Partial<HTMLElementTagNameMap[Name]>} properties
 * @param {string | number} [text]
 * @returns {HTMLElementTagNameMap[Name]}
 */
export function make(name, properties = {}, text) {
  const made = Object.assign(document.createElement(name), properties);
  if (text !== undefined) made.textContent = `${text}`;
  return made;
}

/**
 * Sets a text only if it differs, so that a selection in it stays.
 * @param {Element} element
 * @param {string} text
 */
export function setText(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

/**
 * Gives `parent` a child for each item, in order. A child is made once for its key and from then on updated in place: a
 * press that is under way and the focus are kept.
 * @template Item
 * @template {HTMLElement} Child
 * @param {HTMLElement} parent
 * @param {Item[]} items
 * @param {(item: Item) => string} keyOf
 * @param {(item: Item) => Child} create
 * @param {(child: Child, item: Item) => void} update
 */
export function keyed(parent, items, keyOf, create, update) {
  const children = () => /** @type {Child[]} */ ([...parent.children]);
  const keys = new Set(items.map(keyOf));
  for (const child of children()) if (!keys.has(child.dataset.key ?? "")) child.remove();
  const known = new Map(children().map((child) => [child.dataset.key, child]));
  let place = parent.firstElementChild;
  for (const item of items) {
    const key = keyOf(item);
    const child = known.get(key) ?? create(item);
    child.dataset.key = key;
    if (child === place) place = place.nextElementSibling;
    else parent.insertBefore(child, place);
    update(child, item);
  }
}

/**
 * Shows an error above the page, where nothing hides it.
 * @param {string} message
 */
export function showTrouble(message) {
  const trouble = element("trouble");
  setText(/** @type {Element} */ (trouble.firstElementChild), message);
  trouble.hidden = !message;
}

/**
 * An item of a key: a colour, and what it stands for.
 * @param {string} color
 * @param {string} text
 */
export function keyItem(color, text) {
  const item = make("li");
  const swatch = make("i", { className: "swatch" });
  swatch.style.background = color;
  item.append(swatch, " ", make("span", {}, text));
  return item;
}

/** Whether the reader asks for less motion. */
export const isStill = () => matchMedia("(prefers-reduced-motion: reduce)").matches;
