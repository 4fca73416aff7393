/** Perceptual colour maps out of control points, from low to high; each step is as large to the eye as the others. */

const CIVIDIS = ['#00224e', '#123570', '#3b496c', '#575d6d', '#707173', '#8a8678', '#a59c74', '#c3b369', '#e1cc55', '#fee838'];
const VIRIDIS = ['#440154', '#482878', '#3e4989', '#31688e', '#26828e', '#1f9e89', '#35b779', '#6ece58', '#b5de2b', '#fde725'];
const DIVERGING = ['#2166ac', '#4393c3', '#92c5de', '#d1e5f0', '#f7f7f7', '#fddbc7', '#f4a582', '#d6604d', '#b2182b'];

export const COLOUR_MAPS = { cividis: CIVIDIS, viridis: VIRIDIS, diverging: DIVERGING };

/** @param {string} hex like "#00224e" @returns {number[]} red, green, blue, 0 .. 255 */
export function rgb_of(hex) {
  return [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));
}

/** @param {string[]} points control points @param {number} part 0 .. 1 @returns {number[]} red, green, blue, 0 .. 255 */
export function colour_at(points, part) {
  const place = Math.min(1, Math.max(0, part)) * (points.length - 1);
  const below = Math.min(points.length - 2, Math.floor(place));
  const low = rgb_of(points[below]);
  const high = rgb_of(points[below + 1]);
  return low.map((value, i) => Math.round(value + (high[i] - value) * (place - below)));
}

/** RGBA bytes of a table of `length` colours. */
export function colour_table(points, length = 256) {
  const table = new Uint8Array(4 * length);
  for (let i = 0; i < length; ++i) table.set([...colour_at(points, i / (length - 1)), 255], 4 * i);
  return table;
}

/** The same colours for CSS. */
export function css_gradient(points) {
  return `linear-gradient(to right, ${points.join(', ')})`;
}
