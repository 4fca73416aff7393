/** What has come from the bridge until now, and how old it is. */
import { MapAge, SILENT_S } from './data/age.js';
import { column_tops } from './data/column_tops.js';
import { History } from './data/history.js';
import { layer_map_of } from './data/layer_map.js';
import { pack_map, packed_bytes } from './data/packed_map.js';
import { pose_of, way_of } from './data/pose.js';
import { status_of } from './data/status.js';
import { Connection } from './wire/connection.js';

const SMALL_TOPICS = ['/gvom/status'];
const MAP_TOPICS = ['/tf', '/gvom/plan', '/gvom/trajectory'];
const LAYERS = '/gvom/layers';
const VOXELS = '/gvom/voxels';
const LONGEST_PAUSE_S = 0.8;
const LATE_S = 0.25;
const LATE_MAPS = 3;        // so many one after the other, and what has piled up on the way is let go
const WAY_HOLDS_S = 1;      // a planner that says nothing for longer has no way
const VOXELS_HOLD_S = 3;
const SHOWS_WITHIN_S = 3;   // after a tab was hidden its first map comes
const BUDGET_BYTES = 240e6;
const SMALL_BUDGET_BYTES = 100e6;  // on machines of 4 GB and less, as far as the browser tells

export const clock_s = () => performance.now() / 1000;

export class Feed {
  /** @param {string} url of the bridge @param {{on_map: () => void, on_status: () => void}} events */
  constructor(url, { on_map, on_status }) {
    Object.assign(this, { on_map, on_status });
    this.age = new MapAge();
    this.history = new History((navigator.deviceMemory ?? 8) <= 4 ? SMALL_BUDGET_BYTES : BUDGET_BYTES);
    this.ways = { plan: { way: [], at_s: -Infinity }, trajectory: { way: [], at_s: -Infinity } };
    this.map = this.pose = this.cloud = this.tops = this.status = null;
    this.cloud_at_s = this.status_at_s = -Infinity;
    this.is_hidden = this.wants_voxels = this.lets_go = false;
    this.shown_at_s = -Infinity;
    this.late_maps = 0;
    this.connection = new Connection(url, {
      on_message: (topic, message, stamp_ns) => this.on_message(topic, message, stamp_ns),
      on_change: () => on_status() });
  }

  /** A hidden tab takes the status only. */
  set_wanted(is_hidden, wants_voxels) {
    if (this.is_hidden && !is_hidden) this.shown_at_s = clock_s();
    this.is_hidden = is_hidden;
    this.wants_voxels = wants_voxels;
    this.subscribe();
  }

  subscribe() {
    const large = this.lets_go ? [] : this.wants_voxels ? [LAYERS, VOXELS] : [LAYERS];
    this.connection.want(this.is_hidden ? SMALL_TOPICS : [...SMALL_TOPICS, ...MAP_TOPICS, ...large]);
  }

  /** When maps come late again and again, none is taken until those that have piled up on the way have gone by, unread. */
  catch_up() {
    const late_s = this.age.late_s();
    this.late_maps = late_s > LATE_S ? this.late_maps + 1 : 0;
    if (this.late_maps < LATE_MAPS) return;
    this.late_maps = 0;
    this.lets_go = true;
    this.subscribe();
    setTimeout(() => {
      this.lets_go = false;
      this.subscribe();
    }, 1000 * Math.min(LONGEST_PAUSE_S, late_s));
  }

  on_message(topic, message, stamp_ns) {
    const now_s = clock_s();
    if (topic === LAYERS) this.on_layers(message, Number(stamp_ns) / 1e9, now_s);
    if (topic === '/tf') this.on_tf(message, Number(stamp_ns) / 1e9, now_s);
    if (topic === '/gvom/plan') this.ways.plan = { way: way_of(message), at_s: now_s };
    if (topic === '/gvom/trajectory') this.ways.trajectory = { way: way_of(message), at_s: now_s };
    if (topic === VOXELS) this.on_voxels(message, now_s);
    if (topic === '/gvom/status') this.take_status(message, now_s);
  }

  on_layers(message, stamp_s, now_s) {
    this.map = layer_map_of(message);
    this.age.on_map(stamp_s, now_s);
    this.shown_at_s = -Infinity;
    this.keep(now_s);
    this.on_map();
    this.catch_up();
  }

  on_tf(message, stamp_s, now_s) {
    const pose = pose_of(message, this.map?.frame ?? 'odom');
    if (!pose) return;
    this.pose = pose;
    this.age.on_pose(stamp_s, now_s);
  }

  on_voxels(message, now_s) {
    if (!this.map?.layer('height')) return;
    this.cloud = message;
    this.tops = column_tops(message, this.map);
    this.cloud_at_s = now_s;
  }

  take_status(message, now_s) {
    this.status = status_of(message);
    this.status_at_s = now_s;
    if (this.status.layers_age_s !== null) this.age.on_status(this.status.layers_age_s, now_s);
    this.on_status();
  }

  /** What is to be drawn now. @returns {import('./view/scene.js').View} */
  view(now_s = clock_s()) {
    const way = ({ way: places, at_s }) => (now_s - at_s < WAY_HOLDS_S ? places : []);
    const has_voxels = this.wants_voxels && now_s - this.cloud_at_s < VOXELS_HOLD_S;
    return {
      map: this.map,
      pose: this.pose,
      plan: way(this.ways.plan),
      trajectory: way(this.ways.trajectory),
      tops: has_voxels ? this.tops : null,
      cloud: has_voxels ? this.cloud : null,
    };
  }

  /** Into the last minute; without voxels, which would take as much again. */
  keep(now_s) {
    const bytes = packed_bytes(this.map);
    if (!this.history.wants(now_s, bytes)) return;
    const view = { ...this.view(now_s), map: pack_map(this.map, this.pose?.z ?? 0), cloud: null };
    this.history.push(now_s, { view, missing: this.status?.missing ?? [] }, bytes + (view.tops ? view.map.columns * view.map.rows * 4 : 0));
  }

  /** Why there is no fresh map; see reason_of(). */
  circumstances(now_s) {
    const { connection } = this;
    return {
      connected: connection.connected,
      url: new URL(connection.url).host,
      retry_s: ((connection.retry_at_ms ?? 0) - Date.now()) / 1000,
      offered: connection.offers(LAYERS),
      status: this.status,
      status_silent_s: now_s - this.status_at_s,
      late_s: this.age.silent_s(now_s) < SILENT_S ? this.age.late_s() : 0,
      was_hidden: now_s - this.shown_at_s < SHOWS_WITHIN_S,
      last_error: connection.last_error,
    };
  }
}
