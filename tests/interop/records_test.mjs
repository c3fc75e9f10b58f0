// The examples of protocol/README.md, read by the code that was written from it.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { applyDelta } from './deltas.mjs';
import { chunkMeshHash, hashTerm, twiceArea } from './mesh_hash.mjs';
import { BadFrame, Reader, readRecord, RecordStream } from './records.mjs';
import { Scene } from './scene.mjs';

const readme = readFileSync(new URL('../../protocol/README.md', import.meta.url), 'utf8');
const joined = { epoch: 'fedcba9876543210', settings: { chunk_resolution: 32, voxel_size: 1 } };

// The bytes of a block ```hex NAME; a line's comment is set off by two spaces.
function example(name) {
  const block = readme.split(`\`\`\`hex ${name}\n`)[1].split('```')[0];
  const hex = block.trim().split('\n').map((line) => line.trim().split(/ {2,}/)[0]).join('');
  return Buffer.from(hex.replaceAll(' ', ''), 'hex');
}

const square = () => readRecord(example('square chunk').subarray(4));
const asRecords = (bytes) => Buffer.concat([Buffer.from([1, 2]), bytes]);

test('the square of the README is read as it is described', () => {
  const { layer, x, y, z, revision, mesh } = square();
  assert.deepEqual({ layer, x, y, z, revision }, { layer: 2, x: -1, y: 3, z: 0, revision: 258 });
  assert.deepEqual([...mesh.xs], [49152, 81920, 81920, 49152]);
  assert.deepEqual([...mesh.ys], [49152, 49152, 81920, 81920]);
  assert.deepEqual([...mesh.indices], [0, 1, 2, 0, 2, 3]);
  assert.deepEqual(mesh.sections.map(({ start, end }) => [start, end]),
    [[0, 1], [1, 2], [2, 3], [3, 0]]);
  assert.deepEqual(mesh.sections.map(({ startNormal }) => startNormal),
    [[0, -32767], [32767, 0], [0, 32767], [-32767, 0]]);
  assert.deepEqual(mesh.sections.map(({ endNormal }) => endNormal),
    [[0, -32767], [32767, 0], [0, 32767], [-32767, 0]]);
});

test('the square has the hashes of the README', () => {
  assert.equal(twiceArea(square().mesh), 2147483648);
  assert.equal(chunkMeshHash(square().mesh), 0x2a9ee5232621d5b4n);
  assert.equal(hashTerm(square()), 0x361b62631c1a943an);
});

test('a varint is 32 bits in as few bytes as it can', () => {
  const varint = (...bytes) => new Reader(Buffer.from(bytes)).varint();
  assert.equal(varint(0x7f), 127);
  assert.equal(varint(0x80, 0x01), 128);
  assert.equal(varint(0xff, 0xff, 0xff, 0xff, 0x0f), 4294967295);
  assert.throws(() => varint(0xff, 0xff, 0xff, 0xff, 0x1f), BadFrame);
  assert.throws(() => varint(0x80, 0x80, 0x80, 0x80, 0x80, 0x01), BadFrame);
  assert.throws(() => varint(0x80, 0x00), BadFrame);
  assert.throws(() => varint(0x80), BadFrame);
});

test('records come in pieces of any length', () => {
  const bytes = Buffer.concat([example('square chunk'), example('removed chunk')]);
  const stream = new RecordStream();
  const records = [...bytes].flatMap((byte) => stream.push(Buffer.from([byte])));
  assert.deepEqual(records, [square(), { layer: 0, x: 5, y: -6, z: 0, revision: 7 }]);
  assert.ok(stream.betweenRecords);
  assert.deepEqual(new RecordStream().push(bytes), records);
});

test('a record that is cut, or has a byte more, is refused', () => {
  const bytes = example('square chunk').subarray(4);
  for (let length = 0; length < bytes.length; ++length) {
    assert.throws(() => readRecord(bytes.subarray(0, length)), BadFrame, `${length} bytes`);
  }
  assert.throws(() => readRecord(Buffer.concat([bytes, Buffer.from([0])])), BadFrame);
});

test('a record with any one byte changed is read or refused, and nothing else', () => {
  const bytes = example('square chunk').subarray(4);
  let refused = 0;
  for (let at = 0; at < bytes.length; ++at) {
    for (let value = 0; value < 256; ++value) {
      const changed = Buffer.from(bytes);
      changed[at] = value;
      try {
        readRecord(changed);
      } catch (error) {
        assert.ok(error instanceof BadFrame, `byte ${at} = ${value}: ${error.stack}`);
        ++refused;
      }
    }
  }
  assert.ok(refused > 5000, `only ${refused} were refused`);
});

test('a record of an impossible length is refused before its bytes come', () => {
  for (const length of [0, 21, 1048577, 4294967295]) {
    const head = Buffer.alloc(4);
    head.writeUInt32LE(length);
    assert.throws(() => new RecordStream().push(head), BadFrame, `${length}`);
  }
});

// The square with its vertices in order, as the delta's base has it.
function orderedSquare() {
  const record = square();
  const { xs, ys, sections } = record.mesh;
  for (const values of [xs, ys]) [values[2], values[3]] = [values[3], values[2]];
  record.mesh.indices = Int32Array.from([0, 1, 2, 2, 1, 3]);
  const moved = [0, 1, 3, 2];
  for (const section of sections)
    [section.start, section.end] = [moved[section.start], moved[section.end]];
  return record;
}

const cutting = () => readRecord(example('cut square delta').subarray(4));

test('a delta cuts the corner off the square, as the README has it', () => {
  const { revision, mesh, ...key } = applyDelta(orderedSquare(), cutting());
  assert.deepEqual(key, { layer: 2, x: -1, y: 3, z: 0 });
  assert.equal(revision, 300);
  assert.deepEqual([...mesh.xs], [49152, 81920, 81920, 49152, 80000]);
  assert.deepEqual([...mesh.ys], [49152, 49152, 80000, 81920, 81920]);
  assert.deepEqual([...mesh.indices], [0, 1, 2, 0, 2, 3, 3, 2, 4]);
  assert.deepEqual(mesh.sections.map(({ start, end }) => [start, end]),
    [[0, 1], [1, 2], [2, 4], [4, 3], [3, 0]]);
  assert.deepEqual(mesh.sections[2].startNormal, [32767, 0]);
  assert.deepEqual(mesh.sections[2].endNormal, [0, 32767]);
  assert.equal(chunkMeshHash(mesh), 0x032f0e22ce189eb1n);
});

test('a delta with any one byte changed, or cut, is read or refused, and nothing else', () => {
  const delta = cutting();
  let refused = 0;
  const apply = (operations) => {
    try {
      applyDelta(orderedSquare(), { ...delta, operations });
    } catch (error) {
      assert.ok(error instanceof BadFrame, error.stack);
      ++refused;
    }
  };
  for (let at = 0; at < delta.operations.length; ++at) {
    apply(delta.operations.subarray(0, at));
    for (let value = 0; value < 256; ++value) {
      const changed = Buffer.from(delta.operations);
      changed[at] = value;
      apply(changed);
    }
  }
  assert.ok(refused > 5000, `only ${refused} were refused`);
});

test('a delta changes what its chunk was, in a group alone', () => {
  const begin = Buffer.from(example('group begin'));
  begin.writeBigUInt64LE(300n, 10);
  const end = Buffer.from(example('group end'));
  end.writeBigUInt64LE(300n, 2);
  const delta = asRecords(example('cut square delta'));
  const looking = (n) => {
    const scene = new Scene(joined);
    scene.look({ n });
    return scene;
  };
  const scene = looking(3);
  scene.chunks.set('2/-1/3/0', orderedSquare());
  for (const message of [begin, delta]) assert.deepEqual(scene.receive(message), []);
  assert.equal(scene.receive(end).length, 1);
  assert.equal(scene.chunks.get('2/-1/3/0').revision, 300);
  assert.throws(() => scene.receive(delta), BadFrame);

  const without = looking(3);
  assert.throws(() => [begin, delta, end].forEach((message) => without.receive(message)), BadFrame);
  const later = looking(4);
  assert.deepEqual([begin, delta, end].flatMap((message) => later.receive(message)), []);
});

test('a group is one picture, seen at its end', () => {
  const scene = new Scene(joined);
  scene.look({ n: 3 });
  assert.deepEqual(scene.receive(example('group begin')), []);
  assert.deepEqual(scene.receive(asRecords(example('square chunk'))), []);
  assert.equal(scene.chunks.size, 0);
  assert.deepEqual(scene.receive(example('group end')), [square()]);
  assert.equal(scene.chunks.size, 1);
  assert.equal(scene.seq, 258);
  assert.equal(scene.meshHash(), '361b62631c1a943a');
});

test('a record outside a group is seen at once, unless it lies outside the view', () => {
  const scene = new Scene(joined);
  // The square's chunk (-1, 3) has the cells from (-31.5, 96.5) to (0.5, 128.5).
  scene.look({ n: 1, rect: [-10, 100, -5, 105] });
  assert.equal(scene.receive(asRecords(example('square chunk'))).length, 1);
  scene.look({ n: 2, rect: [1, 100, 5, 105] });
  assert.equal(scene.chunks.size, 0);
  assert.equal(scene.receive(asRecords(example('square chunk'))).length, 0);
});

test('a scene that was interrupted claims what it held, and begins where it was', () => {
  const scene = new Scene(joined);
  scene.look({ n: 3 });
  scene.catchUp({ n: 2, seq: 256 });
  scene.catchUp({ n: 3, seq: 257 });
  scene.receive(asRecords(example('square chunk')));
  scene.receive(example('group begin'));
  scene.receive(asRecords(example('removed chunk').subarray(0, 9)));
  const everywhere = [-1000577, -1000577, 1000577, 1000577];
  assert.deepEqual(scene.interrupt(), { epoch: joined.epoch, seq: 257, rect: everywhere });
  assert.equal(scene.chunks.size, 1);

  // Before the view came back whole there is nothing to claim, and nothing to keep.
  scene.look({ n: 4, rect: [-10, 100, -5, 105] });
  assert.equal(scene.chunks.size, 1);
  scene.receive(example('group begin'));
  assert.equal(scene.interrupt(), undefined);
  assert.equal(scene.chunks.size, 0);
});

test('binary messages out of turn are refused', () => {
  const refuses = (...messages) => {
    const scene = new Scene(joined);
    scene.look({ n: 3 });
    assert.throws(() => messages.forEach((message) => scene.receive(message)), BadFrame);
  };
  refuses(Buffer.from([2, 1]));
  refuses(Buffer.from([1, 4]));
  refuses(Buffer.from([1]));
  refuses(asRecords(Buffer.alloc(0)));
  refuses(example('group end'));
  refuses(example('group begin'), example('group begin'));
  refuses(example('group begin'), Buffer.from('0103ff01000000000000', 'hex'));
  refuses(asRecords(example('square chunk').subarray(0, 9)), example('group begin'));
});
