/** Numbers and reasons as people read them. */
import { SILENT_S, STALE_S } from '../data/age.js';

export function seconds(value_s) {
  if (value_s === null || !Number.isFinite(value_s)) return '–';
  if (value_s < 9.995) return `${value_s.toFixed(2)} s`;
  return value_s < 120 ? `${value_s.toFixed(0)} s` : `${(value_s / 60).toFixed(0)} min`;
}

export function with_unit(value, digits, unit) {
  return value === null || !Number.isFinite(value) ? '–' : `${value.toFixed(digits)} ${unit}`;
}

export function whole(value) {
  return value === null ? '–' : String(value).replace(/\B(?=(\d{3})+$)/g, ' ');
}

/** @returns {'none' | 'fresh' | 'stale' | 'silent'} what a map of that age, after that silence, is worth */
export function worth_of(age_s, silent_s) {
  if (!Number.isFinite(age_s)) return 'none';
  if (silent_s > SILENT_S) return 'silent';
  return age_s > STALE_S ? 'stale' : 'fresh';
}

/** @param {'none' | 'stale' | 'silent'} worth */
export function title_of(worth, age_s) {
  if (worth === 'none') return 'No map yet';
  return worth === 'silent' ? `No map for ${seconds(age_s)}` : `The map is ${seconds(age_s)} old`;
}

/** @param {string[]} missing lidars, then @param {'none' | 'fresh' | 'stale' | 'silent'} worth of the newest map, now */
export function past_words(back_s, missing, worth) {
  const then = missing.length ? `, lidar ${missing.join(', ')} missing then` : '';
  return `Looking back ${seconds(back_s)}${then}${worth === 'fresh' ? '' : '. No fresh map comes now'}`;
}

/**
 * Why there is no fresh map.
 * @param {{connected: boolean, url: string, retry_s: number, offered: boolean, status: object | null,
 *          status_silent_s: number, late_s: number, was_hidden: boolean, last_error: string}} seen late_s: how much later
 *   than at best the newest map came, 0 if none comes any more
 */
export function reason_of(seen) {
  if (!seen.connected) return `No connection to ${seen.url}. Next try in ${Math.max(0, seen.retry_s).toFixed(0)} s.`;
  if (seen.was_hidden) return 'This tab was hidden and took no map meanwhile. The next one is on its way.';
  if (!seen.offered) return 'The bridge is there, but it offers no layers.';
  if (seen.status_silent_s > 3) return 'The bridge says nothing any more: the link, or the bridge itself, hangs.';
  if (seen.late_s > STALE_S / 2) return `The maps come ${seen.late_s.toFixed(1)} s late: the link, or this device, is too slow for them.`;
  if (seen.status?.problems.length) return `${seen.status.problems[0]}.`;
  if (seen.last_error) return `A message could not be read: ${seen.last_error}.`;
  return 'The processes say that all is well, but no layers come here.';
}
