/** NEGATIVE columns as shafts: a dark floor, walls where the hole ends, a bright rim on the ground around. */
import * as THREE from 'three';
import { FLAG, OBSTACLE_COLOURS } from './layers.js';

const LEAST_DEPTH_M = 0.7;
const RIM_REACH = 4;  // columns, to find ground beside a hole
const SIDES = [[1, 0], [0, 1], [-1, 0], [0, -1]];
const TINT = new THREE.Color(OBSTACLE_COLOURS.hole).toArray();  // linear, as three.js takes colours of vertices
const SHADES = { floor: 0.012, low: 0.012, high: 0.16, rim: 1 };
const RIM_M = 0.14;
const RIM_ABOVE_M = 0.06;

/** The mean height of the nearest ground around column i, NaN if there is none near. */
function rim_m(map, height, flags, i) {
  const x = i % map.columns;
  const y = Math.floor(i / map.columns);
  for (let reach = 1; reach <= RIM_REACH; ++reach) {
    let sum = 0;
    let count = 0;
    for (let dy = -reach; dy <= reach; ++dy)
      for (let dx = -reach; dx <= reach; ++dx) {
        const inside = x + dx >= 0 && x + dx < map.columns && y + dy >= 0 && y + dy < map.rows;
        const at = i + dy * map.columns + dx;
        if (!inside || flags[at] & FLAG.negative || Number.isNaN(height[at])) continue;
        sum += height[at];
        count += 1;
      }
    if (count > 0) return sum / count;
  }
  return NaN;
}

export class Holes {
  constructor() {
    this.shafts = new THREE.Mesh(new THREE.BufferGeometry(), new THREE.MeshBasicMaterial({ vertexColors: true }));
    this.shafts.frustumCulled = false;
  }

  /** @param {number} ground_m the height of the vehicle's ground, where a hole has none beside it */
  show(map, anchor_m, ground_m) {
    const flags = map.layer('flags') ?? [];
    const height = map.layer('height');
    const delta = map.layer('negative_delta');
    this.parts = { places: [], colours: [] };
    for (let i = 0; i < flags.length; ++i) {
      if (!(flags[i] & FLAG.negative)) continue;
      const found = rim_m(map, height, flags, i);
      const rim = (Number.isNaN(found) ? ground_m : found) - anchor_m.z;
      this.add(map, anchor_m, flags, i, rim, Math.max(LEAST_DEPTH_M, delta?.[i] || 0));
    }
    this.end();
  }

  add(map, anchor_m, flags, i, rim, depth_m) {
    const column = i % map.columns;
    const row = Math.floor(i / map.columns);
    const x = map.origin_m.x - anchor_m.x + (column + 0.5) * map.cell_m;
    const y = map.origin_m.y - anchor_m.y + (row + 0.5) * map.cell_m;
    const h = map.cell_m / 2;
    const bottom = rim - depth_m;
    this.quad([[x - h, y - h, bottom], [x + h, y - h, bottom], [x + h, y + h, bottom], [x - h, y + h, bottom]],
      SHADES.floor, SHADES.floor);
    for (const [dx, dy] of SIDES) {
      const inside = column + dx >= 0 && column + dx < map.columns && row + dy >= 0 && row + dy < map.rows;
      if (inside && flags[i + dy * map.columns + dx] & FLAG.negative) continue;
      const a = [x + h * (dx - dy), y + h * (dy + dx)];
      const b = [x + h * (dx + dy), y + h * (dy - dx)];
      this.quad([[...a, bottom], [...b, bottom], [...b, rim], [...a, rim]], SHADES.low, SHADES.high);
      const out = ([px, py]) => [px + dx * RIM_M, py + dy * RIM_M, rim + RIM_ABOVE_M];
      this.quad([[...a, rim + RIM_ABOVE_M], [...b, rim + RIM_ABOVE_M], out(b), out(a)], SHADES.rim, SHADES.rim);
    }
  }

  /** Seen from within the shaft, or from above, only. */
  quad([a, b, c, d], low, high) {
    this.parts.places.push(...a, ...b, ...c, ...a, ...c, ...d);
    for (const shade of [low, low, high, low, high, high]) this.parts.colours.push(...TINT.map((value) => value * shade));
  }

  end() {
    const floats = (values) => new THREE.Float32BufferAttribute(values, 3);
    this.shafts.geometry.dispose();
    this.shafts.geometry = new THREE.BufferGeometry()
      .setAttribute('position', floats(this.parts.places)).setAttribute('color', floats(this.parts.colours));
  }
}
