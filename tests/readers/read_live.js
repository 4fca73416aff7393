// read_live.js PORT SUBPROTOCOL SIZE_XY TOPICS: connects to a running bridge with Foxglove's own client, subscribes to
// all channels, and checks what comes until each of TOPICS (between commas) has come.
import assert from 'node:assert/strict';
import protocol from '@foxglove/ws-protocol';
import { WebSocket } from 'ws';
import { check_drive, PROCESSES } from './check_drive.js';
import { decoder, stamp_ns } from './decode.js';
import { with_grid } from './drive_checks.js';

const PATIENCE_MS = 30_000;
const OF_LAYERS = ['/gvom/costmap', '/gvom/points', '/gvom/grid_map'];

/** The client looks for its own subprotocol and knows no other; both mean the same messages. */
function connected(port, subprotocol) {
  const socket = new WebSocket(`ws://127.0.0.1:${port}`, [subprotocol]);
  socket.once('open', () => assert.equal(socket.protocol, subprotocol));
  return new protocol.FoxgloveClient({ ws: socket });
}

function decoder_of(channel) {
  if (channel.encoding === 'json') return (data) => JSON.parse(new TextDecoder().decode(data));
  assert.equal(channel.encoding, 'cdr');
  assert.equal(channel.schemaEncoding, 'ros2msg');
  return decoder(channel.schema);
}

/** Whether each topic has come: those of layers with layers of their moment, diagnostics of all processes. */
function complete(messages, topics) {
  const grids = messages.get('/gvom/layers') ?? [];
  return topics.every((topic) => {
    const list = messages.get(topic) ?? [];
    if (topic === '/diagnostics') return PROCESSES.every((name) => list.at(-1)?.status.some((one) => one.name === name));
    return OF_LAYERS.includes(topic) ? with_grid(list, grids).length > 0 : list.length > 0;
  });
}

/** Subscribes to all that is offered, and gives the messages by topic when `enough` says so. */
function listen(client, enough) {
  const channels = new Map();
  const messages = new Map();
  return new Promise((resolve, reject) => {
    const late = setTimeout(() => reject(new Error(`in ${PATIENCE_MS} ms only ${[...messages.keys()]}`)), PATIENCE_MS);
    client.on('error', reject);
    client.on('close', () => reject(new Error('the bridge closed')));
    client.on('serverInfo', (info) => assert.match(info.name, /^gvom /));
    client.on('advertise', (offered) => {
      for (const channel of offered) channels.set(client.subscribe(channel.id), [channel.topic, decoder_of(channel)]);
    });
    client.on('message', ({ subscriptionId, timestamp, data }) => {
      const [topic, decode] = channels.get(subscriptionId);
      const message = decode(new Uint8Array(data.buffer, data.byteOffset, data.byteLength));
      if (message.header) assert.equal(stamp_ns(message.header.stamp), timestamp);
      messages.set(topic, [...(messages.get(topic) ?? []), message]);
      if (!enough(messages)) return;
      clearTimeout(late);
      resolve({ channels, messages });
    });
  });
}

const [port, subprotocol, size_xy, topic_list] = process.argv.slice(2);
const topics = topic_list.split(',');
const client = connected(port, subprotocol);
const { channels, messages } = await listen(client, (so_far) => complete(so_far, topics));
assert.equal(channels.size, 10, 'each channel was offered once');
check_drive(messages, topics, Number(size_xy));
console.log(`well: ${[...messages].map(([topic, list]) => `${topic} ${list.length}`).join(', ')}`);
process.exit(0);
