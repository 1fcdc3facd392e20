// What accuracy costs, at a glance: the times of the two pictures and their ratio, and two bars, time and error.

/** Times that differ by no more than this part count as one. */
const SAME = 0.05;

/** How many times the dearer of two takes, with an arrow to it. */
function ratioText(left, right) {
  const ratio = Math.max(left, right) / Math.min(left, right);
  if (ratio < 1 + SAME) return ["the same time", ""];
  const times = `${ratio < 9.95 ? ratio.toFixed(1) : Math.round(ratio)} ×`;
  return right > left ? [times, "the time →"] : [times, "← the time"];
}

class Versus {
  #strip = element("versus");

  constructor(page) {
    this.page = page;
  }

  /** Tells the times; `marks` is what was measured at the slider's marks, undefined where nothing was yet. */
  tell(marks) {
    const { left, state, accuracy } = this.page;
    this.compare();
    const known = marks.filter((mark) => mark);
    const full = (of, own) => Math.max(own ?? 0, ...known.map(of));
    this.#bar("time-bar", left.isRedrawn && left.ms / full(({ ms }) => ms, left.ms));
    this.#bar("error-bar", accuracy.judged?.max / full(({ max }) => max, accuracy.judged?.max));
    this.#strip.classList.toggle("settling", state.playing ? left.ms === null : !left.isSettled);
  }

  /** Tells the two pictures' names, their times, and the ratio. */
  compare() {
    const { left, right, state } = this.page;
    const isTimed = state.beside && state.beside !== "truth";
    setText(element("left-name"), settingName(state));
    setText(element("left-ms"), timeOf(left));
    setText(element("right-name"), state.beside ? besideName(state.beside) : "");
    setText(element("right-ms"), isTimed ? timeOf(right) : state.beside ? "not timed" : "");
    const [times, words] = isTimed && left.ms !== null && right.ms !== null ? this.#ratio() : ["", ""];
    setText(element("times"), times);
    setText(element("times-words"), words);
  }

  #ratio() {
    const { left, right, state } = this.page;
    if (!left.isRedrawn) return ["", "no pixel changes, so nothing is redrawn"];
    // Their times would differ by noise.
    if (settingLines(besideSetting(state.beside)) === settingLines({ maxError: state.maxError, shading: state.shading })) return ["", "the same on both sides"];
    return ratioText(left.ms, right.ms);
  }

  #bar(id, part) {
    // Two digits after the point are finer than a pixel.
    element(id).style.width = `${(100 * (part > 0 ? Math.min(part, 1) : 0)).toFixed(2)}%`;
  }
}

const timeOf = ({ ms, isRedrawn }) => (ms === null ? "…" : isRedrawn ? msText(ms) : "not redrawn");

/** The settings that `beside` stands for, a kind and a value; of the truth there are none. */
function besideSetting(beside) {
  const [kind, value] = beside.split(" ");
  return kind === "max-error" ? { maxError: Number(value) } : { maxError: null, shading: value };
}

const besideName = (beside) => (beside === "truth" ? "exact (64-bit)" : settingName(besideSetting(beside)));
