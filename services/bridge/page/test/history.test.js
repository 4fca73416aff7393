import assert from 'node:assert/strict';
import test from 'node:test';
import { History } from '../src/data/history.js';

/** Offers an entry of `bytes` ten times a second. */
function fill(history, seconds, bytes) {
  let kept = 0;
  for (let i = 0; i < 10 * seconds; ++i) {
    if (!history.wants(i / 10, bytes)) continue;
    history.push(i / 10, { number: i }, bytes);
    kept += 1;
  }
  return kept;
}

test('what fits is kept at ten a second, for a minute', () => {
  const history = new History(1e6);
  fill(history, 90, 100);
  assert.equal(history.rate_hz, 10);
  assert.ok([600, 601].includes(history.entries.length), `${history.entries.length} are kept`);
  assert.ok(history.entries[0].time_s >= 29.8 && history.entries[0].time_s < 30.1);
});

test('large entries are kept more seldom, so that the minute stays whole and the memory bounded', () => {
  const history = new History(240e6);
  fill(history, 200, 1.5e6);
  assert.equal(history.step_s, 0.4);
  assert.ok(history.bytes <= 240e6);
  const span_s = history.entries.at(-1).time_s - history.entries[0].time_s;
  assert.ok(span_s > 59 && span_s <= 60, `${span_s} s`);
});

test('what is larger than the budget is not kept at all', () => {
  const history = new History(100);
  assert.equal(fill(history, 5, 80), 0);
});

test('a grown map never takes more than the budget', () => {
  const history = new History(1000);
  fill(history, 60, 10);
  for (let i = 0; i < 20; ++i) if (history.wants(60 + i, 300)) history.push(60 + i, {}, 300);
  assert.ok(history.bytes <= 1000);
});

test('looking back finds what was on the screen then', () => {
  const history = new History(1e6);
  assert.equal(history.at(3), undefined);
  fill(history, 10, 100);
  assert.equal(history.at(4.54).value.number, 45);
  assert.equal(history.at(-5).value.number, 0);
  assert.equal(history.at(99).value.number, 99);
});
