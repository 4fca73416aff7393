/** What the processes of the mock say of themselves. */

function process(name, rate_hz, more = {}) {
  return { name, state: 'ok', reason: '', pid: 4100, rate_hz, health_age_s: 0.2, data_age_s: 0.03, restarts: 0,
    memory_bytes: 5.2e7, cpu_s: 12, stages: {}, counters: {}, drops: {}, ...more };
}

const stage = (p50_ms, p99_ms, max_ms) => ({ p50_ms, p99_ms, max_ms });

/** @param {{age_s: number, rear: boolean, fusion: boolean}} what is to be told: fusion false: it has died */
export function status_json({ age_s, rear, fusion }) {
  const ingest = (name) => process(`gvom-ingest-${name}`, 10, {
    stages: { decode: stage(1.1, 2.0, 2.4), voxelize: stage(5.6, 8.9, 11.2) },
    counters: { sweeps: 1840, returns: 118203311 }, drops: { return_far: { count: 2, per_s: 0 } } });
  const processes = [
    process('gvom-roudi', null, { data_age_s: null, memory_bytes: 2e6 }),
    process('gvom-fusion', 20, {
      stages: { fuse: stage(3.1, 6.0, 7.2), layers: stage(4.4, 6.9, 9.8) }, counters: { maps: 3680, layers: 1840 },
      ...(fusion ? {} : { state: 'failed', reason: 'has said nothing for 3 s', rate_hz: null }) }),
    ingest('front'),
    rear ? ingest('rear') : process('gvom-ingest-rear', 0, { state: 'degraded', reason: 'no packets for 6.0 s', data_age_s: 6 }),
    process('gvom-odometry', 100, { memory_bytes: 9e6 }),
    process('gvom-planner', 10, { stages: { cycle: stage(7.0, 8.4, 8.5) } }),
    process('gvom-bridge', 10, { stages: { write: stage(0.3, 0.6, 1.1) }, counters: { clients: 1, replaced: 0 } }),
  ];
  const lidars = [
    { name: 'front', missing: false, unknown: false, age_s: 0.05, columns_seen_fraction: 1 },
    { name: 'rear', missing: !rear, unknown: false, age_s: rear ? 0.06 : 6, columns_seen_fraction: 1 },
  ];
  return { vehicle: 'ranger', version: '0.4.0', processes, lidars, layers: { age_s, maps_in_window: rear ? 16 : 8 },
    odometry: { age_s: 0.01, rate_hz: 100 } };
}
