// Messages by the text of their schema alone, with Foxglove's own reader.
import rosmsg from '@foxglove/rosmsg';
import serialization from '@foxglove/rosmsg2-serialization';

/** A function of CDR bytes that gives the message as an object. Throws if the schema cannot be read. */
export function decoder(schema_text) {
  const reader = new serialization.MessageReader(rosmsg.parse(schema_text, { ros2: true }));
  return (bytes) => reader.readMessage(bytes);
}

/** A stamp of ROS in nanoseconds. */
export function stamp_ns(time) {
  return BigInt(time.sec) * 1_000_000_000n + BigInt(time.nsec ?? time.nanosec);
}

/** By a field's type in foxglove_msgs/PackedElementField. A cloud has float32 alone, the same number in PointField. */
const READ = { 1: (view, at) => view.getUint8(at), 7: (view, at) => view.getFloat32(at, true) };

/** Columns by name: {height: [..], cost: [..]}. */
function unpacked(data, count, step_bytes, fields) {
  const view = new DataView(data.buffer, data.byteOffset, data.byteLength);
  const columns = {};
  for (const { name, type, offset } of fields) {
    columns[name] = Array.from({ length: count }, (_, i) => READ[type](view, i * step_bytes + offset));
  }
  return columns;
}

/** The layers of a foxglove_msgs/Grid, [y][x]. */
export function grid_layers(grid) {
  const rows = grid.data.length / grid.row_stride;
  return unpacked(grid.data, rows * grid.column_count, grid.cell_stride, grid.fields);
}

/** The fields of a sensor_msgs/PointCloud2. */
export function cloud_fields(cloud) {
  const fields = cloud.fields.map(({ name, offset, datatype }) => ({ name, offset, type: datatype }));
  return unpacked(cloud.data, cloud.width * cloud.height, cloud.point_step, fields);
}
