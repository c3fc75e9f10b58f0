// Connections that break: no edit is lost and none is done twice. Against the real server, through
// a wire that is cut.
import assert from 'node:assert/strict';
import { once } from 'node:events';
import { test } from 'node:test';
import { waitBefore } from './backoff.mjs';
import {
  assertHolds, eventually, inTime, join, paint, speckles, square, stamps, watch,
} from './bots.mjs';
import { Client } from './client.mjs';
import { createMap, deleteMap, describeMap, figuresOf } from './maps.mjs';
import { serverForThisFile, startServer } from './server_process.mjs';
import { layWire } from './wire.mjs';

const url = await serverForThisFile();

const oneLayer = (edits) => edits.map((stamp) => ({ ...stamp, layer: 0 }));
const places = (records) => records.map(({ x, y }) => `${x},${y}`).sort();

test('attempts are a quarter of a second apart at first, half a minute in the end', () => {
  assert.equal(waitBefore(0, 0), 250);
  assert.equal(waitBefore(0, 1), 500);
  assert.equal(waitBefore(1, 1), 1000);
  assert.equal(waitBefore(5, 0.5), 8125);
  assert.equal(waitBefore(6, 1), 30_000);
  assert.equal(waitBefore(1000, 1), 30_000);
  assert.equal(waitBefore(1000, 0), 250);
});

// Three ways to lose a connection while edits are under way.
const breaks = {
  // Some replies come, and the last of them not whole.
  async 'after some replies'(wire) { wire.cutAfter(400); },
  // The server applies some edits, and none of the replies comes.
  async 'before the replies'(wire, map, seq) {
    wire.mute();
    while ((await describeMap(url, map)).seq <= seq);
    wire.cut();
  },
  // Perhaps nothing goes out at all.
  async 'at once'(wire) { wire.cut(); },
};

test('a painter whose wire is cut loses no edit and does none twice', inTime, async (t) => {
  const settings = { chunk_resolution: 16 };
  await createMap(url, 'cut', settings);
  await createMap(url, 'whole', settings);
  const edits = oneLayer(stamps(11, 360));
  const wire = await layWire(t, url);
  const painter = await join(t, wire.url, 'cut', { name: 'painter' });
  await painter.view();
  const { key, session } = painter.welcome;
  let backs = 0;
  painter.on('back', () => ++backs);

  const numbers = [];
  for (let round = 0; round < 9; ++round) {
    const replies = edits.slice(40 * round, 40 * (round + 1)).map((edit) => painter.edit(edit));
    await Object.values(breaks)[round % 3](wire, 'cut', 40 * round);
    numbers.push(...await Promise.all(replies));
  }
  assert.deepEqual(numbers, edits.map((_, i) => i + 1));
  assert.equal(backs, 9);
  assert.equal(painter.welcome.key, key);
  assert.notEqual(painter.welcome.session, session);

  await paint(await join(t, url, 'whole'), edits, 360);
  const [cut, whole] = [await describeMap(url, 'cut'), await describeMap(url, 'whole')];
  assert.equal(cut.seq, 360);
  assert.equal(cut.hash, whole.hash);
  await painter.until(360);
  assertHolds(painter, await figuresOf(url, 'cut'));
});

test('who comes back is sent only what changed', inTime, async (t) => {
  await createMap(url, 'resumed', { chunk_resolution: 8 });
  const wire = await layWire(t, url);
  const { client, changes } = await watch(t, wire.url, 'resumed');
  const painter = await join(t, url, 'resumed');
  await painter.edit({ ...square(), path: [[4, 4], [20, 4], [36, 4]] });
  await client.until(1);
  assert.deepEqual(places(changes.splice(0)), ['0,0', '2,0', '4,0']);

  wire.down();
  await painter.edit(square(20, 4, 3));
  await painter.edit(square(36, 4, 3, false));
  wire.up();
  await client.until(3);
  assert.deepEqual(places(changes), ['2,0', '4,0']);
  assertHolds(client, await figuresOf(url, 'resumed'));
});

test('a first load that was cut comes again, whole', inTime, async (t) => {
  await createMap(url, 'loaded', { chunk_resolution: 8 });
  const painter = await join(t, url, 'loaded');
  await painter.edit({ ...speckles, path: speckles.path.map(([x, y]) => [2 * x, 2 * y]) });
  const { mesh_bytes: bytes } = await figuresOf(url, 'loaded');
  assert.ok(bytes > 50_000, `${bytes} bytes`);
  const wire = await layWire(t, url);
  const client = await join(t, wire.url, 'loaded');
  wire.cutAfter(Math.floor(bytes / 2));
  client.view();
  await once(client, 'lost');
  assert.ok(client.scene.chunks.size > 0 && !client.scene.complete);
  await client.until(1);
  assertHolds(client, await figuresOf(url, 'loaded'));
});

test('events and people go on where they were', inTime, async (t) => {
  await createMap(url, 'followed');
  const wire = await layWire(t, url);
  const reader = await join(t, wire.url, 'followed', { name: 'reader' });
  const painter = await join(t, url, 'followed', { name: 'painter' });
  const seqs = [];
  reader.on('event', ({ seq }) => seqs.push(seq));
  await reader.events(1);
  for (let i = 0; i < 5; ++i) await painter.edit(square(i, 0));
  await eventually(reader, 'event', () => seqs.length === 5);
  wire.down();
  for (let i = 0; i < 5; ++i) await painter.edit(square(i, 5));
  wire.up();
  await eventually(reader, 'event', () => seqs.length === 10);
  assert.deepEqual(seqs, [1, 2, 3, 4, 5, 6, 7, 8, 9, 10]);
  const { session } = reader.welcome;
  assert.deepEqual([...reader.people.values()].map(({ name }) => name).sort(),
    ['painter', 'reader']);
  await eventually(painter, 'presence', () => painter.people.has(session));
});

test('a key and its ids serve again in another run', inTime, async (t) => {
  await createMap(url, 'again');
  const first = await join(t, url, 'again');
  assert.equal(await first.edit(square(0, 0)), 1);
  await first.close();
  const { key } = first.welcome;
  const second = await join(t, url, 'again', { key, lastId: first.lastId });
  assert.equal(await second.edit(square(9, 9)), 2);
  // With the ids of before, the answers are those of before.
  const forgetful = await join(t, url, 'again', { key });
  assert.equal(await forgetful.edit(square(20, 20)), 1);
  assert.equal((await describeMap(url, 'again')).seq, 2);
});

test('of ids long past nothing is known any more', inTime, async (t) => {
  await createMap(url, 'long');
  const painter = await join(t, url, 'long');
  const remembered = painter.welcome.limits.max_remembered_ids;
  const edits = Array.from({ length: remembered + 1 }, () => square(0, 0, 0.75));
  assert.equal((await paint(painter, edits, 1000)).length, 4097);
  const forgetful = await join(t, url, 'long', { key: painter.welcome.key });
  await assert.rejects(forgetful.edit(square(0, 0)), { code: 'id_too_old', field: 'id' });
  assert.equal(await forgetful.edit(square(0, 0)), 2);
});

test('another map of that name is not painted on', inTime, async (t) => {
  await createMap(url, 'replaced');
  const wire = await layWire(t, url);
  const client = await join(t, wire.url, 'replaced');
  const closed = once(client, 'close');
  wire.down();
  await deleteMap(url, 'replaced');
  await createMap(url, 'replaced');
  wire.up();
  const lost = client.edit(square(0, 0));
  await assert.rejects(lost, /made anew/);
  assert.match((await closed)[0].message, /made anew/);
  assert.equal((await describeMap(url, 'replaced')).seq, 0);
});

test('a server that ends says when to come back', inTime, async (t) => {
  const other = await startServer();
  await createMap(other.url, 'ending');
  const client = await join(t, other.url, 'ending');
  const lost = once(client, 'lost');
  assert.equal(await other.stop(), 0);
  const [why] = await lost;
  assert.equal(why.message, 'the server ends');
  assert.equal(why.retryAfterMs, 1000);
});

test('a client that is closed stays away', inTime, async (t) => {
  await createMap(url, 'closed');
  const wire = await layWire(t, url);
  const client = await join(t, wire.url, 'closed');
  wire.cut();
  await once(client, 'lost');
  const lost = client.edit(square(0, 0));
  await client.close();
  await assert.rejects(lost, /closed/);
  await assert.rejects(client.ping(), /closed/);
  await assert.rejects(Client.connect('http://127.0.0.1:1'), /ECONNREFUSED/);
});
