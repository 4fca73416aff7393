/** Makes a reader of CDR messages out of a `ros2msg` text, so that fields are found by their names, whatever their order. */
import { CdrReader } from './cdr.js';

const NUMBERS = {
  bool: 1, byte: 1, char: 1, int8: 1, uint8: 1, int16: 2, uint16: 2,
  int32: 4, uint32: 4, int64: 8, uint64: 8, float32: 4, float64: 8,
};
const METHODS = { byte: 'uint8', char: 'uint8' };
const TIME = 'int32 sec\nuint32 nanosec';

/** `pkg/msg/Name` and `pkg/Name` are the same type; `Name` alone is of the same package as where it is used. */
function full_name(type, home) {
  if (type === 'Header') return 'std_msgs/Header';
  if (type === 'time' || type === 'duration') return 'builtin_interfaces/Time';
  const parts = type.split('/');
  return parts.length === 1 ? `${home.split('/')[0]}/${type}` : `${parts[0]}/${parts.at(-1)}`;
}

function parse_field(line, home) {
  const match = /^([A-Za-z][\w/]*)(?:<=\d+)?(?:\[(<=)?(\d*)\])?\s+([A-Za-z]\w*)\s*(=)?/.exec(line);
  if (!match) throw new Error(`not a field: "${line}"`);
  const [, base, bounded, length, name, is_constant] = match;
  if (is_constant) return null;
  const type = base in NUMBERS || base === 'string' || base === 'wstring' ? base : full_name(base, home);
  const array = length === undefined ? null : length === '' || bounded ? 'sequence' : Number(length);
  return { name, type, array };
}

function parse_fields(text, home) {
  const lines = text.split('\n').map((line) => line.replace(/#.*/, '').trim()).filter(Boolean);
  return lines.map((line) => parse_field(line, home)).filter(Boolean);
}

/** All types of a schema, by their full names. */
function parse_types(schema_name, text) {
  const [main, ...others] = text.replaceAll('\r', '').split(/^={10,}\n/m);
  const home = full_name(schema_name, '');
  const types = new Map([['builtin_interfaces/Time', parse_fields(TIME, '')], [home, parse_fields(main, home)]]);
  for (const part of others) {
    const head = /^MSG:\s*(\S+)[^\n]*\n?/.exec(part);
    if (!head) throw new Error('a part of the schema has no "MSG:" line');
    const name = full_name(head[1], '');
    types.set(name, parse_fields(part.slice(head[0].length), name));
  }
  types.set('builtin_interfaces/Duration', types.get('builtin_interfaces/Time'));
  return { home, types };
}

function compile_array(field, element, element_bytes) {
  const count = (cdr) => (field.array === 'sequence' ? cdr.count(element_bytes) : field.array);
  if (NUMBERS[field.type] === 1 && field.type !== 'bool') return (cdr) => cdr.octets(count(cdr));
  return (cdr) => Array.from({ length: count(cdr) }, () => element(cdr));
}

function compile_type(name, types, above) {
  const fields = types.get(name);
  if (!fields) throw new Error(`the schema lacks ${name}`);
  if (above.includes(name)) throw new Error(`${name} contains itself`);
  const readers = fields.map((field) => {
    const method = METHODS[field.type] ?? field.type;
    const element = field.type in NUMBERS || field.type === 'string'
      ? (cdr) => cdr[method]()
      : compile_type(field.type, types, [...above, name]);
    return [field.name, field.array === null ? element : compile_array(field, element, NUMBERS[field.type] ?? 1)];
  });
  return (cdr) => {
    const message = {};
    for (const [field, read] of readers) message[field] = read(cdr);
    return message;
  };
}

/**
 * @param {string} schema_name like "nav_msgs/msg/Path"
 * @param {string} text its definition, those that it needs after lines of "="
 * @returns {(bytes: Uint8Array) => object} throws on a message that does not fit; 64-bit integers are BigInts, octets views
 */
export function reader_of(schema_name, text) {
  const { home, types } = parse_types(schema_name, text);
  const read = compile_type(home, types, []);
  return (bytes) => read(new CdrReader(bytes));
}
