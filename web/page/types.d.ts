// Types that several of the page's scripts share, and what the engine answers as JSON.

/** Turn and tilt in radians, and the enlargement. */
export interface Pose { readonly turn: number; readonly tilt: number; readonly zoom: number }
export interface Pixel { readonly x: number; readonly y: number }
/** Effects that were switched by hand. */
export type Effects = Readonly<Record<string, boolean>>;

/** How faces are shaded: within a budget, or all by one shading; "" is what the scene asks for. */
export interface Setting { readonly maxError: number | null; readonly shading: string }
export interface Settings extends Partial<Setting> { readonly effects?: Effects }

export interface Picture { bytes: Uint8Array; palette: Uint8Array }
export interface Frame extends Picture { width: number; height: number }

/** What the page shows. */
export interface State extends Setting {
  readonly name: string;
  readonly toml: string;
  readonly seconds: number;
  readonly playing: boolean;
  readonly pose: Pose;
  readonly effects: Effects;
  /** What the picture is compared with: "", "truth", or a kind and a value. */
  readonly beside: string;
  /** Part of the width on which the left picture is seen. */
  readonly divider: number;
  readonly pixel: Pixel | null;
  /** Where the slider's thumb is, also while a shading is chosen that is not on the slider. */
  readonly stop: number;
}

/** What is asked of the worker about a frame. */
export interface Question { toml: string; version: number; seconds: number; pose: Pose; settings: Settings }
export interface MeasureQuestion extends Question { judges: boolean; laps: number }

export interface Lap { ms: number; isRedrawn: boolean }

export interface Shipped { name: string; toml: string; shows: string }
export interface Level { label: string; color: string }
export interface About { shipped: Shipped[]; shadings: string[]; effects: string[]; levels: Level[]; notTaken: string; kernel: string; version: string }
export interface SceneAbout { name: string; duration: number; picture: number; objects: number; faces: number; warnings: string[] }
export interface Counts {
  shading: string; maxError: number | null; redrawn: boolean; faces: number; drawn: number;
  /** Pixels drawn, and how often light was computed. */
  pixels: number; lit: number;
  /** Faces by shading. */
  shares: [string, number][];
}
export interface PlanRow { place: number; object: string; effect: string; on: boolean; choice: string | null; reason: string }
export interface Errors {
  max: number; mean: number; rms: number; maxError: number | null;
  /** Pixels beyond the budget, and those of faces seen edge on, which are apart. */
  beyond: number; edgeOn: { pixels: number; max: number };
}
/** Errors, and the level of each pixel. */
export interface Judged extends Errors { map: Uint8Array }
export interface Registers { eax: number; ebx: number; cx: number; edi: number; isWide: boolean }
export interface Account {
  x: number; y: number; byte: number; color: string; text: string; shading: string;
  /** A standard; the shade by it, or red, green and blue; and how far off the shade is that is farthest off. */
  against?: [string, [number, number, number], number][];
  /** Of a ramp it is an entry, otherwise a shade. */
  exact?: number; isRamp?: boolean; object?: string; triangle?: number;
  corners?: [number, number, number][];
  registers?: Registers | null;
}
/** What was measured of a setting. */
export interface Mark extends Errors { lit: number; pixels: number; ms: number | null; isRedrawn: boolean }

/** The engine's exports, over linear memory. */
export interface Exports {
  memory: WebAssembly.Memory;
  start(): number;
  answer(): number;
  answer_length(): number;
  [name: string]: WebAssembly.Memory | ((...numbers: number[]) => number);
}

/** What is packed in the page. */
export interface Parts { wasm: Uint8Array<ArrayBuffer>; worker: string }

/** The page's elements by their ids. */
export interface Elements {
  "accuracy": HTMLInputElement; "account": HTMLElement; "as-planned": HTMLButtonElement; "beside": HTMLSelectElement;
  "bezel": HTMLElement; "chart": HTMLElement; "clock": HTMLElement; "copy-link": HTMLButtonElement; "drop": HTMLElement;
  "dropped": HTMLElement; "error-bar": HTMLElement; "errors": HTMLCanvasElement; "errors-age": HTMLElement;
  "files": HTMLInputElement; "first-pose": HTMLButtonElement; "found": HTMLElement; "gallery": HTMLElement;
  "holder": HTMLElement; "instrument": HTMLElement; "left-ms": HTMLElement; "left-name": HTMLElement;
  "lens": HTMLCanvasElement; "levels": HTMLElement; "limit": HTMLInputElement; "lines": HTMLElement; "lit": HTMLElement;
  "measure": HTMLButtonElement; "ms": HTMLElement; "object": HTMLSelectElement; "object-label": HTMLElement;
  "octaves": HTMLElement; "once": HTMLElement; "overlay": HTMLCanvasElement; "packed": HTMLElement;
  "picture": HTMLCanvasElement; "pixel": HTMLElement; "play": HTMLButtonElement; "price": HTMLButtonElement;
  "promise": HTMLElement; "rate": HTMLElement; "right-ms": HTMLElement; "right-name": HTMLElement; "rms": HTMLElement;
  "save-gif": HTMLButtonElement; "save-png": HTMLButtonElement; "save-toml": HTMLButtonElement; "saved": HTMLElement;
  "screen": HTMLElement; "seconds": HTMLElement; "shading": HTMLSelectElement; "shares": HTMLElement;
  "shares-key": HTMLElement; "show-errors": HTMLButtonElement; "still": HTMLElement; "text": HTMLElement;
  "theme": HTMLButtonElement; "time": HTMLInputElement; "time-bar": HTMLElement; "times": HTMLElement;
  "times-words": HTMLElement; "toml": HTMLTextAreaElement; "trouble": HTMLElement; "trouble-close": HTMLButtonElement;
  "unused": HTMLButtonElement; "verdict": HTMLElement; "versus": HTMLElement; "why": HTMLElement; "wish": HTMLElement;
  "within": HTMLFormElement; "worst": HTMLElement;
}

declare global {
  /** For the tests and for who is curious. */
  var page: import("./page.js").Page | undefined;
}
