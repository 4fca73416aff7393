/** Many upright boxes of one ground area, each with its own place, height and colour: obstacles and voxels. */
import * as THREE from 'three';

const vertexShader = /* glsl */ `
in vec4 place;      // centre x, y; bottom, height
in vec3 tint;
uniform float width_m;
out vec3 v_tint;
out vec3 v_normal;
out float v_up;
out float v_depth_m;
void main() {
  v_tint = tint;
  v_normal = normal;
  v_up = position.z + 0.5;
  vec3 at = vec3(place.xy + position.xy * width_m, place.z + v_up * place.w);
  vec4 seen = modelViewMatrix * vec4(at, 1.0);
  v_depth_m = -seen.z;
  gl_Position = projectionMatrix * seen;
}`;

const fragmentShader = /* glsl */ `
precision highp float;
uniform vec3 background;
in vec3 v_tint;
in vec3 v_normal;
in float v_up;
in float v_depth_m;
out vec4 colour;
void main() {
  float face = v_normal.z > 0.5 ? 1.08 : 0.74 + 0.16 * dot(v_normal.xy, vec2(-0.72, 0.7));
  vec3 lit = v_tint * face * mix(0.72, 1.0, v_up);
  colour = vec4(mix(lit, background, 0.5 * smoothstep(40.0, 110.0, v_depth_m)), 1.0);
}`;

export class Boxes {
  constructor() {
    this.material = new THREE.ShaderMaterial({
      uniforms: { width_m: { value: 1 }, background: { value: new THREE.Vector3() } },
      vertexShader, fragmentShader, glslVersion: THREE.GLSL3 });
    this.mesh = new THREE.Mesh(new THREE.InstancedBufferGeometry(), this.material);
    this.mesh.frustumCulled = false;
    this.reserve(1024);
  }

  reserve(boxes) {
    this.mesh.geometry.dispose();
    const geometry = new THREE.InstancedBufferGeometry();
    const box = new THREE.BoxGeometry(1, 1, 1);
    geometry.setIndex(box.index);
    geometry.setAttribute('position', box.attributes.position);
    geometry.setAttribute('normal', box.attributes.normal);
    this.places = new THREE.InstancedBufferAttribute(new Float32Array(4 * boxes), 4).setUsage(THREE.DynamicDrawUsage);
    this.tints = new THREE.InstancedBufferAttribute(new Float32Array(3 * boxes), 3).setUsage(THREE.DynamicDrawUsage);
    geometry.setAttribute('place', this.places);
    geometry.setAttribute('tint', this.tints);
    geometry.instanceCount = 0;
    this.mesh.geometry = geometry;
    this.room = boxes;
  }

  /** @param {number} most boxes that will come @param {number} width_m of each */
  begin(most, width_m) {
    if (most > this.room) this.reserve(Math.ceil(1.5 * most));
    this.material.uniforms.width_m.value = width_m;
    this.count = 0;
  }

  /** @param {number[]} tint red, green, blue, 0 .. 1 */
  add(x, y, bottom, height, tint) {
    this.places.array.set([x, y, bottom, height], 4 * this.count);
    this.tints.array.set(tint, 3 * this.count);
    this.count += 1;
  }

  end() {
    this.mesh.geometry.instanceCount = this.count;
    for (const attribute of [this.places, this.tints]) {
      attribute.clearUpdateRanges();
      attribute.addUpdateRange(0, this.count * attribute.itemSize);
      attribute.needsUpdate = true;
    }
  }
}
