/** A map as the history keeps it: floats in 16 bits, heights relative to a height near by. */
import { pack_halves, unpack_halves } from './half.js';

const HEIGHTS = new Set(['height', 'inferred_height']);

const zero_of = (name, near_z_m) => (HEIGHTS.has(name) ? near_z_m : 0);

const keeps_bytes = (values) => values.BYTES_PER_ELEMENT === 1;

/** How many bytes pack_map() will take at most, told without a look at the values. @param {import('./layer_map.js').LayerMap} map */
export function packed_bytes(map) {
  return map.columns * map.rows * map.names.length * 2;
}

/** Apart from pack_map(): a function keeps all that the one around it has, and there that is the whole message. */
function reader_of(planes, near_z_m) {
  return (name) => {
    const plane = planes.get(name);
    return plane && !keeps_bytes(plane) ? unpack_halves(plane, zero_of(name, near_z_m)) : plane;
  };
}

/**
 * @param {import('./layer_map.js').LayerMap} map
 * @param {number} near_z_m in odom: heights are kept to a millimetre or two within 4 m of it, to 3 cm within 64 m
 * @returns {import('./layer_map.js').LayerMap} the same map, without the message that it came in
 */
export function pack_map(map, near_z_m) {
  const planes = new Map(map.names.map((name) => {
    const values = map.layer(name);
    return [name, keeps_bytes(values) ? values : pack_halves(values, zero_of(name, near_z_m))];
  }));
  return { ...map, layer: reader_of(planes, near_z_m) };
}
