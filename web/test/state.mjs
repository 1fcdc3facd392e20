// The state and the views told of its changes, in node: state.mjs
import assert from "node:assert/strict";
import { test } from "node:test";
import { FIRST_STATE, Store } from "../page/state.js";
import { LAST_STOP, OCTAVES, settingAt, shadesText, stopOf } from "../page/stops.js";

test("views hear of a change with the state before it", () => {
  const store = new Store(FIRST_STATE);
  const heard = [];
  store.listen((state, before) => heard.push([state.divider, before.divider]));
  store.choose({ divider: 0.25 });
  store.choose({ divider: 0.75 });
  assert.deepEqual(heard, [[0.25, 0.5], [0.75, 0.25]]);
});

test("a view that writes back is an error, and changes nothing", () => {
  const store = new Store(FIRST_STATE);
  store.listen((state) => store.choose({ divider: state.divider / 2 }));
  assert.throws(() => store.choose({ divider: 0.25 }), /a view changes the state/);
  assert.equal(store.state.divider, 0.25);
  assert.throws(() => (store.state.divider = 0.1), TypeError);
  assert.equal(store.state.divider, 0.25);
});

test("after a view that failed the state can be changed", () => {
  const store = new Store(FIRST_STATE);
  let fails = true;
  store.listen(() => {
    if (fails) throw new Error("failed");
  });
  assert.throws(() => store.choose({ playing: true }), /failed/);
  fails = false;
  store.choose({ playing: false });
  assert.equal(store.state.playing, false);
});

test("time passes without anybody being told", () => {
  const store = new Store(FIRST_STATE);
  store.listen(() => assert.fail("told"));
  store.pass(2.5);
  assert.equal(store.state.seconds, 2.5);
});

test("the slider's thumb stays where it was under a shading that is not on it", () => {
  const store = new Store(FIRST_STATE);
  for (let stop = 0; stop <= LAST_STOP; stop++) {
    store.choose(settingAt(stop));
    assert.equal(store.state.stop, stop);
    assert.equal(stopOf(settingAt(stop)), stop);
    store.choose({ maxError: null, shading: "phong" });
    assert.equal(store.state.stop, stop);
  }
});

test("budgets are shown exactly or rounded up", () => {
  for (let stop = 1; stop <= LAST_STOP; stop++) {
    const { maxError } = settingAt(stop);
    const shown = maxError === 0.5 ? 0.5 : Number(shadesText(maxError));
    assert.ok(shown >= maxError && shown < 1.1 * maxError, `${maxError} is shown as ${shown}`);
  }
  assert.deepEqual(OCTAVES.map(shadesText), ["16", "8", "4", "2", "1", "½"]);
});
