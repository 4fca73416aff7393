// What must be true of the messages of a drive, by values computed here from other messages.
import assert from 'node:assert/strict';
import { cloud_fields, grid_layers, stamp_ns } from './decode.js';

/** Nav2's table: a cost of 0 .. 255 as an occupancy of -1 .. 100. */
function occupancy(cost) {
  if (cost === 255) return -1;
  if (cost === 254) return 100;
  if (cost === 253) return 99;
  return cost === 0 ? 0 : 1 + Math.floor((97 * (cost - 1)) / 251);
}

/** A costmap (OccupancyGrid) against all layers (foxglove_msgs/Grid) of the same moment. */
export function check_costmap(costmap, grid, size_xy) {
  const { info } = costmap;
  assert.equal(info.width, size_xy);
  assert.equal(info.height, size_xy);
  assert.equal(grid.column_count, size_xy);
  assert.equal(info.resolution, Math.fround(grid.cell_size.x));
  assert.deepEqual(info.origin, grid.pose);
  assert.equal(costmap.header.frame_id, 'odom');
  assert.deepEqual([...costmap.data], grid_layers(grid).cost.map(occupancy));
  const kinds = new Set(costmap.data);
  assert.ok(kinds.has(-1) && kinds.size > 3, `a drive has seen something, but not all: ${[...kinds]}`);
}

/** A cloud of columns (PointCloud2) against the same: one point for each column with a height, at its centre. */
export function check_points(cloud, grid) {
  const layers = grid_layers(grid);
  const { position } = grid.pose;
  const wanted = { x: [], y: [], z: [], cost: [] };
  layers.height.forEach((height, i) => {
    if (Number.isNaN(height)) return;
    const [column, row] = [i % grid.column_count, Math.floor(i / grid.column_count)];
    wanted.x.push(position.x + (column + 0.5) * grid.cell_size.x);
    wanted.y.push(position.y + (row + 0.5) * grid.cell_size.y);
    wanted.z.push(height);
    wanted.cost.push(layers.cost[i]);
  });
  const got = cloud_fields(cloud);
  assert.ok(wanted.x.length > 100, `${wanted.x.length} columns with a height`);
  for (const name of ['z', 'cost']) assert.deepEqual(got[name], wanted[name], name);
  for (const name of ['x', 'y']) {
    assert.equal(got[name].length, wanted[name].length);
    assert.ok(got[name].every((at_m, i) => Math.abs(at_m - wanted[name][i]) < 1e-4), name);
  }
}

/** A GridMap's first two layers, height and cost, from the corner of greatest x and y on. */
export function check_grid_map(map, grid) {
  const layers = grid_layers(grid);
  assert.deepEqual(map.layers, ['height', 'cost']);
  assert.deepEqual(Array.from(map.data[0].data), layers.height.reverse());
  assert.deepEqual(Array.from(map.data[1].data), layers.cost.reverse());
}

/** A cloud of voxels lies within the grid, and each has a density in (0, 1]. */
export function check_voxels(cloud, grid) {
  const { x, y, density } = cloud_fields(cloud);
  assert.ok(x.length > 100, `${x.length} voxels`);
  const size_m = grid.column_count * grid.cell_size.x;
  for (const [along, from_m] of [[x, grid.pose.position.x], [y, grid.pose.position.y]]) {
    assert.ok(along.every((at_m) => at_m > from_m && at_m < from_m + size_m), 'voxels within the grid');
  }
  assert.ok(density.every((value) => value > 0 && value <= 1), 'densities');
}

/** The vehicle's pose: it drives within the grid. */
export function check_tf(message, grid) {
  const [transform] = message.transforms;
  assert.equal(transform.header.frame_id, 'odom');
  assert.equal(transform.child_frame_id, 'base_link');
  const { x, y } = transform.transform.translation;
  const size_m = grid.column_count * grid.cell_size.x;
  const centre = { x: grid.pose.position.x + size_m / 2, y: grid.pose.position.y + size_m / 2 };
  assert.ok(Math.hypot(x - centre.x, y - centre.y) < size_m / 4, `at ${x}, ${y}; the grid's centre ${centre.x}, ${centre.y}`);
}

/** All of our processes say how they are, in words. */
export function check_diagnostics(message, processes) {
  const status = new Map(message.status.map((one) => [one.name, one]));
  for (const name of processes) {
    const one = status.get(name);
    assert.ok(one, `${name} in ${[...status.keys()]}`);
    assert.ok(one.message.length > 0 && one.level <= 3);
    const values = new Map(one.values.map(({ key, value }) => [key, value]));
    assert.match(values.get('version'), /^\d+\.\d+\.\d+/);
    assert.match(values.get('rate_hz'), /^\d+\.\d{3}$/);
  }
}

/** For each message of `messages` its partner of the same stamp in `grids`; those that have none are left out. */
export function with_grid(messages, grids) {
  const by_stamp = new Map(grids.map((grid) => [stamp_ns(grid.timestamp), grid]));
  const pairs = messages.map((message) => [message, by_stamp.get(stamp_ns(message.header.stamp))]);
  return pairs.filter(([, grid]) => grid !== undefined);
}
