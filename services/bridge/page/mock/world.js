/** A synthetic country: hills, a wood, bushes, a wall, a ditch, a steep bank; and the way that the vehicle takes. */

export const CELL_M = 0.4;
export const COUNTRY = { columns: 700, rows: 420, x_m: -80, y_m: -84 };  // 280 m x 168 m

export const HARD = 1, SOFT = 2, NEGATIVE = 4, STEEP = 8;

/** Numbers in [0, 1) from whole numbers, always the same. */
function noise(x, y) {
  let h = Math.imul(x, 374761393) + Math.imul(y, 668265263);
  h = Math.imul(h ^ (h >>> 13), 1274126177);
  return ((h ^ (h >>> 16)) >>> 0) / 2 ** 32;
}

/** A bend that swings around the x axis, along which the vehicle drives and holds the ground gentle. */
export function way_at(s_m) {
  const x = s_m;
  const y = 9 * Math.sin(s_m / 22);
  return { x, y, yaw_rad: Math.atan2((9 / 22) * Math.cos(s_m / 22), 1) };
}

const ditch_x = (y) => 66 + 0.12 * y;

export function ground_m(x, y) {
  const hills = 1.6 * Math.sin(x / 17 + 1) * Math.cos(y / 23) + 2.6 * Math.sin(x / 41 - y / 29) + 0.5 * Math.sin(x / 6.1 + y / 7.3);
  const off_way = y - way_at(x).y;
  const bank = 3.2 / (1 + Math.exp(-(off_way - 17) / 0.9)) * Math.exp(-(((x - 30) / 45) ** 2));
  return hills + bank + 0.03 * (noise(Math.floor(x / 0.4), Math.floor(y / 0.4)) - 0.5);
}

const things = [];
for (let i = 0; i < 260; ++i) {
  const x = COUNTRY.x_m + 280 * noise(i, 1);
  const y = COUNTRY.y_m + 168 * noise(i, 2);
  const kind = noise(i, 3);
  const off_way = Math.abs(y - way_at(x).y);
  if (off_way < 4.5) continue;
  const wood = y > 8 && x > 10 ? 1 : 0.62;
  if (kind < 0.45 * wood) things.push({ x, y, radius: 0.35, height: 5 + 6 * noise(i, 4), flag: HARD, crown: 1.6 + noise(i, 5) });
  else if (kind < 0.8) things.push({ x, y, radius: 0.6 + 1.3 * noise(i, 4), height: 0.7 + 0.9 * noise(i, 5), flag: SOFT });
  else things.push({ x, y, radius: 0.4 + 0.6 * noise(i, 4), height: 0.5 + 0.8 * noise(i, 5), flag: HARD });
}

/** Arrays [y][x] over the country: ground in metres (NaN in the ditch), what stands on it, slope in m/m along x and y. */
export function make_country() {
  const { columns, rows, x_m, y_m } = COUNTRY;
  const cells = columns * rows;
  const country = {
    ground: new Float32Array(cells), top: new Float32Array(cells), crown: new Float32Array(cells), flags: new Uint8Array(cells),
    slope_x: new Float32Array(cells), slope_y: new Float32Array(cells), depth: new Float32Array(cells),
  };
  for (let row = 0, i = 0; row < rows; ++row)
    for (let column = 0; column < columns; ++column, ++i) {
      const x = x_m + (column + 0.5) * CELL_M;
      const y = y_m + (row + 0.5) * CELL_M;
      country.ground[i] = ground_m(x, y);
      country.slope_x[i] = (ground_m(x + 0.6, y) - ground_m(x - 0.6, y)) / 1.2;
      country.slope_y[i] = (ground_m(x, y + 0.6) - ground_m(x, y - 0.6)) / 1.2;
      if (Math.hypot(country.slope_x[i], country.slope_y[i]) > 0.58) country.flags[i] |= STEEP;
      if (Math.abs(x - ditch_x(y)) < 1.1 && y > -44 && y < way_at(x).y - 5) {
        country.flags[i] = NEGATIVE;
        country.depth[i] = 1.3 + 0.3 * noise(column, row);
      }
      if (x > 38 && x < 52 && Math.abs(y + 19) < 0.5) add(country, i, HARD, 2.2);
    }
  for (const thing of things) plant(country, thing);
  return country;
}

function add(country, i, flag, top) {
  country.flags[i] |= flag;
  country.top[i] = Math.max(country.top[i], top);
}

function plant(country, { x, y, radius, height, flag, crown = 0 }) {
  const reach = Math.max(radius, crown);
  const column_of = (value) => Math.floor((value - COUNTRY.x_m) / CELL_M);
  const row_of = (value) => Math.floor((value - COUNTRY.y_m) / CELL_M);
  for (let row = row_of(y - reach); row <= row_of(y + reach); ++row)
    for (let column = column_of(x - reach); column <= column_of(x + reach); ++column) {
      if (row < 0 || column < 0 || row >= COUNTRY.rows || column >= COUNTRY.columns) continue;
      const off = Math.hypot(COUNTRY.x_m + (column + 0.5) * CELL_M - x, COUNTRY.y_m + (row + 0.5) * CELL_M - y);
      const i = row * COUNTRY.columns + column;
      if (country.flags[i] & NEGATIVE) continue;
      if (off < radius + 0.15) add(country, i, flag, height * (flag === SOFT ? 1 - 0.4 * (off / radius) ** 2 : 1));
      if (off < crown) country.crown[i] = Math.max(country.crown[i], height * (1 - 0.25 * (off / crown) ** 2));
    }
}

export { noise };
