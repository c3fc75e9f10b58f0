// What the tests of the client share: who joins, who watches, and what they paint.
import assert from 'node:assert/strict';
import { Client } from './client.mjs';
import { twiceArea } from './mesh_hash.mjs';

const UNIT = 32768;

export const inTime = { timeout: 60_000 };

export async function join(t, url, map, who = {}) {
  const client = await Client.connect(url, who);
  t.after(() => client.close());
  await client.join(map);
  return client;
}

// Joins and looks; `changes` gathers the records that come.
export async function watch(t, url, map, rect) {
  const client = await join(t, url, map, { name: 'watcher' });
  const changes = [];
  client.on('change', (records) => changes.push(...records));
  await client.view(rect);
  await client.until(0);
  return { client, changes };
}

// Resolves once `holds` does, which may change with any event of that name.
export function eventually(emitter, event, holds) {
  return new Promise((resolve, reject) => {
    const look = () => {
      if (!holds()) return;
      emitter.off(event, look).off('close', reject);
      resolve();
    };
    emitter.on(event, look).on('close', reject);
    look();
  });
}

export const square = (x, y, radius = 2, fill = true) =>
  ({ stencil: 'square', fill, x, y, radius });

// The same stamps at every run: circles, squares and paths, filled and emptied, on both layers.
export function stamps(seed, count) {
  let state = seed;
  const next = (low, high) => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return low + state / 2 ** 32 * (high - low);
  };
  return Array.from({ length: count }, (_, i) => {
    const [x, y] = [next(-30, 30), next(-30, 30)];
    const place = i % 3 === 2
      ? { path: Array.from({ length: 8 }, (_, k) => [x + k * next(0, 1), y + k * next(-1, 1)]) }
      : { x, y };
    const stencil = i % 2 === 0 ? 'circle' : 'square';
    return { stencil, fill: next(0, 1) < 0.7, radius: next(0.1, 5), layer: i % 2, ...place };
  });
}

// One edit whose group takes several messages: neighbours come in different ones.
export const speckles = {
  stencil: 'circle', fill: true, radius: 0.7,
  path: Array.from({ length: 625 }, (_, i) => [i % 25 * 2.4 - 30, Math.floor(i / 25) * 2.4 - 30]),
};

// Paints with up to `window` edits unanswered at once. Returns their numbers.
export async function paint(client, edits, window) {
  const numbers = [];
  for (let i = 0; i < edits.length; i += window) {
    numbers.push(...await Promise.all(edits.slice(i, i + window).map((e) => client.edit(e))));
  }
  return numbers;
}

// The scene is all that the server's figures count.
export function assertHolds({ scene, joined }, figures) {
  const chunks = [...scene.chunks.values()];
  const total = (count) => chunks.reduce((sum, chunk) => sum + count(chunk.mesh), 0);
  const scale = joined.settings.voxel_size / UNIT;
  const length = ({ xs, ys, sections }) => sections.reduce(
    (sum, { start, end }) => sum + Math.hypot(xs[end] - xs[start], ys[end] - ys[start]), 0);
  const near = (actual, expected, what) =>
    assert.ok(Math.abs(actual - expected) <= 1e-9 * expected, `${what}: ${actual}, ${expected}`);

  assert.equal(scene.seq, figures.seq);
  assert.equal(scene.meshHash(), figures.mesh_hash);
  assert.equal(chunks.length, figures.meshed_chunks);
  assert.equal(total((mesh) => mesh.indices.length / 3), figures.triangles);
  assert.equal(total((mesh) => mesh.xs.length), figures.vertices);
  near(total(twiceArea) / 2 * scale ** 2, figures.surface_area, 'area');
  near(total(length) * scale, figures.wall_length, 'wall length');
}
