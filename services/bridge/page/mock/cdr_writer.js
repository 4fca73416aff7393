/** Writes XCDR1, little endian, with its head. */
export class CdrWriter {
  constructor() {
    this.buffer = Buffer.alloc(1 << 16);
    this.buffer.set([0, 1, 0, 0]);
    this.size = 4;
  }

  put(bytes, align) {
    const start = 4 + Math.ceil((this.size - 4) / align) * align;
    while (start + bytes > this.buffer.length) this.buffer = Buffer.concat([this.buffer, Buffer.alloc(this.buffer.length)]);
    this.size = start + bytes;
    return start;
  }

  uint8(value) { return this.write(1, (at) => this.buffer.writeUInt8(value, at)); }
  int32(value) { return this.write(4, (at) => this.buffer.writeInt32LE(value, at)); }
  uint32(value) { return this.write(4, (at) => this.buffer.writeUInt32LE(value, at)); }
  float64(...values) {
    for (const value of values) this.write(8, (at) => this.buffer.writeDoubleLE(value, at));
    return this;
  }

  write(bytes, into, align = bytes) {
    const start = this.put(bytes, align);
    into(start);
    return this;
  }

  string(text) { return this.octets(Buffer.from(`${text}\0`)); }

  octets(bytes) {
    return this.uint32(bytes.length).write(bytes.length, (at) => this.buffer.set(bytes, at), 1);
  }

  header(stamp_s, frame) {
    const seconds = Math.floor(stamp_s);
    return this.int32(seconds).uint32(Math.round((stamp_s - seconds) * 1e9)).string(frame);
  }

  done() { return this.buffer.subarray(0, this.size); }
}
