/** gvom-bridge as far as the page sees it: its files and a Foxglove websocket on one port, with a drive that repeats. */
import { createServer } from 'node:http';
import { readFile } from 'node:fs/promises';
import { extname, join, normalize } from 'node:path';
import { WebSocketServer } from 'ws';
import { Drive } from './drive.js';
import { cloud_message, grid_message, path_message, tf_message } from './messages.js';
import { SCHEMAS } from './schemas.js';
import { status_json } from './status.js';

const TYPES = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.woff2': 'font/woff2', '.svg': 'image/svg+xml' };
const TOPICS = {
  '/gvom/layers': 'foxglove_msgs/msg/Grid', '/gvom/voxels': 'sensor_msgs/msg/PointCloud2',
  '/gvom/plan': 'nav_msgs/msg/Path', '/gvom/trajectory': 'nav_msgs/msg/Path', '/tf': 'tf2_msgs/msg/TFMessage', '/gvom/status': null,
};
const CHANNELS = Object.entries(TOPICS).map(([topic, schema], i) => (schema
  ? { id: i + 1, topic, encoding: 'cdr', schemaName: schema, schema: SCHEMAS[schema], schemaEncoding: 'ros2msg' }
  : { id: i + 1, topic, encoding: 'json', schemaName: '', schema: '' }));

function serve_files(folder) {
  return async (request, response) => {
    const asked = normalize(decodeURIComponent(new URL(request.url, 'http://mock').pathname));
    const path = asked === '/' ? '/index.html' : asked;
    try {
      const file = await readFile(join(folder, path));
      response.writeHead(200, { 'content-type': TYPES[extname(path)] ?? 'text/plain' }).end(file);
    } catch {
      response.writeHead(404).end('not found');
    }
  };
}

/** One client: at most one message waits for each of its topics, a newer one replaces it. */
class Client {
  constructor(socket) {
    this.socket = socket;
    this.topics = new Map();  // topic -> subscription id
    this.waiting = new Map();
    this.sending = false;
    this.sent = 0;
    socket.on('message', (text) => this.on_message(JSON.parse(text)));
  }

  on_message({ op, subscriptions, subscriptionIds }) {
    if (op === 'subscribe')
      for (const { id, channelId } of subscriptions) this.topics.set(CHANNELS.find((channel) => channel.id === channelId).topic, id);
    if (op === 'unsubscribe')
      for (const [topic, id] of this.topics) if (subscriptionIds.includes(id)) this.topics.delete(topic);
  }

  offer(topic, stamp_s, bytes) {
    const id = this.topics.get(topic);
    if (id === undefined) return;
    const head = Buffer.alloc(13);
    head[0] = 1;
    head.writeUInt32LE(id, 1);
    head.writeBigUInt64LE(BigInt(Math.round(stamp_s * 1e9)), 5);
    this.waiting.set(topic, Buffer.concat([head, bytes]));
    this.send();
  }

  send() {
    const next = this.waiting.entries().next();
    if (this.sending || next.done) return;
    const [topic, message] = next.value;
    this.waiting.delete(topic);
    this.sending = true;
    this.sent += 1;
    this.socket.send(message, () => { this.sending = false; this.send(); });
  }
}

export class MockBridge {
  /**
   * @param {string} folder with the built page
   * @param {{start_s?: number, step_s?: number}} options where in the drive it begins, and the time between maps
   */
  constructor(folder, { start_s = 0, step_s = 0.1 } = {}) {
    this.step_s = step_s;
    this.drive = new Drive();
    this.time_s = start_s;
    this.state = { rear: true, fusion: true };
    this.refuses = false;
    this.clients = new Set();
    this.http = createServer(serve_files(folder));
    new WebSocketServer({ server: this.http, handleProtocols: () => 'foxglove.websocket.v1' })
      .on('connection', (socket) => this.on_connection(socket));
    for (let t = start_s - 4; t < start_s; t += 0.1) this.drive.look(t, true);
  }

  /** @returns {Promise<number>} the port */
  listen(port = 0, address = '127.0.0.1') {
    const start_ms = performance.now() - 1000 * this.time_s;
    this.started_wall_s = Date.now() / 1000 - this.time_s;
    this.timer = setInterval(() => this.step((performance.now() - start_ms) / 1000), 1000 * this.step_s);
    return new Promise((resolve) => { this.http.listen(port, address, () => resolve(this.http.address().port)); });
  }

  close() {
    clearInterval(this.timer);
    for (const { socket } of this.clients) socket.terminate();
    this.http.close();
  }

  on_connection(socket) {
    if (this.refuses) {
      socket.terminate();
      return;
    }
    const client = new Client(socket);
    this.clients.add(client);
    socket.on('close', () => this.clients.delete(client));
    socket.send(JSON.stringify({ op: 'serverInfo', name: 'mock of gvom-bridge', capabilities: [], supportedEncodings: [] }));
    socket.send(JSON.stringify({ op: 'advertise', channels: CHANNELS }));
  }

  wanted(topic) {
    return [...this.clients].some((client) => client.topics.has(topic));
  }

  offer(topic, stamp_s, write) {
    if (!this.wanted(topic)) return;
    const bytes = write();
    for (const client of this.clients) client.offer(topic, stamp_s, bytes);
  }

  /** @param {number} time_s of the drive, as the wall has it however late this comes */
  step(time_s) {
    const due = (period_s) => Math.floor(time_s / period_s) > Math.floor(this.time_s / period_s);
    const [voxels_due, status_due] = [due(0.5), due(1)];
    this.time_s = time_s;
    const { drive } = this;
    const stamp_s = 1000 + this.time_s;
    if (this.state.fusion) {
      drive.look(this.time_s, this.state.rear);
      this.last_map_s = this.time_s;
      this.offer('/gvom/layers', stamp_s, () => grid_message(drive.map()));
      if (voxels_due) this.offer('/gvom/voxels', stamp_s, () => cloud_message(stamp_s, ['x', 'y', 'z', 'density'], drive.voxels()));
    }
    this.offer('/tf', stamp_s, () => tf_message(stamp_s, drive.pose()));
    this.offer('/gvom/plan', stamp_s, () => path_message(stamp_s, drive.ahead(40)));
    this.offer('/gvom/trajectory', stamp_s, () => path_message(stamp_s, drive.ahead(9)));
    if (status_due) this.offer('/gvom/status', stamp_s, () => Buffer.from(JSON.stringify(this.status())));
  }

  status() {
    return status_json({ ...this.state, age_s: 0.04 + this.time_s - (this.last_map_s ?? this.time_s) });
  }
}
