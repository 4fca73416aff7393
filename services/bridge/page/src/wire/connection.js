/** The Foxglove websocket: what is wanted by topic is subscribed whenever it is offered, on every new connection again. */
import { reader_of } from './schema.js';

const PROTOCOLS = ['foxglove.websocket.v1', 'foxglove.sdk.v1'];
const FIRST_RETRY_MS = 500;
const LONGEST_RETRY_MS = 5000;
const DEAD_MS = 10000;          // a link of which nothing has come for so long is given up,
const LONGEST_DEAD_MS = 60000;  // each time later, until a map has come: nothing comes beside it, and a slow link takes its time
const MAP_BYTES = 100000;
const MESSAGE_DATA = 1;
const HEAD_BYTES = 13;

const open_websocket = (url) => new WebSocket(url, PROTOCOLS);
const start_timer = (wait_ms, act) => setTimeout(act, wait_ms);

function decoder_of(channel) {
  if (channel.encoding === 'json') return (bytes) => JSON.parse(new TextDecoder().decode(bytes));
  if (channel.encoding !== 'cdr' || channel.schemaEncoding !== 'ros2msg')
    throw new Error(`encoding ${channel.encoding} with schemas of ${channel.schemaEncoding} is not known`);
  return reader_of(channel.schemaName, channel.schema);
}

export class Connection {
  /**
   * @param {string} url ws://HOST:PORT
   * @param {{open_socket?: (url: string) => WebSocket,
   *          after?: (wait_ms: number, act: () => void) => number,
   *          on_message: (topic: string, message: object, stamp_ns: bigint, bytes: number) => void,
   *          on_change?: () => void}} options on_change: connected, lost, or other topics are offered
   */
  constructor(url, { open_socket = open_websocket, after = start_timer, on_message, on_change = () => {} }) {
    Object.assign(this, { url, open_socket, after, on_message, on_change });
    this.wanted = new Set();
    this.bad_messages = 0;
    this.last_error = '';
    this.retry_ms = FIRST_RETRY_MS;
    this.dead_ms = DEAD_MS;
    this.next_id = 1;
    this.forget();
    this.connect();
  }

  /** Topics that are wanted from now on; what is not in it is unsubscribed. */
  want(topics) {
    this.wanted = new Set(topics);
    this.subscribe();
  }

  offers(topic) {
    return this.channels.has(topic);
  }

  close() {
    this.closed = true;
    clearTimeout(this.timer);
    this.socket.close();
  }

  forget() {
    this.connected = false;
    this.server_name = '';
    this.channels = new Map();       // topic -> channel
    this.subscriptions = new Map();  // subscription id -> {topic, decode}
  }

  connect() {
    const socket = this.open_socket(this.url);
    this.socket = socket;
    this.alive_ms = performance.now();
    socket.binaryType = 'arraybuffer';
    socket.onmessage = ({ data }) => {
      if (socket !== this.socket) return;
      this.note_alive(data);
      this.guarded(() => (typeof data === 'string' ? this.on_text(JSON.parse(data)) : this.on_binary(data)));
    };
    socket.onopen = () => {
      this.alive_ms = performance.now();
      this.connected = true;
      this.retry_ms = FIRST_RETRY_MS;
      this.on_change();
    };
    socket.onclose = () => this.on_close();
  }

  note_alive(data) {
    const silent_ms = performance.now() - this.alive_ms;
    this.alive_ms += silent_ms;
    if (data.byteLength > MAP_BYTES) this.dead_ms = Math.max(DEAD_MS, 2 * silent_ms);
  }

  /** Gives up a link of which nothing has come for so long; a network that went away says no word of it. */
  watch(now_ms = performance.now()) {
    if (now_ms - this.alive_ms < this.dead_ms || this.timer_runs) return;
    if (this.connected) this.dead_ms = Math.min(LONGEST_DEAD_MS, 2 * this.dead_ms);
    this.socket.onclose = null;
    this.socket.close();
    this.on_close();
  }

  on_close() {
    this.forget();
    this.on_change();
    if (this.closed) return;
    this.retry_at_ms = Date.now() + this.retry_ms;
    this.timer_runs = true;
    this.timer = this.after(this.retry_ms, () => {
      this.timer_runs = false;
      this.connect();
    });
    this.retry_ms = Math.min(LONGEST_RETRY_MS, 2 * this.retry_ms);
  }

  /** A message that does not fit is counted and told, and harms no other one. */
  guarded(handle) {
    try {
      handle();
    } catch (error) {
      this.bad_messages += 1;
      this.last_error = error.message;
      console.warn(`gvom: a message was not used: ${error.message}`);
    }
  }

  on_text(message) {
    if (message.op === 'serverInfo') this.server_name = String(message.name ?? '');
    if (message.op === 'advertise') for (const channel of message.channels ?? []) this.channels.set(channel.topic, channel);
    if (message.op === 'unadvertise') this.unadvertise(message.channelIds ?? []);
    this.subscribe();
    this.on_change();
  }

  unadvertise(channel_ids) {
    for (const [topic, channel] of this.channels) {
      if (!channel_ids.includes(channel.id)) continue;
      this.channels.delete(topic);
      for (const [id, subscription] of this.subscriptions)
        if (subscription.topic === topic) this.subscriptions.delete(id);
    }
  }

  subscribe() {
    if (!this.connected) return;
    const have = new Set([...this.subscriptions.values()].map(({ topic }) => topic));
    const more = [...this.wanted].filter((topic) => !have.has(topic) && this.channels.has(topic));
    const subscriptions = more.map((topic) => this.subscription_to(topic)).filter(Boolean);
    if (subscriptions.length > 0) this.send({ op: 'subscribe', subscriptions });
    const fewer = [...this.subscriptions].filter(([, { topic }]) => !this.wanted.has(topic)).map(([id]) => id);
    for (const id of fewer) this.subscriptions.delete(id);
    if (fewer.length > 0) this.send({ op: 'unsubscribe', subscriptionIds: fewer });
  }

  /** What to ask the server for, or null where the topic's schema cannot be read. */
  subscription_to(topic) {
    const channel = this.channels.get(topic);
    const id = this.next_id++;
    let decode = null;
    this.guarded(() => { decode = decoder_of(channel); });
    this.subscriptions.set(id, { topic, decode });
    return decode ? { id, channelId: channel.id } : null;
  }

  send(message) {
    this.socket.send(JSON.stringify(message));
  }

  on_binary(buffer) {
    const view = new DataView(buffer);
    if (buffer.byteLength < HEAD_BYTES || view.getUint8(0) !== MESSAGE_DATA) return;
    const subscription = this.subscriptions.get(view.getUint32(1, true));
    if (!subscription?.decode) return;  // unsubscribed while it was on its way
    const message = subscription.decode(new Uint8Array(buffer, HEAD_BYTES));
    this.on_message(subscription.topic, message, view.getBigUint64(5, true), buffer.byteLength);
  }
}
