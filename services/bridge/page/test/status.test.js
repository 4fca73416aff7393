import assert from 'node:assert/strict';
import test from 'node:test';
import { status_of } from '../src/data/status.js';
import { status_json } from '../mock/status.js';

test('all is well if all say so', () => {
  const status = status_of(status_json({ age_s: 0.05, rear: true, fusion: true }));
  assert.deepEqual(status.problems, []);
  assert.deepEqual(status.missing, []);
  assert.equal(status.processes[1].stages[0].p99_ms, 6);
});

test('problems in words: who, what, and the reason', () => {
  const status = status_of(status_json({ age_s: 3.2, rear: false, fusion: false }));
  assert.deepEqual(status.problems, [
    'gvom-fusion is failed: has said nothing for 3 s',
    'gvom-ingest-rear is degraded: no packets for 6.0 s',
    'lidar rear is missing in the layers',
    'the newest layers are 3.2 s old']);
  assert.deepEqual(status.missing, ['rear']);
});

test('what never came, or is old, or half, is not well', () => {
  const problems_of = (changed) => status_of({ ...status_json({ age_s: 0.05, rear: true, fusion: true }), ...changed }).problems;
  assert.deepEqual(problems_of({ layers: null }), ['no layers came']);
  assert.deepEqual(problems_of({ layers: { age_s: null } }), ['the newest layers are of unknown age']);
  assert.deepEqual(problems_of({ odometry: null }), ['no odometry came']);
  assert.deepEqual(problems_of({ odometry: { age_s: 61 } }), ['the newest odometry is 61.0 s old']);
  assert.deepEqual(problems_of({ lidars: [{ name: 'front', columns_seen_fraction: 0.5 }] }),
    ["lidar front's newest sweep has 50 % of its columns"]);
});

test('what the bridge says itself of its problems is taken', () => {
  assert.deepEqual(status_of({ problems: ['no odometry came'] }).problems, ['no odometry came']);
});

test('lidars may be listed by name as gvomctl does', () => {
  const status = status_of({ layers: { age_s: 0.1, lidars: { top: { missing: true } } } });
  assert.deepEqual(status.missing, ['top']);
  assert.equal(status.layers_age_s, 0.1);
});

test('nothing at all is a status too', () => {
  const status = status_of({});
  assert.deepEqual([status.processes, status.lidars, status.problems, status.layers_age_s], [[], [], [], null]);
  assert.equal(status_of({ processes: [{}] }).processes[0].state, 'unknown');
});

test('a silent process has no reason: what it said last is old', () => {
  assert.deepEqual(status_of({ processes: [{ name: 'gvom-fusion', state: 'silent', reason: 'as configured' }] }).problems,
    ['gvom-fusion is silent']);
});
