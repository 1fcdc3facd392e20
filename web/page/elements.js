// Elements of the page.

const element = (id) => document.getElementById(id);

function make(name, properties = {}, text) {
  const made = Object.assign(document.createElement(name), properties);
  if (text !== undefined) made.textContent = text;
  return made;
}

/** An item of a key: a colour, and what it stands for. */
function keyItem(color, text) {
  const item = make("li");
  const swatch = make("i", { className: "swatch" });
  swatch.style.background = color;
  item.append(swatch, ` ${text}`);
  return item;
}

/** Whether the reader asks for less motion. */
const isStill = () => matchMedia("(prefers-reduced-motion: reduce)").matches;
