/** What the colours mean, in units; which layer and what else is shown. */
import { COLOUR_MAPS, css_gradient } from '../view/colour_map.js';
import { LAYER_STYLES, OBSTACLE_COLOURS, style_of } from '../view/layers.js';
import { NOMINAL_M } from '../view/obstacles.js';
import { element, find } from './dom.js';

const SWITCHES = { obstacles: 'Obstacles', ways: 'Path', voxels: 'Voxels' };
const KEY = { hard: 'hard', soft: 'soft', hole: 'hole', steep: 'steep' };

function digits_of(low, high) {
  const span = Math.abs(high - low);
  return span >= 20 ? 0 : span >= 1 ? 1 : span >= 0.1 ? 2 : 3;
}

function show_scale(style, range) {
  const scale = style.scale ?? 1;
  const [low, high] = (range ?? [0, 1]).map((value) => value * scale);
  const ticks = [low, (low + high) / 2, high].map((value) => element('span', '', value.toFixed(digits_of(low, high)).replace(/^-(?=[0.]*$)/, '')));
  const bar = element('div', 'gradient');
  bar.style.background = css_gradient(COLOUR_MAPS[style.map]);
  find('scale').replaceChildren(bar, element('div', 'ticks', ...ticks));
}

const swatch = (colour, label, shape) => {
  const mark = element('i', shape);
  mark.style.setProperty('--colour', colour);
  return element('span', 'swatch', mark, label);
};

/** @param {string} layer @param {[number, number] | null} range in the layer's own unit */
export function show_range(layer, range) {
  const style = style_of(layer);
  if (style.categories) {
    const swatches = style.categories.map(({ label, colour }) => swatch(colour, label, 'square'));
    find('scale').replaceChildren(element('div', 'categories', ...swatches));
  } else show_scale(style, range);
}

/** @param {string[]} offered layers of the map @param {string} chosen */
export function show_layers(offered, chosen) {
  const known = Object.keys(LAYER_STYLES).filter((name) => offered.includes(name));
  const names = [...known, ...offered.filter((name) => !known.includes(name))];
  const options = names.map((name) => {
    const { title, unit } = style_of(name);
    const option = element('option', '', unit ? `${title}, ${unit}` : title);
    option.value = name;
    return option;
  });
  find('layer').replaceChildren(...options);
  find('layer').value = chosen;
}

/** @param {{obstacles: boolean, ways: boolean, voxels: boolean}} shows @param {(what: string, is_shown: boolean) => void} on_switch */
export function make_key(shows, on_switch) {
  const switches = Object.entries(SWITCHES).map(([what, label]) => {
    const box = element('input');
    box.type = 'checkbox';
    box.checked = shows[what];
    box.addEventListener('change', () => on_switch(what, box.checked));
    return element('label', 'switch', box, label);
  });
  const swatches = Object.entries(KEY).map(([name, label]) => swatch(OBSTACLE_COLOURS[name], label, name));
  find('key').replaceChildren(element('div', 'swatches', ...swatches), element('div', 'switches', ...switches));
}

/** @param {boolean} heights_known whether voxels say how high obstacles are @param {number | null} left_out voxels that are not drawn, null: none is */
export function show_note(heights_known, left_out) {
  const notes = ['Lines every 10 m. Paler: remembered, not seen now.'];
  if (!heights_known) notes.push(`Obstacles are drawn ${NOMINAL_M} m high: only voxels know their height.`);
  if (left_out !== null) notes.push('Voxels: the lighter, the denser.');
  if (left_out > 0) notes.push(`${left_out} of them are not drawn.`);
  find('note').textContent = notes.join(' ');
}
