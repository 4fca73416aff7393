/** A way as a flat ribbon that lies on the ground. */
import * as THREE from 'three';
import { value_at } from '../data/layer_map.js';

const ABOVE_M = 0.18;

export class Ribbon {
  /** @param {number} width_m @param {number} opacity */
  constructor(colour, width_m, opacity) {
    const material = new THREE.MeshBasicMaterial({
      color: colour, transparent: opacity < 1, opacity, side: THREE.DoubleSide, depthWrite: false,
      polygonOffset: true, polygonOffsetFactor: -4, polygonOffsetUnits: -8 });
    this.mesh = new THREE.Mesh(new THREE.BufferGeometry(), material);
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = 1;
    this.width_m = width_m;
  }

  /**
   * @param {{x: number, y: number, z: number}[]} way in odom
   * @param {import('../data/layer_map.js').LayerMap | null} map whose ground it follows
   * @param {number} ground_m where the ground is not known
   */
  show(way, map, anchor_m, ground_m) {
    const places = [];
    let z = ground_m;
    for (let i = 0; i < way.length; ++i) {
      const ahead = way[Math.min(i + 1, way.length - 1)];
      const behind = way[Math.max(i - 1, 0)];
      const length = Math.hypot(ahead.x - behind.x, ahead.y - behind.y) || 1;
      const known = map ? value_at(map, 'height', way[i].x, way[i].y) : NaN;
      z = Number.isNaN(known) ? z : known;
      const nx = (-(ahead.y - behind.y) / length) * (this.width_m / 2);
      const ny = ((ahead.x - behind.x) / length) * (this.width_m / 2);
      const [x, y] = [way[i].x - anchor_m.x, way[i].y - anchor_m.y];
      places.push(x + nx, y + ny, z - anchor_m.z + ABOVE_M, x - nx, y - ny, z - anchor_m.z + ABOVE_M);
    }
    const corners = way.slice(1).flatMap((_, i) => [2 * i, 2 * i + 1, 2 * i + 2, 2 * i + 1, 2 * i + 3, 2 * i + 2]);
    this.mesh.geometry.dispose();
    this.mesh.geometry = new THREE.BufferGeometry()
      .setAttribute('position', new THREE.Float32BufferAttribute(places, 3)).setIndex(corners);
  }
}
