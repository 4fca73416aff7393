/** The vehicle: a body of usual size with a cab, its nose to +x, and a soft shadow that finds it from afar. */
import * as THREE from 'three';

const LENGTH_M = 3.4;
const WIDTH_M = 1.7;
const SIDE = [[-1.7, 0.45], [-1.7, 1.05], [-0.5, 1.1], [-0.15, 1.75], [0.75, 1.75], [1.15, 1.1], [1.7, 0.95], [1.7, 0.45]];
const SCREENS = [[-0.6, 1.2], [-0.27, 1.7], [0.87, 1.7], [1.2, 1.2]];       // before and behind
const SIDE_WINDOWS = [[-0.38, 1.2], [-0.12, 1.66], [0.7, 1.66], [0.98, 1.2]];
const PAINT = '#f6f4ee';
const GLASS = '#20262c';
const WHEEL_M = 0.42;

/** A solid of that outline (x ahead, z up) and width. */
function solid(side, width_m, colour, bevel_m) {
  const outline = new THREE.Shape(side.map(([x, z]) => new THREE.Vector2(x, z)));
  const geometry = new THREE.ExtrudeGeometry(outline, {
    depth: width_m, bevelEnabled: bevel_m > 0, bevelSize: bevel_m, bevelThickness: bevel_m, bevelSegments: 2 });
  geometry.translate(0, 0, -width_m / 2);
  geometry.rotateX(Math.PI / 2);
  return new THREE.Mesh(geometry, new THREE.MeshLambertMaterial({ color: colour }));
}

const body = () => solid(SIDE, WIDTH_M, PAINT, 0.06);
const windows = () => [solid(SCREENS, 0.84 * WIDTH_M, GLASS, 0), solid(SIDE_WINDOWS, WIDTH_M + 0.14, GLASS, 0)];

function wheels() {
  const geometry = new THREE.CylinderGeometry(WHEEL_M, WHEEL_M, 0.34, 20);
  const rubber = new THREE.MeshLambertMaterial({ color: '#22262a' });
  return [[1.05, 1], [1.05, -1], [-1.05, 1], [-1.05, -1]].map(([x, side]) => {
    const wheel = new THREE.Mesh(geometry, rubber);
    wheel.position.set(x, (side * WIDTH_M) / 2, WHEEL_M);
    return wheel;
  });
}

function shadow() {
  const side = 64;
  const alpha = new Uint8Array(4 * side * side);
  for (let i = 0; i < side * side; ++i) {
    const off = Math.hypot((i % side) / (side / 2) - 1, Math.floor(i / side) / (side / 2) - 1);
    alpha[4 * i + 3] = 150 * Math.max(0, 1 - off) ** 0.8;
  }
  const texture = new THREE.DataTexture(alpha, side, side);
  texture.needsUpdate = true;
  const disc = new THREE.Mesh(
    new THREE.PlaneGeometry(1.9 * LENGTH_M, 2.2 * WIDTH_M),
    new THREE.MeshBasicMaterial({ map: texture, transparent: true, depthWrite: false, polygonOffset: true, polygonOffsetFactor: -8, polygonOffsetUnits: -60 }));
  disc.position.z = 0.08;
  return disc;
}

export class Vehicle {
  constructor() {
    this.group = new THREE.Group().add(shadow(), body(), ...windows(), ...wheels());
    this.group.visible = false;
  }

  /** @param {{x: number, y: number, z: number, quaternion: number[]}} pose in odom @param {number} ground_m under it */
  show(pose, anchor_m, ground_m) {
    this.group.position.set(pose.x - anchor_m.x, pose.y - anchor_m.y, ground_m - anchor_m.z);
    this.group.quaternion.set(...pose.quaternion);
    this.group.visible = true;
  }
}
