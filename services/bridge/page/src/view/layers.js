/** How each layer is shown: its name for people, its unit, its range and its colours. */

const DEGREES = 180 / Math.PI;

export const OBSTACLE_COLOURS = { hard: '#e5482d', soft: '#38b48b', hole: '#d653c9', steep: '#ff9d2e' };
export const FLAG = { hard: 1, soft: 2, negative: 4, steep: 8, assumed: 16 };
export const REMEMBERED = 4;  // of the layer visibility

const VISIBILITIES = [
  { label: 'unobserved', colour: '#3a3f45' },
  { label: 'only free', colour: '#4aa3df' },
  { label: 'ground assumed', colour: '#8b7fd1' },
  { label: 'ground seen', colour: '#e9d66b' },
  { label: 'remembered', colour: '#9b9b93' },
];
const FLAGS = [
  { label: 'none', colour: '#8d9299', is: (flags) => flags === 0 },
  { label: 'hard', colour: OBSTACLE_COLOURS.hard, is: (flags) => flags & FLAG.hard },
  { label: 'soft', colour: OBSTACLE_COLOURS.soft, is: (flags) => flags & FLAG.soft },
  { label: 'hole', colour: OBSTACLE_COLOURS.hole, is: (flags) => flags & FLAG.negative },
  { label: 'steep', colour: OBSTACLE_COLOURS.steep, is: (flags) => flags & FLAG.steep },
  { label: 'assumed', colour: '#5a7fa8', is: (flags) => flags & FLAG.assumed },
];

/** The category of flags that matters most: hard before soft before hole and so on. */
function category_of_flags(flags) {
  const found = FLAGS.findIndex(({ is }) => is(flags));
  return found < 0 ? 0 : found;
}

/**
 * @typedef {object} LayerStyle
 * @property {string} title
 * @property {string} unit
 * @property {number} [scale] what a value is multiplied by for people
 * @property {[number, number]} [range] in the layer's own unit; without it, of what is there
 * @property {'cividis' | 'viridis' | 'diverging'} [map]
 * @property {{label: string, colour: string}[]} [categories] in place of a colour map
 * @property {(value: number) => number} [category_of] the index in it; without it the value itself
 * @property {number} [unknown] a value that means unknown, besides NaN
 */

/** @type {Record<string, LayerStyle>} */
export const LAYER_STYLES = {
  height: { title: 'Height', unit: 'm', map: 'cividis' },
  inferred_height: { title: 'Inferred height', unit: 'm', map: 'cividis' },
  slope: { title: 'Slope', unit: '°', scale: DEGREES, range: [0, 40 / DEGREES], map: 'viridis' },
  slope_x: { title: 'Slope along x', unit: 'm/m', range: [-0.6, 0.6], map: 'diverging' },
  slope_y: { title: 'Slope along y', unit: 'm/m', range: [-0.6, 0.6], map: 'diverging' },
  roughness: { title: 'Roughness', unit: 'm²', range: [0, 0.02], map: 'viridis' },
  obstacle_density: { title: 'Obstacle density', unit: '', range: [0, 1], map: 'viridis' },
  negative_delta: { title: 'Depth of holes', unit: 'm', range: [0, 2], map: 'viridis' },
  clearance: { title: 'Clearance', unit: 'm', range: [0, 5], map: 'viridis' },
  last_seen: { title: 'Last seen', unit: 's ago', range: [0, 5], map: 'viridis' },
  cost: { title: 'Cost', unit: '', range: [0, 254], map: 'viridis', unknown: 255 },
  visibility: { title: 'Visibility', unit: '', categories: VISIBILITIES },
  flags: { title: 'Flags', unit: '', categories: FLAGS, category_of: category_of_flags },
};

/** What is shown of a layer that this page has not heard of. @returns {LayerStyle} */
export function style_of(name) {
  return LAYER_STYLES[name] ?? { title: name.replaceAll('_', ' '), unit: '', map: 'viridis' };
}

/**
 * @param {ArrayLike<number>} values
 * @returns {[number, number] | null} from the 2nd to the 98th of 100 known ones; null if too few are known
 */
export function usual_range(values) {
  const step = Math.max(1, Math.floor(values.length / 6000));
  const known = [];
  for (let i = 0; i < values.length; i += step) if (Number.isFinite(values[i])) known.push(values[i]);
  if (known.length < 8) return null;
  known.sort((a, b) => a - b);
  const low = known[Math.floor(0.02 * known.length)];
  const high = known[Math.floor(0.98 * known.length)];
  return [low, Math.max(high, low + 0.5)];
}
