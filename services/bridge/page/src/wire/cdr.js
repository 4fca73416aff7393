/** Reads XCDR1 as ROS 2 writes it: four bytes of head, then fields aligned to their own size, counted from after the head. */
export class CdrReader {
  /** @param {Uint8Array} bytes a message with its head; either byte order */
  constructor(bytes) {
    if (bytes.length < 4 || bytes[0] !== 0 || bytes[1] > 1) throw new Error('not plain CDR: its head is unknown');
    this.bytes = bytes.subarray(4);
    this.view = new DataView(this.bytes.buffer, this.bytes.byteOffset, this.bytes.length);
    this.little = bytes[1] === 1;
    this.at = 0;
  }

  /** The offset of the next `size` bytes, aligned to `align`; throws if the message ends before. */
  take(size, align) {
    const start = Math.ceil(this.at / align) * align;
    if (size > this.bytes.length - start)
      throw new Error(`the message ends at byte ${this.bytes.length + 4}, ${size} more are needed at ${start + 4}`);
    this.at = start + size;
    return start;
  }

  int8() { return this.view.getInt8(this.take(1, 1)); }
  uint8() { return this.view.getUint8(this.take(1, 1)); }
  bool() { return this.uint8() !== 0; }
  int16() { return this.view.getInt16(this.take(2, 2), this.little); }
  uint16() { return this.view.getUint16(this.take(2, 2), this.little); }
  int32() { return this.view.getInt32(this.take(4, 4), this.little); }
  uint32() { return this.view.getUint32(this.take(4, 4), this.little); }
  int64() { return this.view.getBigInt64(this.take(8, 8), this.little); }
  uint64() { return this.view.getBigUint64(this.take(8, 8), this.little); }
  float32() { return this.view.getFloat32(this.take(4, 4), this.little); }
  float64() { return this.view.getFloat64(this.take(8, 8), this.little); }

  /** A string without its NUL. */
  string() {
    const length = this.uint32();
    const start = this.take(length, 1);
    return new TextDecoder().decode(this.bytes.subarray(start, start + Math.max(0, length - 1)));
  }

  /** `length` octets, a view into the message. */
  octets(length) {
    const start = this.take(length, 1);
    return this.bytes.subarray(start, start + length);
  }

  /** The length of a sequence of elements of at least `element_bytes` each; throws if they cannot be there. */
  count(element_bytes) {
    const count = this.uint32();
    if (count * element_bytes > this.bytes.length - this.at)
      throw new Error(`${count} elements are announced at byte ${this.at}, ${this.bytes.length - this.at} bytes are left`);
    return count;
  }
}
