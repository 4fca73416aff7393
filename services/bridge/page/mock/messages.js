/** The messages of the mock as CDR. */
import { CdrWriter } from './cdr_writer.js';

const FRAME = 'odom';
const FLOAT32 = 7;
const UINT8 = 1;

/**
 * foxglove_msgs/msg/Grid with the layers of a cell one after the other.
 * @param {{stamp_s: number, origin_m: number[], cell_m: number, size: number, layers: Map<string, Float32Array | Uint8Array>}} map
 */
export function grid_message({ stamp_s, origin_m, cell_m, size, layers }) {
  const cdr = new CdrWriter();
  const seconds = Math.floor(stamp_s);
  cdr.int32(seconds).uint32(Math.round((stamp_s - seconds) * 1e9)).string(FRAME);
  cdr.float64(...origin_m, 0, 0, 0, 1);
  let used = 0;
  const fields = [...layers].map(([name, values]) => {
    const offset = used;
    used += values.BYTES_PER_ELEMENT;
    return { name, offset, values, is_float: values.BYTES_PER_ELEMENT === 4 };
  });
  const cell_bytes = 4 * Math.ceil(used / 4);
  cdr.uint32(size).float64(cell_m, cell_m).uint32(size * cell_bytes).uint32(cell_bytes).uint32(fields.length);
  for (const { name, offset, is_float } of fields) cdr.string(name).uint32(offset).uint8(is_float ? FLOAT32 : UINT8);
  const data = new Uint8Array(size * size * cell_bytes);
  const floats = new Float32Array(data.buffer);
  for (const { offset, values, is_float } of fields) {
    const to = is_float ? floats : data;
    const step = cell_bytes / to.BYTES_PER_ELEMENT;
    for (let i = 0, at = offset / to.BYTES_PER_ELEMENT; i < values.length; ++i, at += step) to[at] = values[i];
  }
  return cdr.octets(data).done();
}

/** sensor_msgs/msg/PointCloud2. @param {string[]} names of the fields @param {Float32Array} values point by point */
export function cloud_message(stamp_s, names, values) {
  const cdr = new CdrWriter().header(stamp_s, FRAME);
  const step = 4 * names.length;
  const points = values.length / names.length;
  cdr.uint32(1).uint32(points).uint32(names.length);
  names.forEach((name, i) => cdr.string(name).uint32(4 * i).uint8(FLOAT32).uint32(1));
  cdr.uint8(0).uint32(step).uint32(step * points);
  return cdr.octets(new Uint8Array(values.buffer, values.byteOffset, values.byteLength)).uint8(1).done();
}

/** nav_msgs/msg/Path. @param {{x: number, y: number, z: number}[]} way metres */
export function path_message(stamp_s, way) {
  const cdr = new CdrWriter().header(stamp_s, FRAME).uint32(way.length);
  for (const { x, y, z } of way) cdr.header(stamp_s, FRAME).float64(x, y, z, 0, 0, 0, 1);
  return cdr.done();
}

/** tf2_msgs/msg/TFMessage from odom to base_link. @param {{x: number, y: number, z: number, yaw_rad: number}} pose */
export function tf_message(stamp_s, { x, y, z, yaw_rad }) {
  const cdr = new CdrWriter().uint32(1).header(stamp_s, FRAME).string('base_link');
  return cdr.float64(x, y, z, 0, 0, Math.sin(yaw_rad / 2), Math.cos(yaw_rad / 2)).done();
}
