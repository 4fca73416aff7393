/** Occupied voxels as boxes, coloured by their density where the cloud has it. */
import { cloud_field } from '../data/cloud.js';
import { layer_step_m } from '../data/column_tops.js';
import { Boxes } from './boxes.js';
import { COLOUR_MAPS, colour_at } from './colour_map.js';

const FILLS = 0.86;
const MOST = 200000;
const TINTS = Array.from({ length: 65 }, (_, i) => colour_at(COLOUR_MAPS.viridis, i / 64).map((value) => value / 255));

export class Voxels extends Boxes {
  /** @param {object} cloud sensor_msgs/msg/PointCloud2 of centres @param {number} cell_m their width */
  show(cloud, anchor_m, cell_m) {
    const [x, y, z] = ['x', 'y', 'z'].map((name) => cloud_field(cloud, name));
    const density = cloud_field(cloud, 'density');
    const count = Math.min(MOST, x.length);
    const tall_m = FILLS * layer_step_m(z);
    this.begin(count, FILLS * cell_m);
    for (let i = 0; i < count; ++i) {
      const tint = TINTS[Math.round(64 * Math.min(1, Math.max(0, density?.[i] ?? 0.5)))] ?? TINTS[0];
      this.add(x[i] - anchor_m.x, y[i] - anchor_m.y, z[i] - anchor_m.z - tall_m / 2, tall_m, tint);
    }
    this.end();
    this.left_out = x.length - count;
  }
}
