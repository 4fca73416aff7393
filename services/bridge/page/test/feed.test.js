import assert from 'node:assert/strict';
import test from 'node:test';
import { clock_s, Feed } from '../src/feed.js';
import { reader_of } from '../src/wire/schema.js';
import { SCHEMAS } from '../mock/schemas.js';
import { cloud_message, grid_message } from '../mock/messages.js';

const read = (type, bytes) => reader_of(type, SCHEMAS[type])(bytes);
const WAY = { poses: [{ pose: { position: { x: 1, y: 2, z: 0 } } }] };
const GRID = read('foxglove_msgs/msg/Grid', grid_message({
  stamp_s: 5, origin_m: [10, 20, 0], cell_m: 0.5, size: 2,
  layers: new Map([['height', new Float32Array(4)], ['flags', new Uint8Array(4)]]) }));
const CLOUD = read('sensor_msgs/msg/PointCloud2',
  cloud_message(5, ['x', 'y', 'z'], Float32Array.from([10.2, 20.2, 0.4, 10.2, 20.2, 0.8])));

/** A feed that nobody answers, after these messages. */
function fed(t, messages) {
  globalThis.navigator ??= {};
  globalThis.WebSocket = class { close() {} };
  const feed = new Feed('ws://x', { on_map: () => {}, on_status: () => {} });
  t.after(() => feed.connection.close());
  for (const [topic, message] of messages) feed.on_message(topic, message, 5_000_000_000n);
  return feed;
}

test('a planner that says nothing for a second has no way, be it the plan or the trajectory', (t) => {
  const feed = fed(t, [['/gvom/plan', WAY], ['/gvom/trajectory', WAY]]);
  const came_s = clock_s();
  const { plan, trajectory } = feed.view(came_s + 0.9);
  assert.deepEqual([plan.length, trajectory.length], [1, 1]);
  const later = feed.view(came_s + 1.1);
  assert.deepEqual([later.plan, later.trajectory], [[], []]);
});

test('voxels that are wanted are shown for three seconds, and none that are not wanted', (t) => {
  const feed = fed(t, [['/gvom/layers', GRID]]);
  feed.set_wanted(false, true);
  feed.on_message('/gvom/voxels', CLOUD, 5_000_000_000n);
  const came_s = clock_s();
  assert.equal(feed.view(came_s + 2.9).cloud, CLOUD);
  assert.ok(feed.view(came_s + 2.9).tops);
  assert.deepEqual([feed.view(came_s + 3.1).cloud, feed.view(came_s + 3.1).tops], [null, null]);
  feed.set_wanted(false, false);
  assert.equal(feed.view(came_s).cloud, null);
});

test('a status that stopped coming is told by how long it is silent', (t) => {
  const feed = fed(t, [['/gvom/status', { vehicle: 'warthog', layers: { age_s: 0.1 } }]]);
  const { status, status_silent_s } = feed.circumstances(clock_s() + 4);
  assert.equal(status.vehicle, 'warthog');
  assert.ok(status_silent_s > 3.9 && status_silent_s < 5, `${status_silent_s}`);
});

test('that a tab was hidden is the reason until a map comes, and for three seconds at most', (t) => {
  const feed = fed(t, []);
  const says_so = (now_s) => feed.circumstances(now_s).was_hidden;
  assert.equal(says_so(clock_s()), false);
  feed.set_wanted(true, false);
  feed.set_wanted(false, false);
  const shown_s = clock_s();
  assert.equal(says_so(shown_s + 2.5), true);
  assert.equal(says_so(shown_s + 3.5), false);
  feed.on_message('/gvom/layers', GRID, 5_000_000_000n);
  assert.equal(says_so(shown_s + 1), false);
});
