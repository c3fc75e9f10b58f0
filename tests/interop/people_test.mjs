// People and events, as a client is told of them: against the real server.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { eventually, inTime, join as joinAt, paint, square, stamps } from './bots.mjs';
import { createMap, describeMap } from './maps.mjs';
import { People } from './people.mjs';
import { serverForThisFile } from './server_process.mjs';

const url = await serverForThisFile();

const join = (t, map, who) => joinAt(t, url, map, who);
const until = (client, holds) => eventually(client, 'presence', holds);
const ann = { session: '0a', name: 'ann', color: '#aa0000', author: 'a0' };
const bob = { session: '0b', name: 'bob', color: '#0000bb', author: 'b0' };

test('people come, point and go', () => {
  const people = new People([ann]);
  assert.deepEqual(people.apply({ users: [bob], cursors: [{ session: '0a', x: 1, y: 2 }] }),
    ['0b', '0a']);
  assert.deepEqual(people.get('0a').cursor, { x: 1, y: 2, brush: undefined });
  assert.deepEqual(people.apply({ cursors: [{ session: '0a', hidden: true }] }), ['0a']);
  assert.equal(people.get('0a').cursor, undefined);
  assert.deepEqual(people.apply({ left: ['0a', '0c'] }), ['0a']);
  assert.deepEqual([...people.keys()], ['0b']);
});

test('all of the people replaces those before', () => {
  const people = new People([ann, bob]);
  people.apply({ cursors: [{ session: '0b', x: 1, y: 2 }] });
  people.apply({ all: true, users: [bob, { ...ann, session: '0d' }],
    cursors: [{ session: '0d', x: 3, y: 4 }] });
  assert.deepEqual([...people.keys()].sort(), ['0b', '0d']);
  assert.equal(people.get('0b').cursor, undefined);
  assert.deepEqual(people.get('0d').cursor, { x: 3, y: 4, brush: undefined });
});

test('who is there, and where they point', inTime, async (t) => {
  await createMap(url, 'people');
  const one = await join(t, 'people', { name: 'ann', color: '#aa0000' });
  const two = await join(t, 'people', { name: 'bob', color: '#0000bb' });
  const [own, other] = [one.welcome.session, two.welcome.session];
  assert.deepEqual([...two.people.keys()].sort(), [own, other].sort());
  assert.equal(two.people.get(own).name, 'ann');
  await until(one, () => one.people.has(other));
  assert.equal(one.people.get(other).color, '#0000bb');
  assert.notEqual(one.people.get(other).author, one.people.get(own).author);

  const brush = { stencil: 'square', radius: 2.5, fill: false };
  await two.cursor({ x: 3, y: -4.5 }, brush);
  const at = { x: 3, y: -4.5, brush };
  await until(one, () => one.people.get(other).cursor);
  assert.deepEqual(one.people.get(other).cursor, at);

  // Who comes later is told where the others point.
  const three = await join(t, 'people', { name: 'cec' });
  await until(three, () => three.people.get(other).cursor);
  assert.deepEqual(three.people.get(other).cursor, at);

  await two.cursor();
  await until(one, () => !one.people.get(other).cursor);
  await two.leave();
  await until(one, () => !one.people.has(other));
  await three.close();
  await until(one, () => one.people.size === 1);
});

test('a cursor that moves fast is seen where it ends', inTime, async (t) => {
  await createMap(url, 'fast');
  const one = await join(t, 'fast');
  const two = await join(t, 'fast');
  let told = 0;
  one.on('presence', () => ++told);
  for (let i = 1; i <= 500; ++i) await two.cursor({ x: i, y: 0 });
  await until(one, () => one.people.get(two.welcome.session)?.cursor?.x === 500);
  assert.ok(told < 250, `${told} times`);
});

test('a cursor beyond the world, or before a map, is refused', inTime, async (t) => {
  await createMap(url, 'edge');
  const client = await join(t, 'edge');
  await client.cursor({ x: 1e6, y: -1e6 });
  await assert.rejects(client.cursor({ x: 0, y: 1000001 }), { code: 'out_of_range', field: 'y' });
  await assert.rejects(client.cursor({ x: 0 }), { code: 'bad_field', field: 'y' });
  await client.leave();
  await assert.rejects(client.cursor({ x: 0, y: 0 }), { code: 'bad_state' });
});

test('events tell all that was painted, past and live, in order', inTime, async (t) => {
  await createMap(url, 'told', { chunk_resolution: 16 });
  const painter = await join(t, 'told');
  const reader = await join(t, 'told');
  const edits = stamps(7, 300).map((stamp) => ({ ...stamp, layer: 0 }));
  await paint(painter, edits.slice(0, 150), 16);
  const events = [];
  reader.on('event', (event) => events.push(event));
  const painting = paint(painter, edits.slice(150), 16);
  await reader.events(1);
  await painting;
  await eventually(reader, 'event', () => events.length === 300);

  assert.deepEqual(events.map(({ seq }) => seq), edits.map((_, i) => i + 1));
  const author = reader.people.get(painter.welcome.session).author;
  events.forEach((event, i) => {
    assert.equal(event.kind, 'edit');
    assert.equal(event.author, author);
    const { layer, ...stamp } = edits[i];
    for (const [field, value] of Object.entries(stamp)) assert.deepEqual(event[field], value);
  });
  assert.equal(events.at(-1).hash, (await describeMap(url, 'told')).hash);
  assert.ok(Math.abs(events.at(-1).time - Date.now()) < 3_600_000);
});

test('events begin anew where they are asked for, and end with a leave', inTime, async (t) => {
  await createMap(url, 'anew');
  const painter = await join(t, 'anew');
  const reader = await join(t, 'anew');
  const seqs = [];
  reader.on('event', ({ seq }) => seqs.push(seq));
  for (let i = 0; i < 3; ++i) await painter.edit(square(i, 0));
  await reader.events(2);
  await eventually(reader, 'event', () => seqs.length === 2);
  await reader.events(3);
  await eventually(reader, 'event', () => seqs.length === 3);
  await assert.rejects(reader.events(5), { code: 'out_of_range', field: 'from_seq' });
  await reader.events(4);
  await painter.edit(square(4, 0));
  await eventually(reader, 'event', () => seqs.length === 4);
  assert.deepEqual(seqs, [2, 3, 3, 4]);

  await reader.leave();
  await reader.join('anew');
  await painter.edit(square(5, 0));
  await reader.view();
  await reader.until(5);
  assert.equal(seqs.length, 4);
});

test('the same key is the same author, in every map', inTime, async (t) => {
  await createMap(url, 'here');
  await createMap(url, 'there');
  const first = await join(t, 'here');
  const { key, session } = first.welcome;
  const again = await join(t, 'there', { key, lastId: first.lastId });
  assert.equal(again.welcome.key, key);
  assert.notEqual(again.welcome.session, session);
  assert.equal(again.people.get(again.welcome.session).author, first.people.get(session).author);
  assert.ok(!first.people.get(session).author.includes(key.slice(0, 8)));
});
