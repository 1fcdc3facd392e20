// Elements of the page.

const element = (id) => document.getElementById(id);

function make(name, properties = {}, text) {
  const made = Object.assign(document.createElement(name), properties);
  if (text !== undefined) made.textContent = text;
  return made;
}

/** Sets a text where it differs, so that a selection in it stays. */
function setText(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

/**
 * Gives `parent` a child for each item, in order. A child is made once for its key and from then on updated in place: a
 * press that is under way and the focus are kept.
 */
function keyed(parent, items, keyOf, create, update = () => {}) {
  const keys = new Set(items.map((item) => `${keyOf(item)}`));
  for (const child of [...parent.children]) if (!keys.has(child.dataset.key)) child.remove();
  const known = new Map([...parent.children].map((child) => [child.dataset.key, child]));
  let place = parent.firstElementChild;
  for (const item of items) {
    const key = `${keyOf(item)}`;
    const child = known.get(key) ?? create(item);
    child.dataset.key = key;
    if (child === place) place = place.nextElementSibling;
    else parent.insertBefore(child, place);
    update(child, item);
  }
}

/** Shows what is wrong above the page; nothing hides it. */
function showTrouble(message) {
  setText(element("trouble").firstElementChild, message);
  element("trouble").hidden = !message;
}

/** An item of a key: a colour, and what it stands for. */
function keyItem(color, text) {
  const item = make("li");
  const swatch = make("i", { className: "swatch" });
  swatch.style.background = color;
  item.append(swatch, " ", make("span", {}, text));
  return item;
}

/** Whether the reader asks for less motion. */
const isStill = () => matchMedia("(prefers-reduced-motion: reduce)").matches;
