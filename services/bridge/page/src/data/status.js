/** What /gvom/status says, with all that may be missing filled in, and what of it is not as it should be, in words. */
import { STALE_S } from './age.js';

const ODOMETRY_OLD_S = 2; // like the next, as gvomctl judges
const SWEEP_SEEN = 0.95;

const number = (value) => (Number.isFinite(value) ? value : null);

/** Entries of an object, or of an array of objects with a name. */
function named(list) {
  if (Array.isArray(list)) return list.map((value) => [String(value.name ?? ''), value]);
  return Object.entries(list ?? {});
}

function process_of(json) {
  return {
    name: String(json.name ?? 'unnamed'),
    state: String(json.state ?? 'unknown'),
    reason: String(json.reason ?? ''),
    rate_hz: number(json.rate_hz),
    heard_s: number(json.health_age_s ?? json.heard_s),
    data_s: number(json.data_age_s),
    restarts: number(json.restarts),
    memory_bytes: number(json.memory_bytes),
    stages: named(json.stages).map(([name, stage]) => ({
      name, p50_ms: number(stage.p50_ms), p99_ms: number(stage.p99_ms), max_ms: number(stage.max_ms),
    })),
    counters: named(json.counters).map(([name, value]) => [name, number(value?.value ?? value)]),
    drops: named(json.drops).map(([name, drop]) => [name, number(drop?.count ?? drop), number(drop?.per_s)]),
  };
}

function lidar_of([name, json]) {
  return {
    name,
    missing: json.missing === true,
    unknown: json.unknown === true,
    age_s: number(json.age_s),
    seen_fraction: number(json.columns_seen_fraction),
  };
}

/** What never came is null, which the bridge tells; what it does not speak of at all is not judged. */
function data_problems_of({ layers, odometry }, { layers_age_s, odometry_age_s }) {
  const problems = [];
  if (layers === null) problems.push('no layers came');
  else if (layers?.age_s === null) problems.push('the newest layers are of unknown age');
  else if (layers_age_s > STALE_S) problems.push(`the newest layers are ${layers_age_s.toFixed(1)} s old`);
  if (odometry === null) problems.push('no odometry came');
  else if (odometry_age_s > ODOMETRY_OLD_S) problems.push(`the newest odometry is ${odometry_age_s.toFixed(1)} s old`);
  return problems;
}

/** What a process said before it fell silent is no reason any more. */
function problems_of({ processes, lidars }) {
  const problems = processes
    .filter(({ state }) => state !== 'ok' && state !== 'unknown')
    .map(({ name, state, reason }) => `${name} is ${state}${state !== 'silent' && reason ? `: ${reason}` : ''}`);
  for (const { name, missing, unknown, seen_fraction } of lidars) {
    if (unknown) problems.push(`lidar ${name} is not in gvom-fusion's configuration: its maps are not taken`);
    else if (missing) problems.push(`lidar ${name} is missing in the layers`);
    else if (seen_fraction !== null && seen_fraction < SWEEP_SEEN)
      problems.push(`lidar ${name}'s newest sweep has ${(100 * seen_fraction).toFixed(0)} % of its columns`);
  }
  return problems;
}

/** @param {object} json as /gvom/status brings it */
export function status_of(json) {
  const status = {
    vehicle: String(json.vehicle ?? ''),
    version: String(json.version ?? ''),
    processes: (json.processes ?? []).map(process_of),
    lidars: named(json.lidars ?? json.layers?.lidars).map(lidar_of),
    layers_age_s: number(json.layers?.age_s ?? json.layers_age_s),
    odometry_age_s: number(json.odometry?.age_s ?? json.odometry_age_s),
  };
  status.problems = json.problems ?? [...problems_of(status), ...data_problems_of(json, status)];
  status.missing = status.lidars.filter(({ missing }) => missing).map(({ name }) => name);
  return status;
}
