import assert from 'node:assert/strict';
import test from 'node:test';
import { MapAge } from '../src/data/age.js';
import { past_words, reason_of, seconds, title_of, whole, worth_of } from '../src/panel/words.js';

/** Maps at 10 Hz that arrive `delay(t)` after their stamps, from t = 0 up to `end_s`. */
function fed(end_s, delay = () => 0.05, speed = 1) {
  const age = new MapAge();
  for (let i = 0; i <= 10 * end_s; ++i) age.on_map(500 + (speed * i) / 10, i / 10 + delay(i / 10));
  return age;
}

const near = (value, wanted) => assert.ok(Math.abs(value - wanted) < 1e-6, `${value} is not ${wanted}`);

test('without a map the age is infinite', () => {
  assert.equal(new MapAge().age_s(3), Infinity);
  assert.equal(worth_of(Infinity, Infinity), 'none');
});

test('the age grows with this page\'s clock when nothing comes any more', () => {
  const age = fed(5);
  near(age.age_s(5.05), 0);
  near(age.age_s(7.05), 2);
  near(age.silent_s(7.05), 2);
});

test('what the bridge says of the age counts from the newest map on', () => {
  const age = fed(5);
  age.on_status(0.08, 5.09);  // the newest map was 0.04 s old when it came
  near(age.age_s(5.15), 0.14);
  age.on_status(2.1, 5.05);   // the processes lag: old although it came just now
  near(age.age_s(5.05), 2.1);
});

test('maps that come ever later on a slow link are as old as they are late', () => {
  const age = fed(8, (t) => 0.05 + (t > 4 ? 0.9 : 0));
  near(age.late_s(), 0.9);
  near(age.age_s(8.95), 0.9);
});

test('a link that stood still for two seconds is no slow recording', () => {
  near(fed(12, (t) => 0.05 + (t > 11.95 ? 2.3 : 0)).late_s(), 2.3);
});

test('maps that are always late are told by poses that are not', () => {
  const age = fed(8, () => 1);
  near(age.late_s(), 0);       // nothing to compare with
  age.on_pose(506.4, 6.41);    // a pose takes 0.01 s, so a map may take 0.31 s
  near(age.late_s(), 0.69);
});

test('the time that it takes to make a map is not late', () => {
  const age = fed(8, () => 0.12);
  age.on_pose(506.4, 6.41);
  near(age.late_s(), 0);
});

test('a recording that is played at half its speed is not late', () => {
  assert.ok(fed(19, () => 0.05, 0.5).late_s() < 1e-6);
});

test('when a replay begins anew, or jumps ahead, its clock is judged anew', () => {
  const age = fed(5);
  age.on_pose(504, 4.01);
  age.on_map(100, 5.2);
  near(age.age_s(5.2), 0);
  age.on_map(900, 5.3);
  near(age.age_s(5.3), 0);
});

test('the rate is that of the last three seconds', () => {
  near(fed(9).rate_hz(9.05), 10);
});

test('over half a second is stale, over a second of silence is no map', () => {
  assert.equal(worth_of(0.4, 0.1), 'fresh');
  assert.equal(worth_of(0.6, 0.1), 'stale');
  assert.equal(worth_of(1.2, 1.1), 'silent');
});

test('the reason is the one nearest to the page that is known', () => {
  const well = { connected: true, url: 'host:1', retry_s: 0, offered: true, status: { problems: [] }, status_silent_s: 0.2, late_s: 0, was_hidden: false, last_error: '' };
  assert.match(reason_of({ ...well, connected: false, retry_s: 1.6 }), /No connection to host:1. Next try in 2 s/);
  assert.match(reason_of({ ...well, was_hidden: true }), /hidden/);
  assert.match(reason_of({ ...well, offered: false }), /offers no layers/);
  assert.match(reason_of({ ...well, status_silent_s: 4 }), /says nothing any more/);
  assert.match(reason_of({ ...well, late_s: 0.8 }), /0.8 s late/);
  assert.equal(reason_of({ ...well, status: { problems: ['gvom-fusion is failed'] } }), 'gvom-fusion is failed.');
  assert.match(reason_of({ ...well, last_error: 'x' }), /could not be read: x/);
  assert.match(reason_of(well), /no layers come here/);
});

test('numbers as people read them', () => {
  assert.deepEqual([0.034, 12.4, 200, Infinity, null].map(seconds), ['0.03 s', '12 s', '3 min', '–', '–']);
  assert.deepEqual([7, 1234567, null].map(whole), ['7', '1 234 567', '–']);
});

test('what is over the scene says how old it is', () => {
  assert.equal(title_of('none', Infinity), 'No map yet');
  assert.equal(title_of('stale', 0.62), 'The map is 0.62 s old');
  assert.equal(title_of('silent', 31), 'No map for 31 s');
  assert.equal(past_words(4.1, ['rear'], 'fresh'), 'Looking back 4.10 s, lidar rear missing then');
  assert.equal(past_words(12, [], 'silent'), 'Looking back 12 s. No fresh map comes now');
});
