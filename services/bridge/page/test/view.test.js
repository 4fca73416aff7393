import assert from 'node:assert/strict';
import test from 'node:test';
import { COLOUR_MAPS, colour_at, colour_table } from '../src/view/colour_map.js';
import { LAYER_STYLES, style_of, usual_range } from '../src/view/layers.js';

/** Lightness as the eye has it, 0 .. 100, of CIE L*a*b*. */
function lightness(rgb) {
  const [r, g, b] = rgb.map((value) => value / 255).map((c) => (c > 0.04045 ? ((c + 0.055) / 1.055) ** 2.4 : c / 12.92));
  const y = 0.2126 * r + 0.7152 * g + 0.0722 * b;
  return y > 0.008856 ? 116 * Math.cbrt(y) - 16 : 903.3 * y;
}

test('sequential maps grow lighter evenly: they can be read in grey, too', () => {
  for (const name of ['cividis', 'viridis']) {
    const steps = Array.from({ length: 33 }, (_, i) => lightness(colour_at(COLOUR_MAPS[name], i / 32)));
    const rises = steps.slice(1).map((value, i) => value - steps[i]);
    assert.ok(Math.min(...rises) > 0.5, `${name} rises by ${Math.min(...rises)}`);
    assert.ok(Math.max(...rises) < 5, `${name} jumps by ${Math.max(...rises)}`);
  }
});

test('a table begins and ends with the map\'s ends', () => {
  const table = colour_table(COLOUR_MAPS.cividis);
  assert.deepEqual([...table.subarray(0, 4)], [0x00, 0x22, 0x4e, 255]);
  assert.deepEqual([...table.subarray(-4)], [0xfe, 0xe8, 0x38, 255]);
});

test('the usual range leaves out single extremes and what is unknown', () => {
  const values = Float32Array.from({ length: 1000 }, (_, i) => (i % 3 ? NaN : i / 1000));
  values[0] = -500;
  const [low, high] = usual_range(values);
  assert.ok(low > 0 && low < 0.05 && high > 0.9 && high < 1);
  assert.equal(usual_range(Float32Array.of(NaN, 1)), null);
});

test('flags are shown by what matters most', () => {
  const { category_of, categories } = LAYER_STYLES.flags;
  const word = (flags) => categories[category_of(flags)].label;
  assert.deepEqual([0, 1, 2, 3, 4, 8, 12, 16, 32].map(word),
    ['none', 'hard', 'soft', 'hard', 'hole', 'steep', 'hole', 'assumed', 'none']);
});

test('a layer that the page has not heard of is shown all the same', () => {
  assert.deepEqual(style_of('wet_ground'), { title: 'wet ground', unit: '', map: 'viridis' });
});
