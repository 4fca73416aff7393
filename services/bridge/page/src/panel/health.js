/** What each process does, as `gvomctl top` says it; problems first, in words. */
import { element, find } from './dom.js';
import { seconds, whole, with_unit } from './words.js';

const MARKS = { ok: '●', degraded: '▲', failed: '■', silent: '■', starting: '○', stopping: '○', unknown: '○' };

const OLD_S = 3;  // a status that came longer ago says how it was

const mark_of = (state) => element('span', `mark ${state in MARKS ? state : 'failed'}`, MARKS[state] ?? '■');

function problems_part(problems) {
  if (problems.length === 0) return element('p', 'well', mark_of('ok'), 'All is well');
  const items = problems.map((problem) => element('li', '', mark_of('degraded'), element('span', '', problem)));
  return element('ul', 'problems', ...items);
}

function lidars_part(lidars) {
  const chip = ({ name, missing, unknown, age_s }) => {
    const lost = missing || unknown;
    return element('span', lost ? 'chip lost' : 'chip', mark_of(lost ? 'failed' : 'ok'), name,
      element('small', '', lost ? 'missing' : age_s === null ? '' : seconds(age_s)));
  };
  return element('div', 'chips', ...lidars.map(chip));
}

function pairs(rows) {
  const list = element('dl', 'pairs');
  for (const [name, value] of rows) list.append(element('dt', '', name), element('dd', '', value));
  return list;
}

function details_of(process) {
  const facts = [
    ['heard', seconds(process.heard_s)], ['data', seconds(process.data_s)],
    ['restarts', whole(process.restarts)],
    ['memory', process.memory_bytes === null ? '–' : with_unit(process.memory_bytes / 1e6, 0, 'MB')]];
  const stages = process.stages.map(({ name, p50_ms, p99_ms }) =>
    [name, `${with_unit(p50_ms, 1, 'ms')}, p99 ${with_unit(p99_ms, 1, 'ms')}`]);
  const drops = process.drops.map(([name, count, per_s]) =>
    [`dropped ${name}`, whole(count) + (per_s > 0 ? ` (+${per_s.toFixed(0)}/s)` : '')]);
  const counters = process.counters.map(([name, value]) => [name, whole(value)]);
  return pairs([...facts, ...stages, ...drops, ...counters].map(([name, value]) => [name.replaceAll('_', ' '), value]));
}

function process_row(process, is_open) {
  const row = element('details', 'process');
  row.dataset.name = process.name;
  row.open = is_open;
  const slowest = process.stages.reduce((most, { p99_ms }) => Math.max(most, p99_ms ?? 0), 0);
  const summary = element('summary', '',
    mark_of(process.state), element('span', 'name', process.name.replace(/^gvom-/, '')),
    element('span', 'number', process.rate_hz === null ? '' : `${process.rate_hz.toFixed(1)} /s`),
    element('span', 'number', slowest > 0 ? `${slowest.toFixed(1)} ms` : ''));
  row.append(summary);
  if (process.state !== 'ok' && process.reason) row.append(element('p', 'reason', process.reason));
  row.append(details_of(process));
  return row;
}

/** @param {ReturnType<import('../data/status.js').status_of> | null} status @param {number} silent_s since it came */
export function show_health(status, silent_s) {
  const panel = find('health');
  const open = new Set([...panel.querySelectorAll('details[open]')].map((row) => row.dataset.name));
  panel.dataset.old = String(silent_s > OLD_S);
  if (!status) {
    panel.replaceChildren(element('p', 'quiet', 'No status has come yet.'));
    return;
  }
  const heard = silent_s > OLD_S ? element('p', 'quiet', `Nothing heard for ${seconds(silent_s)}. This is how it was.`) : '';
  panel.replaceChildren(
    heard, problems_part(status.problems),
    element('h2', '', 'Lidars'), lidars_part(status.lidars),
    element('h2', 'columns', 'Processes', element('span', '', 'rate'), element('span', '', 'slowest p99')),
    ...status.processes.map((process) => process_row(process, open.has(process.name))));
}

/** The button that opens the panel on a phone, the missing lidars beside the age, and the tab's title. */
export function show_summary(status, silent_s) {
  const is_old = !status || silent_s > OLD_S;
  const problems = status?.problems.length ?? 0;
  const button = find('open-health');
  button.replaceChildren(mark_of(is_old ? 'unknown' : problems ? 'degraded' : 'ok'), problems ? `${problems} problem${problems > 1 ? 's' : ''}` : 'Health');
  button.dataset.problems = String(problems);
  const missing = status?.missing ?? [];
  find('lidars').replaceChildren(...(missing.length
    ? [mark_of('failed'), element('span', '', `lidar ${missing.join(', ')} missing`)] : []));
  find('vehicle').textContent = status?.vehicle ?? '';
  document.title = is_old ? '▲ nothing heard · gvom' : problems ? `▲ ${problems} · gvom` : 'gvom';
}
