/** NEGATIVE columns as shafts: a dark floor, walls where the hole ends, a bright rim. */
import * as THREE from 'three';
import { rgb_of } from './colour_map.js';
import { FLAG, OBSTACLE_COLOURS } from './layers.js';

const LEAST_DEPTH_M = 0.7;
const RIM_REACH = 4;  // columns, to find ground beside a hole
const SIDES = [[1, 0], [0, 1], [-1, 0], [0, -1]];
const TINT = rgb_of(OBSTACLE_COLOURS.hole).map((value) => value / 255);
const SHADES = { floor: 0.16, low: 0.2, high: 0.75 };

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
    this.rims = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ color: OBSTACLE_COLOURS.hole }));
    this.group = new THREE.Group().add(this.shafts, this.rims);
    this.group.children.forEach((child) => { child.frustumCulled = false; });
  }

  /** @param {number} ground_m the height of the vehicle's ground, where a hole has none beside it */
  show(map, anchor_m, ground_m) {
    const flags = map.layer('flags') ?? [];
    const height = map.layer('height');
    const delta = map.layer('negative_delta');
    this.parts = { places: [], colours: [], lines: [] };
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
      this.parts.lines.push(...a, rim + 0.05, ...b, rim + 0.05);
    }
  }

  /** Seen from within the shaft only. */
  quad([a, b, c, d], low, high) {
    this.parts.places.push(...a, ...b, ...c, ...a, ...c, ...d);
    for (const shade of [low, low, high, low, high, high]) this.parts.colours.push(...TINT.map((value) => value * shade));
  }

  end() {
    const floats = (values) => new THREE.Float32BufferAttribute(values, 3);
    this.shafts.geometry.dispose();
    this.rims.geometry.dispose();
    this.shafts.geometry = new THREE.BufferGeometry()
      .setAttribute('position', floats(this.parts.places)).setAttribute('color', floats(this.parts.colours));
    this.rims.geometry = new THREE.BufferGeometry().setAttribute('position', floats(this.parts.lines));
  }
}
