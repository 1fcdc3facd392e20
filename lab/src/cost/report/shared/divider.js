// A divider over two pictures, dragged by pointer or keys: one for the page and for the report of `mode13h cost`.
"use strict";

/**
 * Puts a divider on an element in which the right picture lies under the left. `change` hears the place, 0 to 1, which
 * the element also has as --at. Returns a function that moves it.
 */
function divide(element, label, change = () => {}) {
  const handle = document.createElement("button");
  handle.type = "button";
  handle.className = "divider";
  handle.setAttribute("role", "slider");
  handle.setAttribute("aria-label", label);
  handle.setAttribute("aria-valuemin", "0");
  handle.setAttribute("aria-valuemax", "100");
  element.append(handle);
  let place = 0.5;
  const move = (to) => {
    place = Math.min(Math.max(to, 0), 1);
    element.style.setProperty("--at", `${100 * place}%`);
    handle.setAttribute("aria-valuenow", Math.round(100 * place));
    handle.setAttribute("aria-valuetext", `${Math.round(100 * place)} % from the left`);
    change(place);
  };
  const follow = (event) => {
    const box = element.getBoundingClientRect();
    move((event.clientX - box.left) / box.width);
  };
  handle.addEventListener("pointerdown", (event) => {
    handle.setPointerCapture(event.pointerId);
    handle.onpointermove = follow;
    event.stopPropagation();
  });
  for (const end of ["pointerup", "pointercancel"]) handle.addEventListener(end, () => (handle.onpointermove = null));
  handle.addEventListener("keydown", (event) => {
    const steps = { ArrowLeft: -0.01, ArrowDown: -0.01, ArrowRight: 0.01, ArrowUp: 0.01, PageDown: -0.1, PageUp: 0.1, Home: -1, End: 1 };
    if (!(event.key in steps)) return;
    event.preventDefault();
    event.stopPropagation();
    move(place + steps[event.key]);
  });
  move(place);
  return move;
}
