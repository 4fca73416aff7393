/** The relief: each column is a tile whose corners are the means of the heights that meet there, so that gaps stay gaps. */

export const UNKNOWN = -1e30;  // in textures, in place of NaN

export const vertexShader = /* glsl */ `
uniform sampler2D heights;
uniform ivec2 size;
uniform vec3 corner_m;
uniform float cell_m;
out vec2 v_cell;
out vec2 v_place_m;
out vec3 v_normal;
out float v_depth_m;

float height_at(ivec2 cell) {
  if (cell.x < 0 || cell.y < 0 || cell.x >= size.x || cell.y >= size.y) return -1e30;
  return texelFetch(heights, cell, 0).r;
}

void main() {
  ivec2 cell = ivec2(position.xy);
  vec4 around = vec4(height_at(cell + ivec2(-1, -1)), height_at(cell + ivec2(0, -1)),
                     height_at(cell + ivec2(-1, 0)), height_at(cell));
  vec4 known = vec4(greaterThan(around, vec4(-1e29)));
  float count = dot(known, vec4(1.0));
  float mean = count > 0.0 ? dot(mix(vec4(0.0), around, known), vec4(1.0)) / count : 0.0;
  vec4 h = mix(vec4(mean), around, known);
  v_normal = normalize(vec3(h.x + h.z - h.y - h.w, h.x + h.y - h.z - h.w, 2.0 * cell_m));
  v_cell = position.xy;
  v_place_m = position.xy * cell_m;
  vec4 seen = modelViewMatrix * vec4(corner_m.xy + v_place_m, mean - corner_m.z, 1.0);
  v_depth_m = -seen.z;
  gl_Position = projectionMatrix * seen;
}`;

export const fragmentShader = /* glsl */ `
precision highp float;
uniform sampler2D heights;
uniform sampler2D values;
uniform sampler2D marks;   // flags, visibility
uniform sampler2D colours;
uniform ivec2 size;
uniform vec2 range;
uniform float categories;  // 0: a colour map
uniform vec3 background;
uniform vec3 no_value;
uniform vec3 steep;
uniform vec2 lattice_m;    // the map's corner modulo the lattice
uniform bool shows_obstacles;
in vec2 v_cell;
in vec2 v_place_m;
in vec3 v_normal;
in float v_depth_m;
out vec4 colour;

const vec3 SUN = vec3(-0.56, 0.54, 0.63);
const float LATTICE_M = 10.0;

vec3 colour_of(float value) {
  if (value < -1e29) return no_value;
  if (categories > 0.0) return texelFetch(colours, ivec2(int(value + 0.5), 0), 0).rgb;
  float part = clamp((value - range.x) / (range.y - range.x), 0.0, 1.0);
  return texelFetch(colours, ivec2(int(part * 255.0 + 0.5), 0), 0).rgb;
}

float lattice() {
  vec2 place = (v_place_m + lattice_m) / LATTICE_M;
  vec2 near = abs(fract(place - 0.5) - 0.5) / fwidth(place);
  return 1.0 - clamp(min(near.x, near.y) - 0.3, 0.0, 1.0);
}

void main() {
  ivec2 cell = clamp(ivec2(floor(v_cell)), ivec2(0), size - 1);
  int flags = int(texelFetch(marks, cell, 0).r * 255.0 + 0.5);
  int visibility = int(texelFetch(marks, cell, 0).g * 255.0 + 0.5);
  if (texelFetch(heights, cell, 0).r < -1e29) discard;
  if (shows_obstacles && (flags & 4) != 0) discard;
  vec3 base = colour_of(texelFetch(values, cell, 0).r);
  if (shows_obstacles && (flags & 8) != 0 && fract((v_place_m.x + v_place_m.y) * 1.1) < 0.4) base = mix(base, steep, 0.85);
  float light = dot(normalize(v_normal), SUN);
  vec3 lit = base * (0.42 + 0.9 * max(light, 0.0)) + 0.05 * max(light - 0.6, 0.0);
  if (visibility == 4) lit = mix(lit, background, 0.5);
  lit = mix(lit, background, 0.22 * lattice());
  float edge = max(abs(v_cell.x / float(size.x) - 0.5), abs(v_cell.y / float(size.y) - 0.5)) * 2.0;
  float haze = max(0.55 * smoothstep(0.75, 1.0, edge), 0.5 * smoothstep(40.0, 110.0, v_depth_m));
  colour = vec4(mix(lit, background, haze), 1.0);
}`;
