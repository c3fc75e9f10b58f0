// A client that shares no line with the server, against the real one: EARTHWORK_SERVER names it.
import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { once } from 'node:events';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { promisify } from 'node:util';
import {
  assertHolds, inTime, join as joinAt, paint, speckles, square, stamps, watch as watchAt,
} from './bots.mjs';
import { createMap, deleteMap, describeMap, figuresOf } from './maps.mjs';
import { twiceArea } from './mesh_hash.mjs';
import { openRims } from './rims.mjs';
import { serverForThisFile } from './server_process.mjs';

const UNIT = 32768;
const url = await serverForThisFile();

const join = (t, map, who) => joinAt(t, url, map, who);
const watch = (t, map, rect) => watchAt(t, url, map, rect);
const places = (records) => records.map(({ x, y }) => `${x},${y}`).sort();

test('two clients paint at once, and a third sees what the server has', inTime, async (t) => {
  await createMap(url, 'crowd', {
    chunk_resolution: 16,
    voxel_size: 0.5,
    layers: [{ name: 'ground', wall: [-1, 0] }, { name: 'rock', color: '#808080', wall: [0, 2] }],
  });
  const { client: watcher } = await watch(t, 'crowd');
  let groups = 0;
  watcher.on('change', () => {
    ++groups;
    assert.deepEqual(openRims(watcher.scene.chunks.values(), 16), []);
  });
  const painters = [await join(t, 'crowd'), await join(t, 'crowd')];

  const numbers = await Promise.all(
    painters.map((painter, i) => paint(painter, [...stamps(i, 149), speckles], 1 + 15 * i)));

  for (const own of numbers) assert.deepEqual(own, [...own].sort((a, b) => a - b));
  const all = numbers.flat().sort((a, b) => a - b);
  assert.deepEqual(all, Array.from({ length: 300 }, (_, i) => i + 1));
  await watcher.until(300);
  assertHolds(watcher, await figuresOf(url, 'crowd'));
  assert.ok(groups > 10, `${groups} groups`);
  const chunks = [...watcher.scene.chunks.values()];
  assert.ok(chunks.length > 100, `${chunks.length} chunks`);
  assert.notDeepEqual(openRims(chunks.slice(1), 16), []);  // without one, they do come apart

  const { client: late } = await watch(t, 'crowd');
  assert.equal(late.scene.meshHash(), watcher.scene.meshHash());
});

test('a square has the area and the walls of a square', inTime, async (t) => {
  await createMap(url, 'square');
  const { client } = await watch(t, 'square');
  await client.until(await client.edit(square(16, 16, 8)));
  assertHolds(client, await figuresOf(url, 'square'));
  const [{ mesh }] = client.scene.chunks.values();
  assert.equal(twiceArea(mesh) / 2 / UNIT ** 2, 256);
  assert.equal((await describeMap(url, 'square')).users, 1);
});

test('a chunk that became empty is removed', inTime, async (t) => {
  await createMap(url, 'emptied', { chunk_resolution: 8 });
  const { client, changes } = await watch(t, 'emptied');
  await client.until(await client.edit(square(4, 4)));
  assert.equal(client.scene.chunks.size, 1);
  await client.until(await client.edit(square(4, 4, 3, false)));
  assert.equal(client.scene.chunks.size, 0);
  assert.deepEqual(changes.map(({ revision }) => revision), [1, 2]);
  assert.deepEqual(changes.map(({ mesh }) => mesh !== undefined), [true, false]);
  assertHolds(client, await figuresOf(url, 'emptied'));
});

test('a refused edit names what is wrong, and takes no number', inTime, async (t) => {
  await createMap(url, 'refused');
  const client = await join(t, 'refused');
  const refuses = (edit, code, field) =>
    assert.rejects(client.edit(edit), (error) => {
      assert.deepEqual([error.code, error.field], [code, field]);
      assert.ok(error.message.startsWith(field), error.message);
      return true;
    });
  await refuses(square(0, 0, 513), 'out_of_range', 'radius');
  await refuses(square(1e308, 0), 'out_of_range', 'x');
  await refuses({ ...square(0, 0), layer: 1 }, 'out_of_range', 'layer');
  await refuses({ ...square(0, 0), fill: 1 }, 'bad_field', 'fill');
  await refuses({ ...square(0, 0), stencil: 'star' }, 'bad_field', 'stencil');
  await refuses({ ...square(), path: [] }, 'out_of_range', 'path');
  assert.equal(await client.edit(square(0, 0)), 1);
});

test('a view receives only its chunks, and a moved one those that are new', inTime, async (t) => {
  await createMap(url, 'row', { chunk_resolution: 8 });
  const painter = await join(t, 'row');
  await painter.edit({ ...square(), path: [[4, 4], [20, 4], [36, 4], [52, 4], [4, 60]] });
  const part = await watch(t, 'row', [18, 2, 40, 6]);
  assert.deepEqual(places(part.changes), ['2,0', '4,0']);

  await part.client.until(await painter.edit(square(4, 60, 3)));
  await part.client.until(await painter.edit(square(36, 4, 3)));
  assert.deepEqual(places(part.changes.splice(0)), ['2,0', '4,0', '4,0']);

  await part.client.view([34, 2, 54, 6]);
  await part.client.until(3);
  assert.deepEqual(places(part.changes), ['6,0']);
  assert.deepEqual(places([...part.client.scene.chunks.values()]), ['4,0', '6,0']);

  const { client: all } = await watch(t, 'row');
  for (const [key, chunk] of part.client.scene.chunks) {
    assert.deepEqual(chunk, all.scene.chunks.get(key));
  }
});

test('a view that moves while others paint ends with what lies in it', inTime, async (t) => {
  await createMap(url, 'moving', { chunk_resolution: 8 });
  const { client: all } = await watch(t, 'moving');
  const { client: part } = await watch(t, 'moving', [0, 0, 1, 1]);
  const painter = await join(t, 'moving');
  await painter.edit(speckles);
  const painted = paint(painter, stamps(3, 200).map((stamp) => ({ ...stamp, layer: 0 })), 8);
  for (let i = 0; i < 40; ++i) {
    const [x, y] = [i % 7 * 8 - 30, i % 5 * 10 - 25];
    part.view();  // all of the map begins to come, and is still coming when the view is smaller
    await part.view([x, y, x + 20, y + 15]);
    if (i % 4 === 0) continue;
    await part.until(0);
    const outside = [...part.scene.chunks.values()].filter((chunk) =>
      chunk.x * 8 + 8.5 < x || chunk.x * 8 + 0.5 > x + 20 ||
      chunk.y * 8 + 8.5 < y || chunk.y * 8 + 0.5 > y + 15);
    assert.deepEqual(places(outside), []);
  }
  const seq = Math.max(...await painted);
  await Promise.all([all.until(seq), part.until(seq)]);
  all.scene.look(part.scene.view);  // drops the rest
  assert.ok(part.scene.chunks.size > 2);
  assert.equal(part.scene.meshHash(), all.scene.meshHash());
});

test('a deleted map says goodbye', inTime, async (t) => {
  await createMap(url, 'deleted');
  const client = await join(t, 'deleted');
  const closed = once(client, 'close');
  await deleteMap(url, 'deleted');
  const [why] = await closed;
  assert.equal(why.code, 'unknown_map');
  await assert.rejects(client.ping(), why);
  await assert.rejects(figuresOf(url, 'deleted'), { code: 'unknown_map' });
});

test('the example paints a ring and says what it sees', inTime, async () => {
  const example = fileURLToPath(new URL('paint.mjs', import.meta.url));
  const run = async () => {
    const { stdout } = await promisify(execFile)(process.execPath, [example, url, 'ring']);
    return JSON.parse(stdout);
  };
  const seen = await run();
  const figures = await figuresOf(url, 'ring');
  assert.equal(seen.seq, 48);
  assert.equal(seen.mesh_hash, figures.mesh_hash);
  assert.equal(seen.triangles, figures.triangles);
  assert.equal((await run()).mesh_hash, seen.mesh_hash);
});
