import assert from 'node:assert/strict';
import test from 'node:test';
import { Connection } from '../src/wire/connection.js';

/** A socket that the test plays the server of. */
class FakeSocket {
  constructor() { this.sent = []; }
  send(text) { this.sent.push(JSON.parse(text)); }
  close() { this.onclose?.(); }
  say(message) { this.onmessage({ data: JSON.stringify(message) }); }
  data(id, text) {
    const bytes = new Uint8Array(13 + text.length);
    const view = new DataView(bytes.buffer);
    view.setUint8(0, 1);
    view.setUint32(1, id, true);
    view.setBigUint64(5, 77n, true);
    bytes.set(new TextEncoder().encode(text), 13);
    this.onmessage({ data: bytes.buffer });
  }
}

const CHANNELS = [{ id: 4, topic: '/a', encoding: 'json' }, { id: 9, topic: '/b', encoding: 'json' }, { id: 5, topic: '/c', encoding: 'protobuf' }];

function connected(wanted, heard = []) {
  const sockets = [];
  const timers = [];
  const connection = new Connection('ws://x', {
    open_socket: () => { sockets.push(new FakeSocket()); return sockets.at(-1); },
    after: (wait_ms, act) => timers.push({ wait_ms, act }),
    on_message: (topic, message, stamp_ns) => heard.push([topic, message, stamp_ns]) });
  connection.want(wanted);
  sockets[0].onopen();
  sockets[0].say({ op: 'advertise', channels: CHANNELS });
  return { connection, sockets, timers, heard };
}

test('what is wanted is subscribed when it is offered, once', (t) => {
  const { connection, sockets } = connected(['/a', '/missing']);
  t.after(() => connection.close());
  sockets[0].say({ op: 'serverInfo', name: 'gvom' });
  assert.deepEqual(sockets[0].sent, [{ op: 'subscribe', subscriptions: [{ id: 1, channelId: 4 }] }]);
  assert.equal(connection.server_name, 'gvom');
});

test('what is not wanted any more is unsubscribed, and what is still on its way is dropped', (t) => {
  const { connection, sockets, heard } = connected(['/a', '/b']);
  t.after(() => connection.close());
  connection.want(['/b']);
  assert.deepEqual(sockets[0].sent.at(-1), { op: 'unsubscribe', subscriptionIds: [1] });
  sockets[0].data(1, '{}');
  sockets[0].data(2, '{"x":1}');
  assert.deepEqual(heard, [['/b', { x: 1 }, 77n]]);
});

test('a lost connection is made anew, and its topics are subscribed anew', () => {
  const { connection, sockets, timers } = connected(['/a']);
  sockets[0].onclose();
  assert.equal(connection.connected, false);
  for (let i = 0; i < 5; ++i) {
    timers[i].act();
    sockets[i + 1].onclose();  // refused
  }
  assert.deepEqual(timers.map(({ wait_ms }) => wait_ms), [500, 1000, 2000, 4000, 5000, 5000]);
  timers[5].act();
  sockets[6].onopen();
  sockets[6].say({ op: 'advertise', channels: CHANNELS });
  assert.deepEqual(sockets[6].sent, [{ op: 'subscribe', subscriptions: [{ id: 2, channelId: 4 }] }]);
  connection.close();
  assert.equal(timers.length, 6);  // closed by us: not again
});

test('garbage is counted and harms nothing', (t) => {
  t.mock.method(console, 'warn', () => {});
  const { connection, sockets, heard } = connected(['/a', '/c']);
  t.after(() => connection.close());
  assert.equal(connection.bad_messages, 1);  // /c is in an encoding that is not known
  sockets[0].onmessage({ data: 'no JSON' });
  sockets[0].data(1, 'no JSON');
  sockets[0].onmessage({ data: new ArrayBuffer(3) });
  assert.equal(connection.bad_messages, 3);
  sockets[0].data(1, '2');
  assert.deepEqual(heard, [['/a', 2, 77n]]);
});

test('a channel that is withdrawn and offered again is subscribed again', (t) => {
  const { connection, sockets } = connected(['/a']);
  t.after(() => connection.close());
  sockets[0].say({ op: 'unadvertise', channelIds: [4] });
  assert.equal(connection.offers('/a'), false);
  sockets[0].say({ op: 'advertise', channels: [{ id: 40, topic: '/a', encoding: 'json' }] });
  assert.deepEqual(sockets[0].sent.at(-1), { op: 'subscribe', subscriptions: [{ id: 2, channelId: 40 }] });
});

/** The machine may pause: the link's clock stands. */
function stop_clock(t) {
  const now_ms = performance.now();
  t.mock.method(performance, 'now', () => now_ms);
}

test('a link of which nothing comes for ten seconds is given up and made anew', (t) => {
  stop_clock(t);
  const { connection, sockets, timers } = connected(['/a']);
  connection.watch(performance.now() + 5000);
  assert.equal(connection.connected, true);
  connection.watch(performance.now() + 11000);
  connection.watch(performance.now() + 12000);
  assert.equal(connection.connected, false);
  assert.equal(timers.length, 1);
  timers[0].act();
  assert.equal(sockets.length, 2);
  connection.close();
});

test('a link that is too slow for a map within that is given more time, until one has come', (t) => {
  stop_clock(t);
  const { connection, sockets, timers } = connected(['/a']);
  t.after(() => connection.close());
  const gives_up_after_s = (silent_s) => {
    connection.watch(performance.now() + 1000 * silent_s);
    return !connection.connected;
  };
  const again = () => {
    timers.at(-1).act();
    sockets.at(-1).onopen();
    sockets.at(-1).say({ op: 'advertise', channels: CHANNELS });
  };
  for (const patience_s of [10, 20, 40, 60, 60]) {
    assert.equal(gives_up_after_s(patience_s - 1), false);
    assert.equal(gives_up_after_s(patience_s + 1), true);
    again();
  }
  sockets.at(-1).onmessage({ data: '{}' });
  assert.equal(gives_up_after_s(50), false);  // small ones say nothing of that
  sockets.at(-1).onmessage({ data: new ArrayBuffer(3_000_000) });
  assert.equal(gives_up_after_s(11), true);
});
