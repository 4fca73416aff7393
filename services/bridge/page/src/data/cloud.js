/** Fields of a PointCloud2 by their names. */

const READERS = {
  1: (view, at) => view.getInt8(at),
  2: (view, at) => view.getUint8(at),
  3: (view, at, little) => view.getInt16(at, little),
  4: (view, at, little) => view.getUint16(at, little),
  5: (view, at, little) => view.getInt32(at, little),
  6: (view, at, little) => view.getUint32(at, little),
  7: (view, at, little) => view.getFloat32(at, little),
  8: (view, at, little) => view.getFloat64(at, little),
};
const BYTES = { 1: 1, 2: 1, 3: 2, 4: 2, 5: 4, 6: 4, 7: 4, 8: 8 };

/**
 * @param {object} message sensor_msgs/msg/PointCloud2
 * @param {string} name of the field
 * @returns {Float32Array | null} its value for each point; null if there is no such field
 */
export function cloud_field(message, name) {
  const field = message.fields.find((candidate) => candidate.name === name);
  if (!field) return null;
  const { width, height, point_step, row_step, data } = message;
  const read = READERS[field.datatype];
  if (width * height === 0) return new Float32Array(0);
  if (!read || field.offset + BYTES[field.datatype] > point_step)
    throw new Error(`field ${name}: type ${field.datatype} at ${field.offset} of ${point_step} bytes`);
  if ((height > 1 && row_step < width * point_step) || (height - 1) * row_step + width * point_step > data.length)
    throw new Error(`a cloud of ${width} x ${height} points in ${data.length} bytes`);
  const view = new DataView(data.buffer, data.byteOffset, data.length);
  const values = new Float32Array(width * height);
  for (let row = 0, i = 0; row < height; ++row)
    for (let column = 0; column < width; ++column)
      values[i++] = read(view, row * row_step + column * point_step + field.offset, !message.is_bigendian);
  return values;
}
