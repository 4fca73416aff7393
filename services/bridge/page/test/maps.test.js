import assert from 'node:assert/strict';
import test from 'node:test';
import { setFlagsFromString } from 'node:v8';
import { runInNewContext } from 'node:vm';
import { cloud_field } from '../src/data/cloud.js';
import { column_tops, layer_step_m } from '../src/data/column_tops.js';
import { half_of, pack_halves, unpack_halves } from '../src/data/half.js';
import { layer_map_of, value_at } from '../src/data/layer_map.js';
import { pack_map, packed_bytes } from '../src/data/packed_map.js';
import { pose_of } from '../src/data/pose.js';
import { reader_of } from '../src/wire/schema.js';
import { SCHEMAS } from '../mock/schemas.js';
import { cloud_message, grid_message, tf_message } from '../mock/messages.js';

const read = (type, bytes) => reader_of(type, SCHEMAS[type])(bytes);

const grid = (height, flags) => read('foxglove_msgs/msg/Grid', grid_message({
  stamp_s: 5, origin_m: [10, 20, 0], cell_m: 0.5, size: 2,
  layers: new Map([['height', Float32Array.from(height)], ['flags', Uint8Array.from(flags)]]) }));

test('layers of a grid are taken by name, [y][x] from its corner', () => {
  const map = layer_map_of(grid([1, 2, NaN, 4], [0, 1, 2, 4]));
  assert.deepEqual([map.columns, map.rows, map.cell_m, map.frame], [2, 2, 0.5, 'odom']);
  assert.deepEqual([...map.layer('height')], [1, 2, NaN, 4]);
  assert.deepEqual([...map.layer('flags')], [0, 1, 2, 4]);
  assert.equal(map.layer('clearance'), undefined);
  assert.equal(value_at(map, 'height', 10.7, 20.1), 2);
  assert.equal(value_at(map, 'height', 10.7, 20.9), 4);
  assert.ok(Number.isNaN(value_at(map, 'height', 9.9, 20.1)));
});

test('a grid whose numbers do not fit is refused, whatever they say', () => {
  const good = grid([1, 2, 3, 4], [0, 0, 0, 0]);
  assert.throws(() => layer_map_of({ ...good, column_count: 3000 }), /1 to 2048/);
  assert.throws(() => layer_map_of({ ...good, row_stride: 0, cell_stride: 0 }), /1 to 2048/);
  assert.throws(() => layer_map_of({ ...good, column_count: 3 }), /3 x 2 columns in 32 bytes/);
  assert.throws(() => layer_map_of({ ...good, cell_size: { x: 0, y: 0 } }), /no size/);
  assert.throws(() => layer_map_of({ ...good, fields: [{ name: 'height', offset: 6, type: 7 }] }).layer('height'), /at 6 of 8/);
  assert.throws(() => layer_map_of({ ...good, fields: [{ name: 'height', offset: 0, type: 99 }] }).layer('height'), /type 99/);
});

test('halves keep NaN, infinity, small and large numbers', () => {
  assert.equal(half_of(1), 0x3c00);
  assert.equal(half_of(-2), 0xc000);
  assert.equal(half_of(65504), 0x7bff);
  assert.equal(half_of(1e6), 0x7c00);
  assert.equal(half_of(2 ** -24), 1);
  const values = [0, 1e-5, -0.001, 0.3333, 3.75, -40.2, Infinity, -Infinity, NaN];
  unpack_halves(pack_halves(values)).forEach((value, i) => {
    if (Number.isFinite(values[i])) assert.ok(Math.abs(value - values[i]) <= Math.max(3e-8, Math.abs(values[i]) / 2047));
    else assert.equal(value, values[i]);
  });
});

test('a packed map is the same to a few millimetres near the vehicle, however high that is', () => {
  const map = layer_map_of(grid([2000.123, 2003.9, NaN, 1999], [1, 2, 4, 8]));
  const packed = pack_map(map, 2001);
  assert.equal(packed_bytes(map), 4 * 2 * 2);
  const height = packed.layer('height');
  [2000.123, 2003.9, NaN, 1999].forEach((value, i) =>
    assert.ok(Number.isNaN(value) ? Number.isNaN(height[i]) : Math.abs(height[i] - value) < 0.002));
  assert.deepEqual([...packed.layer('flags')], [1, 2, 4, 8]);
  assert.equal(packed.layer('cost'), undefined);
});

test('fields of a cloud are taken by name; a cloud that is too short is refused', () => {
  const cloud = read('sensor_msgs/msg/PointCloud2', cloud_message(1, ['x', 'density'], Float32Array.of(1, 0.5, 2, 0.25)));
  assert.deepEqual([...cloud_field(cloud, 'density')], [0.5, 0.25]);
  assert.equal(cloud_field(cloud, 'ring'), null);
  assert.throws(() => cloud_field({ ...cloud, width: 3 }, 'x'), /3 x 1 points in 16 bytes/);
  assert.throws(() => cloud_field({ ...cloud, height: 1e9, row_step: 0 }, 'x'), /points in 16 bytes/);
  assert.equal(cloud_field({ ...cloud, width: 0 }, 'x').length, 0);
});

test('an obstacle reaches as high as voxels stand on its ground; a crown above a gap is not of it', () => {
  const map = layer_map_of(grid([0, 0, NaN, 0], [1, 2, 0, 0]));
  const voxels = [[10.2, 20.2, 0.25], [10.2, 20.2, 0.75], [10.2, 20.2, 1.75], [10.7, 20.2, 0.25], [10.7, 20.2, 5.25], [10.2, 20.7, 0.25]];
  const cloud = read('sensor_msgs/msg/PointCloud2', cloud_message(1, ['x', 'y', 'z'], Float32Array.from(voxels.flat())));
  assert.equal(layer_step_m(cloud_field(cloud, 'z')), 0.5);
  const tops = column_tops(cloud, map);
  assert.equal(tops.top_m(10.2, 20.2), 2);    // one layer without a hit is no gap
  assert.equal(tops.top_m(10.7, 20.2), 0.5);  // a crown is
  assert.ok(Number.isNaN(tops.top_m(10.2, 20.7)));
  assert.ok(Number.isNaN(tops.top_m(10.7, 20.7)));
});

test('the vehicle is the base of the map\'s frame', () => {
  const tf = read('tf2_msgs/msg/TFMessage', tf_message(1, { x: 1, y: 2, z: 3, yaw_rad: 0.7 }));
  const pose = pose_of(tf, 'odom');
  assert.ok(Math.abs(pose.yaw_rad - 0.7) < 1e-12);
  assert.deepEqual([pose.x, pose.y, pose.z], [1, 2, 3]);
  assert.equal(pose_of(tf, 'map'), null);
});

/** Whether what `make` returns keeps nothing of what it says that was in its hands. */
async function lets_go_of(make) {
  setFlagsFromString('--expose-gc');
  const gc = runInNewContext('gc');
  const { made, held } = make();
  for (let i = 0; i < 5; ++i) {
    await new Promise((done) => setTimeout(done, 1));
    gc();
  }
  assert.ok(made);
  return held.map((reference) => reference.deref() === undefined);
}

test('a packed map, and the tops of columns, keep nothing of the messages that they came in', async () => {
  assert.deepEqual(await lets_go_of(() => {
    const message = grid([1, 2, NaN, 4], [0, 1, 2, 4]);
    const map = layer_map_of(message);
    return { made: pack_map(map, 0), held: [new WeakRef(message), new WeakRef(map)] };
  }), [true, true]);
  assert.deepEqual(await lets_go_of(() => {
    const map = layer_map_of(grid([0, 0, 0, 0], [0, 0, 0, 0]));
    const cloud = read('sensor_msgs/msg/PointCloud2', cloud_message(5, ['x', 'y', 'z'], Float32Array.from([10.2, 20.2, 0.4])));
    return { made: column_tops(cloud, map), held: [new WeakRef(map), new WeakRef(cloud)] };
  }), [true, true]);
});
