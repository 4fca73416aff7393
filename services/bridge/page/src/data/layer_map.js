/** One map: layers of values, indexed [y][x] from the grid's corner, out of foxglove_msgs/msg/Grid. */

const READERS = {
  1: [Uint8Array, 1, (view, at) => view.getUint8(at)],
  2: [Int8Array, 1, (view, at) => view.getInt8(at)],
  3: [Uint16Array, 2, (view, at) => view.getUint16(at, true)],
  4: [Int16Array, 2, (view, at) => view.getInt16(at, true)],
  5: [Uint32Array, 4, (view, at) => view.getUint32(at, true)],
  6: [Int32Array, 4, (view, at) => view.getInt32(at, true)],
  7: [Float32Array, 4, (view, at) => view.getFloat32(at, true)],
  8: [Float64Array, 8, (view, at) => view.getFloat64(at, true)],
};
const MOST_COLUMNS = 2048;  // along x and y, as far as a texture reaches on any phone

function check_size(grid, columns, rows) {
  if (!(columns > 0 && columns <= MOST_COLUMNS && rows > 0 && rows <= MOST_COLUMNS))
    throw new Error(`a grid of ${columns} x ${rows} columns: 1 to ${MOST_COLUMNS} are drawn`);
  if (!(grid.cell_size.x > 0) || !(grid.cell_size.y > 0)) throw new Error('a grid whose cells have no size');
  if ((columns - 1) * grid.cell_stride + (rows - 1) * grid.row_stride + grid.cell_stride > grid.data.length)
    throw new Error(`a grid of ${columns} x ${rows} columns in ${grid.data.length} bytes`);
}

function unpack(grid, field, columns, rows) {
  const reader = READERS[field.type];
  if (!reader || field.offset + reader[1] > grid.cell_stride)
    throw new Error(`layer ${field.name}: type ${field.type} at ${field.offset} of ${grid.cell_stride} bytes`);
  const [ArrayType, , read] = reader;
  const view = new DataView(grid.data.buffer, grid.data.byteOffset, grid.data.length);
  const values = new ArrayType(columns * rows);
  for (let y = 0, i = 0; y < rows; ++y)
    for (let x = 0, at = y * grid.row_stride + field.offset; x < columns; ++x, at += grid.cell_stride)
      values[i++] = read(view, at);
  return values;
}

/**
 * @typedef {object} LayerMap
 * @property {number} columns along x
 * @property {number} rows along y
 * @property {number} cell_m
 * @property {{x: number, y: number, z: number}} origin_m in odom, the corner of column (0, 0)
 * @property {string} frame
 * @property {string[]} names of its layers
 * @property {(name: string) => (ArrayLike<number> | undefined)} layer [y][x]; unknown is NaN in float layers
 */

/** Layers are taken out of the message when they are first asked for. @returns {LayerMap} */
export function layer_map_of(grid) {
  const columns = grid.column_count;
  const rows = Math.floor(grid.data.length / (grid.row_stride || columns * grid.cell_stride));
  check_size(grid, columns, rows);
  const fields = new Map(grid.fields.map((field) => [field.name, field]));
  const layers = new Map();
  return {
    columns,
    rows,
    cell_m: grid.cell_size.x,
    origin_m: grid.pose.position,
    frame: grid.frame_id,
    names: [...fields.keys()],
    layer(name) {
      if (!layers.has(name) && fields.has(name)) layers.set(name, unpack(grid, fields.get(name), columns, rows));
      return layers.get(name);
    },
  };
}

/** The value of a layer at a place in odom, NaN outside. */
export function value_at(map, name, x_m, y_m) {
  const x = Math.floor((x_m - map.origin_m.x) / map.cell_m);
  const y = Math.floor((y_m - map.origin_m.y) / map.cell_m);
  const inside = x >= 0 && y >= 0 && x < map.columns && y < map.rows;
  return inside ? map.layer(name)?.[y * map.columns + x] ?? NaN : NaN;
}
