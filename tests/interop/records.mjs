// Chunk records: what the binary messages carry, one chunk's mesh each. Read from bytes and checked
// as protocol/README.md, "Chunk record", has it; whatever does not follow it throws BadFrame.
const FULL = 1;
const REMOVED = 2;
const DELTA = 3;
const MIN_LENGTH = 22;
export const MAX_LENGTH = 1048576;
export const MAX_VERTICES = 65535;
export const COORDINATE_END = 2129920;
const MAX_CHUNK_COORDINATE = 125072;

export class BadFrame extends Error {}

export function expect(condition, what) {
  if (!condition) throw new BadFrame(what);
}

// Little-endian numbers, one after the other.
export class Reader {
  #view;
  #at = 0;

  constructor(bytes) {
    this.#view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  }

  get left() { return this.#view.byteLength - this.#at; }
  u8() { return this.#view.getUint8(this.#skip(1)); }
  i16() { return this.#view.getInt16(this.#skip(2), true); }
  i32() { return this.#view.getInt32(this.#skip(4), true); }
  u32() { return this.#view.getUint32(this.#skip(4), true); }
  u64() { return this.#view.getBigUint64(this.#skip(8), true); }

  rest() {
    const length = this.left;
    return Buffer.from(this.#view.buffer, this.#view.byteOffset + this.#skip(length), length);
  }

  // Seven bits a byte, the lowest first; 32 bits at most, in as few bytes as it can.
  varint() {
    let value = 0;
    for (let scale = 1; scale <= 2 ** 28; scale *= 128) {
      const byte = this.u8();
      value += (byte & 0x7f) * scale;
      if (byte >= 0x80) continue;
      expect(byte > 0 || scale === 1, 'a varint is longer than it needs to be');
      expect(value < 2 ** 32, 'a varint is beyond 32 bits');
      return value;
    }
    throw new BadFrame('a varint is longer than five bytes');
  }

  // A signed difference: 0, -1, 1, -2, 2 ... are 0, 1, 2, 3, 4 ...
  step() { return unzigzag(this.varint()); }

  #skip(bytes) {
    expect(bytes <= this.left, 'the bytes end too early');
    this.#at += bytes;
    return this.#at - bytes;
  }
}

export function unzigzag(value) {
  return value % 2 === 0 ? value / 2 : -(value + 1) / 2;
}

function readSteps(reader, count, end, what) {
  const values = new Int32Array(count);
  let value = 0;
  for (let i = 0; i < count; ++i) {
    value += reader.step();
    expect(value >= 0 && value < end, `${what} ${value} is not in 0 .. ${end - 1}`);
    values[i] = value;
  }
  return values;
}

function readTriangles(reader, count, vertices) {
  const indices = readSteps(reader, 3 * count, vertices, 'a vertex index');
  for (let i = 0; i < indices.length; i += 3) {
    const [a, b, c] = indices.subarray(i, i + 3);
    expect(a !== b && b !== c && c !== a, 'a triangle has a vertex twice');
  }
  return indices;
}

function readNormal(reader) {
  const normal = [reader.i16(), reader.i16()];
  expect(Math.abs(Math.hypot(...normal) - 32767) <= 1, `(${normal}) is no unit normal`);
  return normal;
}

// The walls: {start, end: vertices, startNormal, endNormal: [x, y]}, in the order of the mesh hash.
function readSections(reader, count, vertices) {
  const sections = [];
  while (sections.length < count) {
    const length = reader.varint();
    expect(length >= 1 && length <= count - sections.length, 'a chain has no such length');
    let start = reader.varint();
    expect(start < vertices, 'a chain starts at no vertex');
    let normal;  // of the end of the chain's section before
    for (let i = 0; i < length; ++i) {
      const head = reader.varint();
      const end = start + unzigzag(Math.floor(head / 4));
      expect(end >= 0 && end < vertices && end !== start, 'a section ends at no other vertex');
      const startNormal = head & 1 ? readNormal(reader) : normal;
      expect(startNormal, 'the first section of a chain has no normal');
      normal = head & 2 ? readNormal(reader) : startNormal;
      sections.push({ start, end, startNormal, endNormal: normal });
      start = end;
    }
  }
  return sections;
}

function readMesh(reader) {
  const vertices = reader.varint();
  const triangles = reader.varint();
  const sections = reader.varint();
  expect(vertices <= MAX_VERTICES, `${vertices} vertices are too many`);
  expect(2 * vertices + 3 * triangles + sections <= reader.left, 'the counts exceed the bytes');
  return {
    xs: readSteps(reader, vertices, COORDINATE_END, 'a coordinate'),
    ys: readSteps(reader, vertices, COORDINATE_END, 'a coordinate'),
    indices: readTriangles(reader, triangles, vertices),
    sections: readSections(reader, sections, vertices),
  };
}

// One record without its length: {layer, x, y, z, revision} and, unless the chunk was removed,
// its mesh {xs, ys, indices, sections}; or, of a delta, {baseRevision, operations}, see deltas.mjs.
export function readRecord(bytes) {
  const reader = new Reader(bytes);
  const kind = reader.u8();
  expect([FULL, REMOVED, DELTA].includes(kind), `${kind} is no kind of record`);
  const layer = reader.u8();
  expect(layer < 16, `there is no layer ${layer}`);
  const [x, y, z] = [reader.i32(), reader.i32(), reader.i32()];
  expect([x, y, z].every((at) => Math.abs(at) <= MAX_CHUNK_COORDINATE), `chunk ${x}, ${y}, ${z}`);
  const record = { layer, x, y, z, revision: Number(reader.u64()) };
  if (kind === FULL) record.mesh = readMesh(reader);
  if (kind === DELTA) {
    const back = reader.varint();
    expect(back > 0 && back <= record.revision, 'a delta has no base before it');
    record.baseRevision = record.revision - back;
    record.operations = Buffer.from(reader.rest());  // a copy, for the stream's bytes go
  }
  expect(reader.left === 0, 'a record has bytes left over');
  return record;
}

// Puts the pieces of the record messages together. A piece may hold many records, and a record may
// run across many pieces.
export class RecordStream {
  #rest = Buffer.alloc(0);

  get betweenRecords() { return this.#rest.length === 0; }

  // Returns the records that `piece` completes.
  push(piece) {
    this.#rest = Buffer.concat([this.#rest, piece]);
    const records = [];
    while (this.#rest.length >= 4) {
      const length = this.#rest.readUInt32LE();
      expect(length >= MIN_LENGTH && length <= MAX_LENGTH, `a record of ${length} bytes`);
      if (this.#rest.length < 4 + length) break;
      records.push(readRecord(this.#rest.subarray(4, 4 + length)));
      this.#rest = this.#rest.subarray(4 + length);
    }
    return records;
  }
}
