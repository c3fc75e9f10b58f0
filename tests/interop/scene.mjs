// The meshes that a viewer holds, put together from the binary messages alone. A group's records
// are applied together at its end, so what is held between two messages is one picture of the map.
import { applyDelta } from './deltas.mjs';
import { meshHash } from './mesh_hash.mjs';
import { BadFrame, Reader, RecordStream } from './records.mjs';

const VERSION = 1;
const GROUP_BEGIN = 1;
const RECORDS = 2;
const GROUP_END = 3;
const MAP_END_VOXELS = 1000577;  // past the last cell of the largest map

function keyOf({ layer, x, y, z }) {
  return `${layer}/${x}/${y}/${z}`;
}

export class Scene {
  chunks = new Map();  // from keyOf() to the chunk's last record
  seq = 0;             // every change up to this one is in `chunks`, once the view is complete
  view;                // {n, rect: [x0, y0, x1, y1] in map units, or undefined for all}
  complete = false;    // all of the view has arrived
  #joined;
  #group;
  #stream = new RecordStream();

  // `joined` is the server's reply of that name.
  constructor(joined) {
    this.#joined = joined;
  }

  // The server took the view: what lies outside is not kept up to date any more.
  look(view) {
    this.view = view;
    this.complete = false;
    for (const [key, chunk] of this.chunks) if (!this.#sees(chunk)) this.chunks.delete(key);
  }

  // The connection was lost: what was under way does not come any more. Returns what the view of
  // the next connection may claim to `have`; when that is nothing, all of it comes anew.
  interrupt() {
    const rect = this.view?.rect ?? this.#everywhere;
    const have = this.complete ? { epoch: this.#joined.epoch, seq: this.seq, rect } : undefined;
    if (!have) this.chunks.clear();
    this.complete = false;
    this.#group = undefined;
    this.#stream = new RecordStream();
    return have;
  }

  catchUp({ n, seq }) {
    if (n !== this.view.n) return;  // of the view before
    this.complete = true;
    this.seq = Math.max(this.seq, seq);
  }

  // Takes one binary message. Returns the records that became visible with it, mostly none.
  receive(message) {
    const reader = new Reader(message);
    const version = reader.u8();
    if (version !== VERSION) throw new BadFrame(`version ${version} of the binary messages`);
    const kind = reader.u8();
    if (kind === RECORDS) return this.#takeRecords(message.subarray(2));
    if (!this.#stream.betweenRecords) throw new BadFrame('a record is incomplete');
    if (kind === GROUP_BEGIN) return this.#begin(reader);
    if (kind === GROUP_END) return this.#end(reader);
    throw new BadFrame(`${kind} is no kind of message`);
  }

  meshHash() { return meshHash(this.chunks.values()); }

  #takeRecords(piece) {
    if (piece.length === 0) throw new BadFrame('a message without records');
    const records = this.#stream.push(piece);
    if (!this.#group) return this.#apply(records);
    this.#group.records.push(...records);
    return [];
  }

  #begin(reader) {
    const epoch = reader.u64().toString(16).padStart(16, '0');
    const seq = Number(reader.u64());
    const view = reader.u32();  // a record says by itself whether it lies in the view of now
    if (this.#group || reader.left > 0) throw new BadFrame('no begin of a group');
    if (epoch !== this.#joined.epoch) throw new BadFrame('a group of another epoch');
    this.#group = { seq, view, records: [] };
    return [];
  }

  #end(reader) {
    const seq = Number(reader.u64());
    if (this.#group?.seq !== seq || reader.left > 0) throw new BadFrame('no end of a group');
    const { records, view } = this.#group;
    this.#group = undefined;
    this.seq = seq;
    return this.#apply(records, view);
  }

  // `view` is the n of the view that a group belongs to; none outside groups.
  #apply(records, view) {
    const seen = [];
    for (const record of records.filter((any) => this.#sees(any))) {
      const whole = record.operations ? this.#whole(record, view) : record;
      if (!whole) continue;
      if (whole.mesh) this.chunks.set(keyOf(whole), whole);
      else this.chunks.delete(keyOf(whole));
      seen.push(whole);
    }
    return seen;
  }

  // The chunk's record after `delta`. A delta of an earlier view may be for a chunk that was let go
  // since: then nothing, and all of it follows.
  #whole(delta, view) {
    if (view === undefined) throw new BadFrame('a delta outside a group');
    const base = this.chunks.get(keyOf(delta));
    if (base?.revision !== delta.baseRevision && view !== this.view.n) return undefined;
    return applyDelta(base, delta);
  }

  get #everywhere() {
    const end = MAP_END_VOXELS * this.#joined.settings.voxel_size;
    return [-end, -end, end, end];
  }

  // Whether the view meets the chunk's cells, which lie half a voxel to the upper right.
  #sees({ x, y }) {
    if (!this.view?.rect) return this.view !== undefined;
    const { chunk_resolution: resolution, voxel_size: size } = this.#joined.settings;
    const [x0, y0, x1, y1] = this.view.rect;
    const meets = (chunk, low, high) =>
      (chunk + 0.5 / resolution) * resolution * size <= high &&
      (chunk + 1 + 0.5 / resolution) * resolution * size >= low;
    return meets(x, x0, x1) && meets(y, y0, y1);
  }
}
