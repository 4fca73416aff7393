/** The age of what is on the screen: large, and red when it is too old to drive by. */
import { find } from './dom.js';
import { seconds } from './words.js';

const LABELS = { none: 'no map yet', fresh: 'age of the map', stale: 'stale map', silent: 'stale map', past: 'in the past' };

/** @param {'none' | 'fresh' | 'stale' | 'silent' | 'past'} worth @param {number} rate_hz of maps that come */
export function show_age(worth, age_s, rate_hz) {
  document.body.dataset.map = worth;
  find('age-value').textContent = worth === 'none' ? '–' : seconds(age_s);
  find('age-label').textContent = worth === 'fresh' ? `${LABELS.fresh} · ${rate_hz.toFixed(0)} /s` : LABELS[worth];
}

/** @param {string} title nothing is shown if it is empty */
export function show_notice(title, text) {
  const notice = find('notice');
  notice.hidden = title === '';
  notice.querySelector('b').textContent = title;
  notice.querySelector('span').textContent = text;
}
