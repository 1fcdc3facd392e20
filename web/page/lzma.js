// Unpacks LZMA, which makes the engine a quarter smaller than gzip does: the range coder, its probabilities, and the
// matches, as Igor Pavlov's "LZMA specification" has them. The file is of the form .lzma, its size known.

function unpackLzma(packed) {
  const properties = packed[0];
  const [lc, lp, pb] = [properties % 9, Math.floor(properties / 9) % 5, Math.floor(properties / 45)];
  const size = new DataView(packed.buffer, packed.byteOffset).getUint32(5, true);
  const out = new Uint8Array(size);
  const chances = (count) => new Uint16Array(count).fill(1024);

  // The range coder. Its first byte is 0.
  let [at, range, code] = [18, 0xffffffff, new DataView(packed.buffer, packed.byteOffset).getUint32(14)];
  const bit = (table, index) => {
    const chance = table[index];
    const bound = (range >>> 11) * chance;
    let one = 0;
    if (code < bound) {
      range = bound;
      table[index] = chance + ((2048 - chance) >>> 5);
    } else {
      range -= bound;
      code -= bound;
      table[index] = chance - (chance >>> 5);
      one = 1;
    }
    if (range < 0x1000000) {
      range = (range << 8) >>> 0;
      code = ((code << 8) | packed[at++]) >>> 0;
    }
    return one;
  };
  const direct = (count) => {
    let value = 0;
    while (count-- > 0) {
      range >>>= 1;
      const one = code >= range ? 1 : 0;
      if (one) code -= range;
      value = (value << 1) | one;
      if (range < 0x1000000) {
        range = (range << 8) >>> 0;
        code = ((code << 8) | packed[at++]) >>> 0;
      }
    }
    return value;
  };
  const tree = (table, bits, from = 0) => {
    let node = 1;
    for (let i = 0; i < bits; i++) node = (node << 1) | bit(table, from + node);
    return node - (1 << bits);
  };
  const reversed = (table, bits, from) => {
    let [node, value] = [1, 0];
    for (let i = 0; i < bits; i++) {
      const one = bit(table, from + node);
      node = (node << 1) | one;
      value |= one << i;
    }
    return value;
  };

  const literals = chances(0x300 << (lc + lp));
  const [isMatch, isRepeat, isRepeat0, isRepeat1, isRepeat2, isLong] = [192, 12, 12, 12, 12, 192].map(chances);
  const slots = chances(4 * 64);
  const middles = chances(128);
  const low = chances(16);
  const lengths = () => ({ choice: chances(2), low: chances(16 * 8), mid: chances(16 * 8), high: chances(256) });
  const [matchLength, repeatLength] = [lengths(), lengths()];
  const length = ({ choice, low, mid, high }, position) => {
    if (!bit(choice, 0)) return 2 + tree(low, 3, position * 8);
    if (!bit(choice, 1)) return 10 + tree(mid, 3, position * 8);
    return 18 + tree(high, 8);
  };

  let [state, place] = [0, 0];
  const distances = [0, 0, 0, 0];
  while (place < size) {
    const position = place & ((1 << pb) - 1);
    if (!bit(isMatch, state * 16 + position)) {
      const before = place ? out[place - 1] : 0;
      const from = 0x300 * (((place & ((1 << lp) - 1)) << lc) + (before >> (8 - lc)));
      let symbol = 1;
      if (state >= 7) {
        // After a match: the byte that would have gone on with it tells of this one.
        let matched = out[place - distances[0] - 1];
        do {
          const above = (matched >> 7) & 1;
          matched <<= 1;
          const one = bit(literals, from + ((1 + above) << 8) + symbol);
          symbol = (symbol << 1) | one;
          if (above !== one) break;
        } while (symbol < 256);
      }
      while (symbol < 256) symbol = (symbol << 1) | bit(literals, from + symbol);
      out[place++] = symbol;
      state = state < 4 ? 0 : state < 10 ? state - 3 : state - 6;
      continue;
    }
    let count;
    if (bit(isRepeat, state)) {
      if (!bit(isRepeat0, state)) {
        if (!bit(isLong, state * 16 + position)) {
          state = state < 7 ? 9 : 11;
          out[place] = out[place - distances[0] - 1];
          place++;
          continue;
        }
      } else {
        const which = !bit(isRepeat1, state) ? 1 : !bit(isRepeat2, state) ? 2 : 3;
        distances.unshift(...distances.splice(which, 1));
      }
      count = length(repeatLength, position);
      state = state < 7 ? 8 : 11;
    } else {
      count = length(matchLength, position);
      state = state < 7 ? 7 : 10;
      const slot = tree(slots, 6, 64 * Math.min(count - 2, 3));
      let distance = slot;
      if (slot >= 4) {
        const bits = (slot >> 1) - 1;
        distance = ((2 | (slot & 1)) << bits) >>> 0;
        if (slot < 14) distance += reversed(middles, bits, distance - slot);
        else distance = (distance + direct(bits - 4) * 16 + reversed(low, 4, 0)) >>> 0;
      }
      distances.unshift(distance);
      distances.pop();
    }
    for (const end = Math.min(place + count, size); place < end; place++) out[place] = out[place - distances[0] - 1];
  }
  return out;
}
