/** The camera: behind the vehicle and turning with it, from above, or wherever the hand puts it. */
import * as THREE from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';

const BEHIND_M = { back: 20, up: 14 };
const ABOVE_M = 75;
const AHEAD_M = 4;         // where a camera that follows looks, before the vehicle
const SETTLES_S = 0.25;
const UP = new THREE.Vector3(0, 0, 1);

export class Camera {
  /** @param {HTMLElement} element that is dragged */
  constructor(element) {
    this.camera = new THREE.PerspectiveCamera(48, 1, 0.5, 600);
    this.camera.up.copy(UP);
    this.controls = new OrbitControls(this.camera, element);
    Object.assign(this.controls, { enableDamping: true, dampingFactor: 0.12, maxPolarAngle: 1.5, minDistance: 5, maxDistance: 220 });
    this.mode = 'follow';
    this.goal = null;  // {place, yaw_rad} of the vehicle in the scene
    this.at = null;
  }

  /** @param {'follow' | 'top' | 'free'} mode */
  set_mode(mode) {
    this.mode = mode;
    if (this.at && mode !== 'free') this.place();
  }

  /** Puts the camera where the mode wants it; the hand may turn it from there. */
  place() {
    const { place, yaw_rad } = this.at;
    const ahead = new THREE.Vector3(Math.cos(yaw_rad), Math.sin(yaw_rad), 0);
    this.controls.target.copy(place).addScaledVector(ahead, this.mode === 'follow' ? AHEAD_M : 0);
    this.camera.position.copy(place);
    if (this.mode === 'follow') this.camera.position.addScaledVector(ahead, -BEHIND_M.back).addScaledVector(UP, BEHIND_M.up);
    else this.camera.position.addScaledVector(ahead, -0.5).addScaledVector(UP, ABOVE_M);
    this.controls.update();
  }

  /** Where the vehicle is now, in the scene. */
  follow(place, yaw_rad) {
    this.goal = { place: place.clone(), yaw_rad };
    if (this.at && this.at.place.distanceTo(place) < 15) return;
    this.at = { place: place.clone(), yaw_rad };
    if (this.mode !== 'free' || !this.placed) this.place();
    this.placed = true;
  }

  /** The scene's zero has moved by `by`. */
  shift(by) {
    for (const point of [this.camera.position, this.controls.target, this.at?.place, this.goal?.place]) point?.sub(by);
  }

  /** @param {number} step_s since the last one @returns {boolean} whether anything moved */
  update(step_s) {
    const before = this.camera.matrixWorld.clone();
    if (this.at && this.goal) this.approach(1 - Math.exp(-step_s / SETTLES_S));
    this.controls.update();
    this.camera.updateMatrixWorld();
    return !before.equals(this.camera.matrixWorld);
  }

  approach(part) {
    const step = this.goal.place.clone().sub(this.at.place).multiplyScalar(part);
    const turn = Math.atan2(Math.sin(this.goal.yaw_rad - this.at.yaw_rad), Math.cos(this.goal.yaw_rad - this.at.yaw_rad)) * part;
    this.at.place.add(step);
    this.at.yaw_rad += turn;
    if (this.mode === 'free' || step.length() + Math.abs(turn) < 1e-4) return;
    for (const point of [this.camera.position, this.controls.target])
      point.add(step).sub(this.at.place).applyAxisAngle(UP, this.mode === 'follow' ? turn : 0).add(this.at.place);
  }

  resize(width, height) {
    this.camera.aspect = width / height;
    this.camera.fov = width < height ? 62 : 48;
    this.camera.updateProjectionMatrix();
  }
}
