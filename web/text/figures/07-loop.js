// The loop of 1994, one instruction at a time.
import * as M from "./00-shared.js";

const CODE = ["mov [edi], ah", "inc edi", "add ax, bx", "dec cx", "jnz top"];
const PIXELS = 16;
const VIDEO = 0xA0000;

// The registers after `done` instructions: a pure function, so that the reader can step back, too.
export function loopState(ax, bx, pixels, done) {
  const row = new Array(pixels).fill(null);
  const state = { ax, bx, cx: pixels, edi: VIDEO, row, at: 0, carry: false, changed: "", over: pixels === 0 };
  for (let i = 0; i < done && !state.over; i++) {
    state.carry = false;
    switch (state.at) {
      case 0: row[state.edi - VIDEO] = state.ax >> 8; state.changed = "byte"; break;
      case 1: state.edi++; state.changed = "edi"; break;
      case 2: {
        state.carry = (state.ax & 255) + (bx & 255) > 255;
        state.ax = (state.ax + bx) & 0xFFFF;
        state.changed = "ax";
        break;
      }
      case 3: state.cx--; state.changed = "cx"; break;
      case 4: state.changed = ""; state.over = state.cx === 0; break;
    }
    state.at = (state.at + 1) % 5;
  }
  return state;
}

M.figure("loop", (stage, engine) => {
  let [ax, bx, done] = [0x5080, 0x0460, 22];
  const total = PIXELS * 5;

  const machine = M.make("div", "fig-machine", stage);
  const list = M.make("ol", "fig-code", machine);
  const lines = CODE.map((c, i) => M.make("li", "", list, (i ? "     " : "top: ") + c));
  const table = M.make("table", "fig-registers", machine);
  const rows = Object.fromEntries(["AX", "AH", "AL", "BX", "CX", "EDI"].map((name) => {
    const tr = M.make("tr", "", table);
    M.make("th", "", tr, name).scope = "row";
    return [name, { tr, cells: [M.make("td", "", tr), M.make("td", "", tr), M.make("td", "", tr)] }];
  }));

  const frame = M.board(stage, {
    height: (w) => Math.floor(w / PIXELS) + 34,
    paint(c, w, h, ink) {
      const s = loopState(ax, bx, PIXELS, done);
      const cell = Math.floor(w / PIXELS);
      for (let x = 0; x < PIXELS; x++) {
        const byte = s.row[x];
        c.fillStyle = byte === null ? ink.paper : M.grey(byte);
        c.fillRect(x * cell, 0, cell, cell);
        c.strokeStyle = ink.line;
        c.strokeRect(x * cell + .5, .5, cell - 1, cell - 1);
        if (byte !== null && cell > 17) {
          M.text(c, M.hex(byte, 2), x * cell + cell / 2, cell / 2 + 4, byte > 115 ? "#000" : "#fff",
            { align: "center", font: `${Math.min(13, cell / 2)}px ${ink.mono}` });
        }
      }
      const x = Math.min(s.edi - VIDEO, PIXELS - .5) * cell + cell / 2;
      c.fillStyle = ink.accent;
      c.beginPath();
      c.moveTo(x, cell + 4);
      c.lineTo(x + 6, cell + 13);
      c.lineTo(x - 6, cell + 13);
      c.fill();
      const right = x > w - 80;
      M.text(c, "EDI", right ? x - 10 : x + 10, cell + 15, ink.accent, { align: right ? "right" : "left" });
      M.text(c, "bytes of the frame, in hexadecimal", right ? 0 : w, cell + 31, ink.muted,
        { align: right ? "left" : "right" });
    },
  });

  const say = M.readout(stage);
  const keys = M.controls(stage);
  M.button(keys, "One instruction", () => go(Math.min(done + 1, total)));
  M.button(keys, "One pixel", () => go(Math.min((Math.floor(done / 5) + 1) * 5, total)));
  M.button(keys, "Whole row", () => go(total));
  M.button(keys, "Start again", () => go(0));
  const sliders = M.controls(stage);
  const time = M.slider(sliders, { label: "Instructions done", min: 0, max: total, value: done, input: go });
  M.slider(sliders, {
    label: "Start: AX", min: 0, max: 0xFF80, step: 16, value: ax,
    format: (v) => `${M.hex(v, 4)}h = ${(v / 256).toFixed(2)}`,
    input: (v) => ((ax = v), show()),
  });
  M.slider(sliders, {
    label: "Step: BX", min: -0x800, max: 0x800, step: 8, value: bx,
    format: (v) => `${M.hex(v & 0xFFFF, 4)}h = ${M.signed(v / 256)}`,
    input: (v) => ((bx = v & 0xFFFF), show()),
  });

  function go(n) {
    done = n;
    time.set(n);
    show();
  }

  function show() {
    const s = loopState(ax, bx, PIXELS, done);
    const [ah, al] = [s.ax >> 8, s.ax & 255];
    const value = (name, number, bits, meaning, on) => {
      const { tr, cells } = rows[name];
      cells[0].textContent = M.hex(number, Math.ceil(bits / 4));
      cells[1].textContent = bits === 8 ? M.binary(number, 8) : "";
      cells[2].textContent = meaning;
      tr.className = on ? "on" : "";
    };
    value("AX", s.ax, 16, `shade ${(s.ax / 256).toFixed(3)}`, s.changed === "ax");
    value("AH", ah, 8, `the byte: ${ah}`, s.changed === "ax");
    value("AL", al, 8, `the fraction: ${al}/256${s.carry ? ", carried" : ""}`, s.changed === "ax");
    value("BX", bx, 16, `step ${M.signed((bx << 16 >> 16) / 256, 3)}`, false);
    value("CX", s.cx, 16, `${M.count(s.cx, "pixel")} left`, s.changed === "cx");
    value("EDI", s.edi, 20, `byte ${s.edi - VIDEO} of the frame`, s.changed === "edi");
    lines.forEach((l, i) => {
      l.className = !s.over && i === s.at ? "on" : "";
      if (!s.over && i === s.at) l.setAttribute("aria-current", "step");
      else l.removeAttribute("aria-current");
    });
    frame.describe(`Row of ${PIXELS} bytes: ${s.row.map((b) => b ?? "–").join(" ")}`);
    frame.repaint();
    const bytes = M.spanBytes(ax, bx, PIXELS);
    const same = engine && M.equalBytes(engine.span(ax, bx, PIXELS), bytes);
    const carry = s.carry ? ["AL overflowed: the carry went into AH."] : [];
    if (s.over) {
      say(`CX is 0, so jnz does not jump. ${PIXELS} pixels took ${PIXELS * 5} instructions.`,
        ...(engine ? [same ? " The engine gives the same bytes." : { b: " The engine gives different bytes.", warn: true }] : []));
    } else {
      say("Next: ", { code: CODE[s.at] }, ". ", ...carry);
    }
  }
  show();
}, true);
