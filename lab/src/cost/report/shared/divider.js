// @ts-check
// A divider over two pictures, dragged by pointer or keys: one for the page and for the report of `mode13h cost`.
/**
 * Puts a divider on an element in which the right picture lies under the left. Its place, 0 to 1, is the element's --at.
 * `change` hears where a hand moves it. Returns a function that moves it, of which `change` does not hear.
 * @param {HTMLElement} element
 * @param {string} label
 * @param {(place: number) => void} change
 */
export function divide(element, label, change = () => {}) {
  const handle = document.createElement("button");
  handle.type = "button";
  handle.className = "divider";
  handle.setAttribute("role", "slider");
  handle.setAttribute("aria-label", label);
  handle.setAttribute("aria-valuemin", "0");
  handle.setAttribute("aria-valuemax", "100");
  element.append(handle);
  let place = -1;
  /** @param {number} to */
  const move = (to) => {
    if (to === place) return;
    place = Math.min(Math.max(to, 0), 1);
    element.style.setProperty("--at", `${100 * place}%`);
    handle.setAttribute("aria-valuenow", `${Math.round(100 * place)}`);
    handle.setAttribute("aria-valuetext", `${Math.round(100 * place)} % from the left`);
  };
  /** @param {number} to */
  const moveByHand = (to) => {
    move(to);
    change(place);
  };
  /** @param {PointerEvent} event */
  const follow = (event) => {
    const box = element.getBoundingClientRect();
    moveByHand((event.clientX - box.left) / box.width);
  };
  handle.addEventListener("pointerdown", (event) => {
    handle.setPointerCapture(event.pointerId);
    handle.onpointermove = follow;
    event.stopPropagation();
  });
  for (const end of ["pointerup", "pointercancel"]) handle.addEventListener(end, () => (handle.onpointermove = null));
  handle.addEventListener("keydown", (event) => {
    /** @type {Record<string, number>} */
    const steps = { ArrowLeft: -0.01, ArrowDown: -0.01, ArrowRight: 0.01, ArrowUp: 0.01, PageDown: -0.1, PageUp: 0.1, Home: -1, End: 1 };
    if (!(event.key in steps) || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    event.stopPropagation();
    moveByHand(place + steps[event.key]);
  });
  move(0.5);
  return move;
}
