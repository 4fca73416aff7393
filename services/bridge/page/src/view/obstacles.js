/** HARD and SOFT columns as boxes of their height. */
import { Boxes } from './boxes.js';
import { rgb_of } from './colour_map.js';
import { FLAG, OBSTACLE_COLOURS, REMEMBERED } from './layers.js';

export const NOMINAL_M = 1;  // without voxels nobody knows how high an obstacle is
const FILLS = 0.9;           // of a column's width: neighbours stay apart to the eye
const HARD = rgb_of(OBSTACLE_COLOURS.hard).map((value) => value / 255);
const SOFT = rgb_of(OBSTACLE_COLOURS.soft).map((value) => value / 255);
const FADED = 0.6;

const faded = (tint) => tint.map((value) => 0.5 + FADED * (value - 0.5));
const TINTS = { hard: [HARD, faded(HARD)], soft: [SOFT, faded(SOFT)] };

export class Obstacles extends Boxes {
  /**
   * @param {import('../data/layer_map.js').LayerMap} map
   * @param {{x: number, y: number, z: number}} anchor_m
   * @param {import('../data/column_tops.js').ColumnTops | null} tops
   */
  show(map, anchor_m, tops) {
    const flags = map.layer('flags') ?? [];
    const height = map.layer('height');
    const visibility = map.layer('visibility');
    const marked = flags.length ? flags.reduce((sum, value) => sum + (value & (FLAG.hard | FLAG.soft) ? 1 : 0), 0) : 0;
    this.begin(marked, FILLS * map.cell_m);
    for (let i = 0; i < flags.length; ++i) {
      if (!(flags[i] & (FLAG.hard | FLAG.soft)) || Number.isNaN(height[i])) continue;
      const x = map.origin_m.x + ((i % map.columns) + 0.5) * map.cell_m;
      const y = map.origin_m.y + (Math.floor(i / map.columns) + 0.5) * map.cell_m;
      const top = tops?.top_m(x, y) ?? NaN;
      const tall = top > height[i] + 0.1 ? top - height[i] : NOMINAL_M;
      const tint = TINTS[flags[i] & FLAG.hard ? 'hard' : 'soft'][visibility?.[i] === REMEMBERED ? 1 : 0];
      this.add(x - anchor_m.x, y - anchor_m.y, height[i] - anchor_m.z, tall, tint);
    }
    this.end();
  }
}
