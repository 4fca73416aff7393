/** All that is drawn in 3D. Places are in odom less an anchor near by, so that 32 bits are fine enough anywhere. */
import * as THREE from 'three';
import { value_at } from '../data/layer_map.js';
import { Camera } from './camera.js';
import { rgb_of } from './colour_map.js';
import { Ground } from './ground.js';
import { Holes } from './holes.js';
import { OBSTACLE_COLOURS } from './layers.js';
import { Obstacles } from './obstacles.js';
import { Pace, draws_in_software } from './pace.js';
import { Ribbon } from './ribbon.js';
import { Vehicle } from './vehicle.js';
import { Voxels } from './voxels.js';

const ANCHOR_REACH_M = 500;
const STEP_OFF_M = 3;  // the ground under the vehicle is taken if it is this near its pose
const SHARPEST_PIXELS = 2;

/**
 * @typedef {object} View what is shown together
 * @property {import('../data/layer_map.js').LayerMap} map
 * @property {{x: number, y: number, z: number, quaternion: number[], yaw_rad: number} | null} pose
 * @property {{x: number, y: number, z: number}[]} plan
 * @property {{x: number, y: number, z: number}[]} trajectory
 * @property {import('../data/column_tops.js').ColumnTops | null} tops
 * @property {object | null} cloud of voxels
 */

export class Scene {
  /** @param {HTMLCanvasElement} canvas; throws where there is no WebGL 2 */
  constructor(canvas) {
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: !draws_in_software() });
    this.pace = new Pace(this.renderer.getContext(), Math.min(SHARPEST_PIXELS, window.devicePixelRatio));
    this.renderer.setPixelRatio(this.pace.pixels);
    this.camera = new Camera(canvas);
    this.three = new THREE.Scene();
    this.ground = new Ground();
    this.obstacles = new Obstacles();
    this.holes = new Holes();
    this.voxels = new Voxels();
    this.vehicle = new Vehicle();
    this.plan = new Ribbon('#ffffff', 0.4, 0.7);
    this.trajectory = new Ribbon('#29a9ff', 0.7, 0.95);
    const sun = new THREE.DirectionalLight('#ffffff', 2.4);
    sun.position.set(-0.56, 0.54, 0.9);
    this.three.add(new THREE.HemisphereLight('#ffffff', '#555a60', 1.3), sun, this.ground.mesh, this.obstacles.mesh,
      this.holes.shafts, this.voxels.mesh, this.vehicle.group, this.plan.mesh, this.trajectory.mesh);
    this.shows = { obstacles: true, voxels: false, ways: true };
    this.anchor_m = null;
    this.ground.uniforms.steep.value.set(...rgb_of(OBSTACLE_COLOURS.steep).map((value) => value / 255));
    this.dirty = true;
  }

  /** As "#rrggbb": of what is not known, of columns without a value, of the planned way. */
  set_colours({ background, no_value, plan }) {
    const part = (hex) => rgb_of(hex).map((value) => value / 255);
    this.plan.mesh.material.color.set(plan);
    this.three.background = new THREE.Color(background);
    this.ground.uniforms.no_value.value.set(...part(no_value));
    for (const { uniforms } of [this.ground.material, this.obstacles.material, this.voxels.material])
      uniforms.background.value.set(...part(background));
    this.dirty = true;
  }

  set_layer(name) {
    this.ground.set_layer(name);
    if (this.view) this.show(this.view);
  }

  /** @param {'obstacles' | 'voxels' | 'ways'} what @param {boolean} is_shown */
  set_shown(what, is_shown) {
    this.shows[what] = is_shown;
    if (this.view) this.show(this.view);
  }

  /** @param {View} view */
  show(view) {
    this.view = view;
    const { map, pose } = view;
    this.move_anchor(map, pose);
    const ground_m = this.ground_under(map, pose);
    this.ground.uniforms.shows_obstacles.value = this.shows.obstacles;
    this.ground.show(map, this.anchor_m);
    this.obstacles.mesh.visible = this.shows.obstacles && !(this.shows.voxels && view.cloud);
    this.holes.shafts.visible = this.shows.obstacles;
    if (this.obstacles.mesh.visible) this.obstacles.show(map, this.anchor_m, view.tops);
    if (this.shows.obstacles) this.holes.show(map, this.anchor_m, ground_m);
    this.voxels.mesh.visible = this.shows.voxels && view.cloud !== null;
    if (this.voxels.mesh.visible) this.voxels.show(view.cloud, this.anchor_m, map.cell_m);
    for (const way of ['plan', 'trajectory']) {
      this[way].mesh.visible = this.shows.ways && view[way].length > 1;
      if (this[way].mesh.visible) this[way].show(view[way], map, this.anchor_m, ground_m);
    }
    this.show_vehicle(map, pose, ground_m);
    this.dirty = true;
  }

  show_vehicle(map, pose, ground_m) {
    if (pose) this.vehicle.show(pose, this.anchor_m, ground_m);
    const place = pose ?? { x: map.origin_m.x + (map.columns * map.cell_m) / 2, y: map.origin_m.y + (map.rows * map.cell_m) / 2 };
    this.camera.follow(
      new THREE.Vector3(place.x - this.anchor_m.x, place.y - this.anchor_m.y, ground_m - this.anchor_m.z), pose?.yaw_rad ?? 0);
  }

  ground_under(map, pose) {
    if (!pose) return this.ground.range?.[0] ?? 0;
    const ground_m = value_at(map, 'height', pose.x, pose.y);
    return Math.abs(ground_m - pose.z) < STEP_OFF_M ? ground_m : pose.z;
  }

  move_anchor(map, pose) {
    const { x, y } = map.origin_m;
    if (this.anchor_m && Math.hypot(x - this.anchor_m.x, y - this.anchor_m.y) < ANCHOR_REACH_M) return;
    const anchor_m = { x, y, z: pose?.z ?? 0 };
    if (this.anchor_m)
      this.camera.shift(new THREE.Vector3(anchor_m.x - this.anchor_m.x, anchor_m.y - this.anchor_m.y, anchor_m.z - this.anchor_m.z));
    this.anchor_m = anchor_m;
  }

  resize(width, height) {
    this.renderer.setSize(width, height, false);
    this.camera.resize(width, height);
    this.dirty = true;
  }

  /** Draws if anything changed and the last picture is done. @param {number} step_s since the last call */
  draw(step_s, now_ms) {
    this.dirty = this.camera.update(step_s) || this.dirty;
    if (!this.dirty || !this.pace.is_ready(now_ms)) return;
    if (this.pace.adapt()) this.renderer.setPixelRatio(this.pace.pixels);
    this.renderer.render(this.three, this.camera.camera);
    this.pace.began(now_ms);
    this.dirty = false;
  }
}
