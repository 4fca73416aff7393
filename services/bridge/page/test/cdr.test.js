import assert from 'node:assert/strict';
import test from 'node:test';
import { CdrReader } from '../src/wire/cdr.js';
import { reader_of } from '../src/wire/schema.js';
import { SCHEMAS } from '../mock/schemas.js';
import { path_message, tf_message } from '../mock/messages.js';

const bytes = (...values) => Uint8Array.from(values);

test('fields are aligned to their size, counted from after the head', () => {
  const cdr = new CdrReader(bytes(0, 1, 0, 0, 7, 0, 0, 0, 42, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xf0, 0x3f));
  assert.equal(cdr.uint8(), 7);
  assert.equal(cdr.uint32(), 42);
  assert.equal(cdr.uint8(), 1);
  assert.throws(() => cdr.float64(), /ends at byte 24, 8 more are needed at 20/);
});

test('big endian is read too, another representation is refused', () => {
  assert.equal(new CdrReader(bytes(0, 0, 0, 0, 0, 0, 1, 2)).uint32(), 258);
  assert.throws(() => new CdrReader(bytes(0, 7, 0, 0, 1)), /head is unknown/);
  assert.throws(() => new CdrReader(bytes(0, 1)), /head is unknown/);
});

test('a string ends before its NUL, an empty one may have none', () => {
  assert.equal(new CdrReader(bytes(0, 1, 0, 0, 3, 0, 0, 0, 111, 107, 0)).string(), 'ok');
  assert.equal(new CdrReader(bytes(0, 1, 0, 0, 0, 0, 0, 0)).string(), '');
});

test('a count that cannot be is refused before anything is allocated', () => {
  assert.throws(() => new CdrReader(bytes(0, 1, 0, 0, 255, 255, 255, 255, 1)).count(1), /4294967295 elements/);
});

test('a schema is read with comments, constants, defaults, bounds and types of the same package', () => {
  const line = '='.repeat(80);
  const read = reader_of('a/msg/Main', `# a comment
uint8 KIND=3
Inner[] inner   # two of them
uint8[<=8] some
float32[2] pair
string name "default"
${line}
MSG: a/Inner
int16 value -1
`);
  const message = bytes(0, 1, 0, 0,
    2, 0, 0, 0, 5, 0, 0xff, 0xff,        // inner: 5, -1
    3, 0, 0, 0, 7, 8, 9, 0,              // some, and one byte up to the next
    0, 0, 0x80, 0x3f, 0, 0, 0, 0x40,     // pair: 1, 2
    2, 0, 0, 0, 120, 0);                 // name
  assert.deepEqual(read(message), { inner: [{ value: 5 }, { value: -1 }], some: bytes(7, 8, 9), pair: [1, 2], name: 'x' });
});

test('schemas that cannot be read say why', () => {
  assert.throws(() => reader_of('a/msg/Main', 'Other other'), /the schema lacks a\/Other/);
  assert.throws(() => reader_of('a/msg/Main', 'Main again'), /a\/Main contains itself/);
  assert.throws(() => reader_of('a/msg/Main', '!'), /not a field/);
});

test('messages of ROS types arrive as they were written', () => {
  const path = reader_of('nav_msgs/msg/Path', SCHEMAS['nav_msgs/msg/Path'])(path_message(12.5, [{ x: 1, y: -2, z: 0.5 }]));
  assert.deepEqual(path.header, { stamp: { sec: 12, nanosec: 500000000 }, frame_id: 'odom' });
  assert.deepEqual(path.poses.map(({ pose }) => pose.position), [{ x: 1, y: -2, z: 0.5 }]);
  const tf = reader_of('tf2_msgs/msg/TFMessage', SCHEMAS['tf2_msgs/msg/TFMessage'])(tf_message(3, { x: 4, y: 5, z: 6, yaw_rad: 0 }));
  assert.equal(tf.transforms[0].child_frame_id, 'base_link');
  assert.deepEqual(tf.transforms[0].transform.rotation, { x: 0, y: 0, z: 0, w: 1 });
});

test('every cut of a message is refused, none is read beyond its end', () => {
  const whole = path_message(1, [{ x: 1, y: 2, z: 3 }, { x: 4, y: 5, z: 6 }]);
  const read = reader_of('nav_msgs/msg/Path', SCHEMAS['nav_msgs/msg/Path']);
  for (let length = 0; length < whole.length; ++length) assert.throws(() => read(whole.subarray(0, length)), Error);
});
