/** Numbers of 16 bits (IEEE binary16), to keep maps in half their memory. */

const float = new Float32Array(1);
const bits_of_float = new Uint32Array(float.buffer);

/** @returns {number} the bits of the nearest half; beyond 65504 infinity */
export function half_of(value) {
  float[0] = value;
  const bits = bits_of_float[0];
  const sign = (bits >>> 16) & 0x8000;
  const exponent = ((bits >>> 23) & 0xff) - 112;
  const fraction = bits & 0x7fffff;
  if (Number.isNaN(value)) return 0x7e00;
  if (exponent >= 31) return sign | 0x7c00;
  if (exponent < -10) return sign;
  if (exponent <= 0) {
    const shift = 14 - exponent;
    const whole = fraction | 0x800000;
    return sign | ((whole >>> shift) + ((whole >>> (shift - 1)) & 1));
  }
  return sign | (((exponent << 10) | (fraction >>> 13)) + ((fraction >>> 12) & 1));
}

function float_of(half) {
  const sign = half & 0x8000 ? -1 : 1;
  const exponent = (half >>> 10) & 31;
  const fraction = half & 0x3ff;
  if (exponent === 0) return sign * fraction * 2 ** -24;
  if (exponent === 31) return fraction ? NaN : sign * Infinity;
  return sign * (1 + fraction / 1024) * 2 ** (exponent - 15);
}

const FLOATS = Float32Array.from({ length: 65536 }, (_, half) => float_of(half));

/** @param {ArrayLike<number>} values @param {number} zero subtracted first, so that what is near it is kept finely */
export function pack_halves(values, zero = 0) {
  const halves = new Uint16Array(values.length);
  for (let i = 0; i < values.length; ++i) halves[i] = half_of(values[i] - zero);
  return halves;
}

export function unpack_halves(halves, zero = 0) {
  const values = new Float32Array(halves.length);
  for (let i = 0; i < halves.length; ++i) values[i] = FLOATS[halves[i]] + zero;
  return values;
}
