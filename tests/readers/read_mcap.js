// read_mcap.js FILE SIZE_XY TOPICS [ARRAYS]: reads an MCAP file as a stream with all checksums and by its index, and
// checks its messages; TOPICS, between commas, must be there. ARRAYS: a map that gvom-map --out wrote, of one of its moments.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { join } from 'node:path';
import zstd from '@foxglove/wasm-zstd';
import { McapIndexedReader, McapStreamReader } from '@mcap/core';
import { check_drive } from './check_drive.js';
import { decoder, grid_layers, stamp_ns } from './decode.js';

const decompressHandlers = { zstd: (bytes, size) => zstd.decompress(bytes, Number(size)) };

/** All records, in order, every checksum looked at. */
function streamed(bytes) {
  const reader = new McapStreamReader({ decompressHandlers, validateCrcs: true });
  reader.append(bytes);
  const records = [];
  for (let record; (record = reader.nextRecord());) records.push(record);
  assert.ok(reader.done(), 'the file has its end');
  return records;
}

async function indexed(bytes) {
  const readable = {
    size: async () => BigInt(bytes.length),
    read: async (offset, size) => bytes.subarray(Number(offset), Number(offset + size)),
  };
  return McapIndexedReader.Initialize({ readable, decompressHandlers });
}

function decoder_of(channel, schema) {
  if (channel.messageEncoding === 'json') return (data) => JSON.parse(new TextDecoder().decode(data));
  assert.equal(channel.messageEncoding, 'cdr');
  assert.equal(schema.encoding, 'ros2msg');
  return decoder(new TextDecoder().decode(schema.data));
}

/** By the index, decoded; each message's time must be its own stamp. */
async function messages_in(reader) {
  const decoders = new Map();
  const messages = new Map();
  for (const channel of reader.channelsById.values()) {
    decoders.set(channel.id, decoder_of(channel, reader.schemasById.get(channel.schemaId)));
    messages.set(channel.topic, []);
  }
  for await (const record of reader.readMessages({ validateCrcs: true })) {
    const message = decoders.get(record.channelId)(record.data);
    if (message.header) assert.equal(stamp_ns(message.header.stamp), record.logTime);
    messages.get(reader.channelsById.get(record.channelId).topic).push(message);
  }
  return messages;
}

/** A NumPy array of float32 or uint8, as an array of numbers. */
async function npy(path) {
  const bytes = await readFile(path);
  const begin = 10 + bytes.readUInt16LE(8);
  const step = /'descr': '<f4'/.test(bytes.toString('latin1', 10, begin)) ? 4 : 1;
  const read = (i) => (step === 4 ? bytes.readFloatLE(begin + 4 * i) : bytes[begin + i]);
  return Array.from({ length: (bytes.length - begin) / step }, (_, i) => read(i));
}

/** The layers in the file are those that were written as arrays. */
async function check_arrays(grids, folder) {
  const { stamp_ns: text } = /"stamp_ns": (?<stamp_ns>\d+)/.exec(await readFile(join(folder, 'meta.json'), 'utf8')).groups;
  const grid = grids.find((one) => stamp_ns(one.timestamp) === BigInt(text));
  assert.ok(grid, `layers of ${text}`);
  const layers = grid_layers(grid);
  assert.equal(Object.keys(layers).length, 13);
  for (const [name, values] of Object.entries(layers)) assert.deepEqual(values, await npy(join(folder, `${name}.npy`)), name);
}

const [file, size_xy, topics, arrays] = process.argv.slice(2);
await zstd.isLoaded;
const bytes = await readFile(file);
const records = streamed(bytes);
const reader = await indexed(bytes);
const messages = await messages_in(reader);
const counts = [...messages].map(([topic, list]) => `${topic} ${list.length}`);
const count = [...messages.values()].reduce((sum, list) => sum + list.length, 0);
assert.equal(records.filter(({ type }) => type === 'Message').length, count);
assert.equal(reader.statistics.messageCount, BigInt(count));
assert.equal(reader.header.profile, 'ros2');
check_drive(messages, topics.split(','), Number(size_xy));
if (arrays) await check_arrays(messages.get('/gvom/layers'), arrays);
console.log(`well: ${counts.join(', ')}`);
