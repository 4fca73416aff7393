/** How high what stands in a column reaches, out of the occupied voxels. */
import { cloud_field } from './cloud.js';

const GAP_LAYERS = 2.5;  // one layer without a hit is still the same thing

/** The distance between layers of voxels: the least that is not next to nothing. */
export function layer_step_m(z) {
  const some = [...new Set(Array.from(z.subarray(0, 4000), (value) => Math.round(value * 1000)))].sort((a, b) => a - b);
  const steps = some.slice(1).map((value, i) => value - some[i]).filter((step) => step > 10);
  return steps.length ? Math.min(...steps) / 1000 : 0.4;
}

/** Apart from column_tops(), which has the cloud and the map: what it makes must not keep them. */
function index_in({ columns, rows, cell_m, origin_m }) {
  return (x_m, y_m) => {
    const column = Math.floor((x_m - origin_m.x) / cell_m);
    const row = Math.floor((y_m - origin_m.y) / cell_m);
    return column >= 0 && row >= 0 && column < columns && row < rows ? row * columns + column : -1;
  };
}

function lookup(tops, index_of) {
  return { top_m: (x_m, y_m) => tops[index_of(x_m, y_m)] ?? NaN };
}

/**
 * @typedef {object} ColumnTops
 * @property {(x_m: number, y_m: number) => number} top_m in odom: the upper face of the highest voxel that stands on the
 *   column's ground without a gap of more than a layer; NaN where nothing does
 */

/**
 * @param {object} cloud sensor_msgs/msg/PointCloud2 of the centres of occupied voxels, fields x, y, z
 * @param {import('./layer_map.js').LayerMap} map the ground that they stand on
 * @returns {ColumnTops}
 */
export function column_tops(cloud, map) {
  const [x, y, z] = ['x', 'y', 'z'].map((name) => cloud_field(cloud, name));
  const ground = map.layer('height');
  const step_m = layer_step_m(z);
  const tops = new Float32Array(map.columns * map.rows).fill(NaN);
  const index_of = index_in(map);
  for (const i of Uint32Array.from(z.keys()).sort((a, b) => z[a] - z[b])) {
    const at = index_of(x[i], y[i]);
    if (at < 0 || Number.isNaN(ground[at])) continue;
    const below = Number.isNaN(tops[at]) ? ground[at] + step_m / 2 : tops[at] - step_m / 2;
    if (z[i] - below <= GAP_LAYERS * step_m) tops[at] = z[i] + step_m / 2;
  }
  return lookup(tops, index_of);
}
