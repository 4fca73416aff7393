/** Draws the relief of a map, coloured by one of its layers. */
import * as THREE from 'three';
import { COLOUR_MAPS, colour_table, rgb_of } from './colour_map.js';
import { UNKNOWN, fragmentShader, vertexShader } from './ground_shader.js';
import { style_of, usual_range } from './layers.js';

const LATTICE_M = 10;
const RANGE_FOLLOWS = 0.15;  // of the way to the new range with each map: no flicker

function grid_geometry(columns, rows) {
  const places = new Float32Array(3 * (columns + 1) * (rows + 1));
  const corners = new Uint32Array(6 * columns * rows);
  for (let y = 0, i = 0; y <= rows; ++y) for (let x = 0; x <= columns; ++x, i += 3) places.set([x, y, 0], i);
  for (let y = 0, i = 0; y < rows; ++y)
    for (let x = 0; x < columns; ++x, i += 6) {
      const a = y * (columns + 1) + x;
      const c = a + columns + 1;
      corners.set([a, a + 1, c + 1, a, c + 1, c], i);
    }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(places, 3));
  geometry.setIndex(new THREE.BufferAttribute(corners, 1));
  return geometry;
}

function texture_of(array, columns, rows, format, type) {
  const texture = new THREE.DataTexture(array, columns, rows, format, type);
  texture.needsUpdate = true;
  return texture;
}

function colours_texture(style) {
  const table = style.categories
    ? Uint8Array.from(style.categories.flatMap(({ colour }) => [...rgb_of(colour), 255]))
    : colour_table(COLOUR_MAPS[style.map]);
  return texture_of(table, table.length / 4, 1, THREE.RGBAFormat, THREE.UnsignedByteType);
}

/** Copies values with UNKNOWN in place of NaN, and of the style's own unknown. */
function fill(to, values, style) {
  const category_of = style.category_of ?? ((value) => value);
  for (let i = 0; i < to.length; ++i) {
    const value = values[i];
    const known = value === value && value !== style.unknown;
    to[i] = known ? category_of(Math.min(1e9, value)) : UNKNOWN;
  }
}

export class Ground {
  constructor() {
    const uniforms = {
      heights: { value: null }, values: { value: null }, marks: { value: null }, colours: { value: null },
      size: { value: new THREE.Vector2() }, corner_m: { value: new THREE.Vector3() }, cell_m: { value: 1 },
      range: { value: new THREE.Vector2(0, 1) }, categories: { value: 0 }, lattice_m: { value: new THREE.Vector2() },
      background: { value: new THREE.Vector3() }, no_value: { value: new THREE.Vector3(0.5, 0.5, 0.5) },
      steep: { value: new THREE.Vector3() }, shows_obstacles: { value: true },
    };
    this.material = new THREE.ShaderMaterial({
      uniforms, vertexShader, fragmentShader, glslVersion: THREE.GLSL3, side: THREE.DoubleSide });
    this.mesh = new THREE.Mesh(new THREE.BufferGeometry(), this.material);
    this.mesh.frustumCulled = false;
    this.mesh.visible = false;
    this.uniforms = uniforms;
    this.set_layer('height');
  }

  /** Colours by this layer from the next map on. */
  set_layer(name) {
    this.layer = name;
    this.style = style_of(name);
    this.range = this.style.range ?? null;
    this.uniforms.colours.value?.dispose();
    this.uniforms.colours.value = colours_texture(this.style);
    this.uniforms.categories.value = this.style.categories?.length ?? 0;
  }

  /** @param {import('../data/layer_map.js').LayerMap} map @param {{x: number, y: number, z: number}} anchor_m of the scene in odom */
  show(map, anchor_m) {
    const height = map.layer('height');
    if (!height) return;
    this.fit(map.columns, map.rows);
    fill(this.heights.image.data, height, {});
    const values = map.layer(this.layer);
    if (values) fill(this.values.image.data, values, this.style);
    else this.values.image.data.fill(UNKNOWN);
    this.mark(map);
    for (const texture of [this.heights, this.values, this.marks]) texture.needsUpdate = true;
    this.follow_range(values);
    const { x, y } = map.origin_m;
    this.uniforms.corner_m.value.set(x - anchor_m.x, y - anchor_m.y, anchor_m.z);
    this.uniforms.lattice_m.value.set(x - LATTICE_M * Math.floor(x / LATTICE_M), y - LATTICE_M * Math.floor(y / LATTICE_M));
    this.uniforms.cell_m.value = map.cell_m;
    this.mesh.visible = true;
  }

  mark(map) {
    const flags = map.layer('flags');
    const visibility = map.layer('visibility');
    const to = this.marks.image.data;
    for (let i = 0; i < map.columns * map.rows; ++i) {
      to[2 * i] = flags?.[i] ?? 0;
      to[2 * i + 1] = visibility?.[i] ?? 0;
    }
  }

  follow_range(values) {
    if (!this.style.range && values) {
      const now = usual_range(values);
      if (now) this.range = this.range?.map((old, i) => old + RANGE_FOLLOWS * (now[i] - old)) ?? now;
    }
    if (this.range) this.uniforms.range.value.set(...this.range);
  }

  /** Textures and mesh for a map of that size. */
  fit(columns, rows) {
    if (this.uniforms.size.value.x === columns && this.uniforms.size.value.y === rows) return;
    for (const texture of [this.heights, this.values, this.marks]) texture?.dispose();
    this.heights = texture_of(new Float32Array(columns * rows), columns, rows, THREE.RedFormat, THREE.FloatType);
    this.values = texture_of(new Float32Array(columns * rows), columns, rows, THREE.RedFormat, THREE.FloatType);
    this.marks = texture_of(new Uint8Array(2 * columns * rows), columns, rows, THREE.RGFormat, THREE.UnsignedByteType);
    this.marks.unpackAlignment = 1;
    this.uniforms.heights.value = this.heights;
    this.uniforms.values.value = this.values;
    this.uniforms.marks.value = this.marks;
    this.uniforms.size.value.set(columns, rows);
    this.mesh.geometry.dispose();
    this.mesh.geometry = grid_geometry(columns, rows);
  }
}
