// All messages of a drive, decoded, by topic.
import assert from 'node:assert/strict';
import * as checks from './drive_checks.js';

/** Those that say how they are, at least. */
export const PROCESSES = ['gvom-fusion', 'gvom-ingest-front', 'gvom-odometry', 'gvom-bridge'];

/** Topics that a drive without a planner has. `checks` decide about one message each, with the grid of its moment. */
const OF_LAYERS = {
  '/gvom/costmap': checks.check_costmap,
  '/gvom/points': checks.check_points,
  '/gvom/grid_map': checks.check_grid_map,
};

/**
 * Throws unless `messages`, a Map of a topic's name to its decoded messages, are those of a drive in a grid of
 * size_xy x size_xy columns. Every topic of `topics` must be there; the first and the last message of it are looked at.
 */
export function check_drive(messages, topics, size_xy) {
  for (const topic of topics) assert.ok(messages.get(topic)?.length > 0, `${topic} has no message`);
  const grids = messages.get('/gvom/layers');
  for (const topic of topics.filter((one) => one in OF_LAYERS)) {
    const pairs = checks.with_grid(messages.get(topic), grids);
    assert.ok(pairs.length > 0, `${topic}: no message of a moment that /gvom/layers is of`);
    for (const [message, grid] of [pairs[0], pairs.at(-1)]) OF_LAYERS[topic](message, grid, size_xy);
  }
  const newest = grids.at(-1);
  checks.check_voxels(messages.get('/gvom/voxels').at(-1), newest);
  checks.check_tf(messages.get('/tf').at(-1), newest);
  if (topics.includes('/diagnostics')) checks.check_diagnostics(messages.get('/diagnostics').at(-1), PROCESSES);
  if (topics.includes('/gvom/status')) assert.equal(messages.get('/gvom/status').at(-1).lidars[0].name, 'front');
}
