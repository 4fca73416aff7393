/** The drive through the country: what the lidars have seen until now, as layers around the vehicle. */
import { CELL_M, COUNTRY, HARD, NEGATIVE, SOFT, STEEP, ground_m, make_country, noise, way_at } from './world.js';

export const SIZE = 256;
const SENSOR_M = 1.9;
const SPEED_MPS = 4;
const FAR_M = 50;
const MEMORY_S = 5;
const WINDOW_S = 0.8;
const RAYS = 1100;
const FIELDS = ['height', 'inferred_height', 'slope_x', 'slope_y', 'slope', 'roughness', 'obstacle_density',
  'negative_delta', 'clearance', 'last_seen'];

export class Drive {
  constructor() {
    this.country = make_country();
    this.seen_s = new Float32Array(COUNTRY.columns * COUNTRY.rows).fill(-Infinity);
    this.time_s = 0;
    for (let t = -4; t < 0; t += 0.2) this.look(t, true);
  }

  pose(time_s = this.time_s) {
    const s = 12 + (SPEED_MPS * time_s) % 120;
    const way = way_at(s);
    return { ...way, z: ground_m(way.x, way.y), s };
  }

  /** @param {number} time_s since the start of the drive @param {boolean} rear whether the lidar that looks back is there */
  look(time_s, rear) {
    this.time_s = time_s;
    const pose = this.pose();
    for (let ray = 0; ray < RAYS; ++ray) {
      const angle = (2 * Math.PI * ray) / RAYS;
      if (!rear && Math.cos(angle) < -0.2) continue;
      this.cast(pose, pose.yaw_rad + angle, time_s, ray);
    }
  }

  /** Marks what one vertical fan of rays sees: all that rises above what is nearer. */
  cast(pose, angle, time_s, ray) {
    const { country, seen_s } = this;
    const eye_z = pose.z + SENSOR_M;
    let horizon = -1.2;
    let seen_tilt = -1.2;
    for (let r = 2.2; r < FAR_M; r += 0.28 + 0.004 * r) {
      const column = Math.floor((pose.x + r * Math.cos(angle) - COUNTRY.x_m) / CELL_M);
      const row = Math.floor((pose.y + r * Math.sin(angle) - COUNTRY.y_m) / CELL_M);
      if (column < 0 || row < 0 || column >= COUNTRY.columns || row >= COUNTRY.rows) return;
      const i = row * COUNTRY.columns + column;
      const tilt = (country.ground[i] + country.top[i] - eye_z) / r;
      const ring_step = 0.0035 + 0.004 * noise(ray, Math.floor(time_s * 10));
      const hit = tilt > horizon && (r < 20 || tilt - seen_tilt > ring_step || country.top[i] > 0.4);
      if (hit) {
        seen_s[i] = time_s;
        seen_tilt = tilt;
      }
      const lets_through = country.flags[i] & SOFT && noise(column, row) < 0.5;
      if (!lets_through) horizon = Math.max(horizon, tilt);
    }
  }

  /** Where the country's columns are that the map shows: its corner moves with the vehicle in whole columns. */
  corner() {
    const pose = this.pose();
    return {
      column: Math.floor((pose.x - COUNTRY.x_m) / CELL_M) - SIZE / 2,
      row: Math.floor((pose.y - COUNTRY.y_m) / CELL_M) - SIZE / 2,
    };
  }

  map() {
    const { column, row } = this.corner();
    const layers = new Map([
      ...FIELDS.map((name) => [name, new Float32Array(SIZE * SIZE).fill(NaN)]),
      ...['flags', 'visibility', 'cost'].map((name) => [name, new Uint8Array(SIZE * SIZE)])]);
    layers.get('cost').fill(255);
    for (let y = 0, to = 0; y < SIZE; ++y)
      for (let x = 0; x < SIZE; ++x, ++to) this.column_of_map(layers, column + x, row + y, to);
    const origin_m = [COUNTRY.x_m + column * CELL_M, COUNTRY.y_m + row * CELL_M, 0];
    return { stamp_s: 1000 + this.time_s, origin_m, cell_m: CELL_M, size: SIZE, layers };
  }

  column_of_map(layers, column, row, to) {
    if (column < 0 || row < 0 || column >= COUNTRY.columns || row >= COUNTRY.rows) return;
    const { country } = this;
    const from = row * COUNTRY.columns + column;
    const age_s = this.time_s - this.seen_s[from];
    if (age_s > MEMORY_S) return;
    const flags = country.flags[from];
    const put = (name, value) => { layers.get(name)[to] = value; };
    put('last_seen', age_s);
    put('visibility', flags & NEGATIVE ? 1 : age_s > WINDOW_S ? 4 : 3);
    put('flags', flags);
    put('negative_delta', country.depth[from]);
    if (flags & NEGATIVE) put('inferred_height', country.ground[from] - country.depth[from]);
    if (!(flags & NEGATIVE)) this.ground_of_map(put, from, flags);
    put('cost', flags & (HARD | NEGATIVE | STEEP) ? 254 : Math.min(252, Math.round(180 * this.slope(from) + (flags & SOFT ? 90 : 0))));
  }

  slope(from) {
    return Math.atan(Math.hypot(this.country.slope_x[from], this.country.slope_y[from]));
  }

  ground_of_map(put, from, flags) {
    const { country } = this;
    put('height', country.ground[from]);
    put('slope_x', country.slope_x[from]);
    put('slope_y', country.slope_y[from]);
    put('slope', this.slope(from));
    put('roughness', 0.002 + 0.02 * noise(from, 9) * (flags & SOFT ? 1 : 0.2));
    put('obstacle_density', flags & HARD ? 0.7 : flags & SOFT ? 0.25 : 0);
    put('clearance', country.crown[from] > 0 && !(flags & HARD) ? Math.max(2.1, country.crown[from] - 2) : Infinity);
  }

  /** Occupied voxels: x, y, z, density of each. */
  voxels() {
    const { column, row } = this.corner();
    const { country } = this;
    const values = [];
    for (let y = row; y < row + SIZE; ++y)
      for (let x = column; x < column + SIZE; ++x) {
        if (x < 0 || y < 0 || x >= COUNTRY.columns || y >= COUNTRY.rows) continue;
        const from = y * COUNTRY.columns + x;
        if (this.time_s - this.seen_s[from] > MEMORY_S || country.flags[from] & NEGATIVE) continue;
        this.voxels_of_column(values, COUNTRY.x_m + (x + 0.5) * CELL_M, COUNTRY.y_m + (y + 0.5) * CELL_M, from);
      }
    return Float32Array.from(values);
  }

  voxels_of_column(values, x_m, y_m, from) {
    const { country } = this;
    const centre = (z) => (Math.floor(z / CELL_M) + 0.5) * CELL_M;
    const ground = country.ground[from];
    for (let z = centre(ground); z <= centre(ground + country.top[from]); z += CELL_M)
      values.push(x_m, y_m, z, country.flags[from] & SOFT ? 0.3 : 0.8);
    if (country.crown[from] > 0)
      for (let z = centre(ground + country.crown[from] - 2); z <= centre(ground + country.crown[from]); z += CELL_M)
        values.push(x_m, y_m, z, 0.2);
  }

  /** The way ahead, every half metre. @param {number} length_m */
  ahead(length_m) {
    const { s } = this.pose();
    return Array.from({ length: 2 * length_m }, (_, i) => {
      const { x, y } = way_at(s + i / 2);
      return { x, y, z: ground_m(x, y) };
    });
  }
}
