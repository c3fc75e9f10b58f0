// People together on the real page and the real server, the server killed in between.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { createMap, describeMap } from '../interop/maps.mjs';
import { Client } from '../interop/client.mjs';
import { NARROW, openBrowser } from './browser.mjs';
import { caughtUp, drag, eventually, openMap, picture, ring, seqOf, SETTINGS } from './painting.mjs';
import { Pictures } from './pictures.mjs';
import { RealServer } from './real_server.mjs';

let browser;
let server;
let pictures;
before(async () => {
  server = await RealServer.start();
  browser = await openBrowser();
  pictures = await Pictures.open(browser);
});
after(async () => {
  await browser?.close();
  await server?.stop();
});

async function visit(t, map, { place, ...options } = {}) {
  const page = await browser.page(options);
  t.after(() => page.context().close());
  return openMap(page, server, map, place);
}

const description = (map) => describeMap(server.url, map);

// Resolves once the page's figures show that event, drawn.
const sees = (page, seq) => eventually(() => seqOf(page), (shown) => shown >= seq, `event ${seq}`);

// A ring is more than that, and a cursor with its name is less.
const MANY_PIXELS = 6000;
const differing = async (page, before) =>
  (await pictures.compare(before, await picture(page), 24)).differing;

const changes = (page, before) => eventually(() => differing(page, before),
  (pixels) => pixels > MANY_PIXELS, 'pixels of the picture that changed');

// Says so after a stroke, so that who reads it knows that the stroke was sent before.
async function tell(page, words) {
  await page.getByRole('textbox', { name: 'Say something' }).fill(words);
  await page.keyboard.press('Enter');
}
const reads = (page, words) => page.getByRole('log').getByText(words, { exact: true }).waitFor();

// All events of a map.
async function eventsOf(t, map) {
  const client = await Client.connect(server.url, { name: 'reader' });
  t.after(() => client.close());
  await client.join(map);
  const events = [];
  client.on('event', (event) => events.push(event));
  await client.events(1);
  const { seq } = await description(map);
  await eventually(() => events.length, (count) => count >= seq, 'events');
  return events;
}

const stampsOf = async (t, map) =>
  (await eventsOf(t, map)).reduce((sum, { path }) => sum + (path?.length ?? 1), 0);

test('what one paints the other sees, also after the server was killed', async (t) => {
  await createMap(server.url, 'together', SETTINGS);
  await createMap(server.url, 'control', SETTINGS);
  const place = '#0,0,5';
  const painter = await visit(t, 'together', { place });
  const watcher = await visit(t, 'together', { place });
  const empty = await picture(watcher);
  await drag(painter, ring(120));
  await tell(painter, 'a ring');
  await reads(watcher, 'a ring');
  await sees(watcher, (await description('together')).seq);
  await changes(watcher, empty);

  const ringed = await picture(watcher);
  t.after(() => server.startAgain());
  await server.kill();
  for (const page of [painter, watcher])
    await page.waitForFunction(() => document.body.dataset.connection === 'lost');
  assert.match(await painter.locator('#banner-words').textContent(), /\w/);
  await drag(painter, ring(200));
  await drag(painter, ring(40));
  assert.ok(await differing(watcher, ringed) < MANY_PIXELS);

  await server.startAgain();
  for (const page of [painter, watcher]) {
    if (await page.locator('#banner').isVisible())
      await page.getByRole('button', { name: 'Retry now' }).click({ timeout: 2000 }).catch(() => {});
    await page.waitForFunction(() => document.body.dataset.connection === 'joined');
  }
  await drag(painter, ring(160));
  await changes(watcher, ringed);

  // The same gestures on another map, with nothing in between.
  const control = await visit(t, 'control', { place });
  for (const radius of [120, 200, 40, 160]) await drag(control, ring(radius));
  await eventually(async () => [await description('together'), await description('control')],
    ([one, other]) => one.hash === other.hash, 'the hashes of both maps');
  // None is missing, by the hash, and none was made twice, by how many they are. A ring's last stamp
  // lies on its first one, so the hashes agree before it has come.
  await eventually(async () => [await stampsOf(t, 'together'), await stampsOf(t, 'control')],
    ([one, other]) => one === other, 'the stamps of both maps');
  await sees(painter, (await description('together')).seq);
  assert.deepEqual(watcher.complaints.filter((text) => !/WebSocket|ERR_CONNECTION/.test(text)), []);
});

test('one finger paints, two zoom', async (t) => {
  await createMap(server.url, 'touched', SETTINGS);
  const page = await visit(t, 'touched', { ...NARROW, place: '#0,0,5' });
  const touch = await page.context().newCDPSession(page);
  const fingers = (type, ...points) => touch.send('Input.dispatchTouchEvent',
    { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });

  await fingers('touchStart', [120, 300]);
  for (let x = 130; x <= 260; x += 10) await fingers('touchMove', [x, 300]);
  await fingers('touchEnd');
  await eventually(() => description('touched'), (map) => map.seq > 0, 'the stroke');
  assert.equal(new URL(page.url()).hash, '#0,0,5');

  await fingers('touchStart', [180, 400], [210, 400]);
  for (let step = 1; step <= 10; ++step)
    await fingers('touchMove', [180 - 6 * step, 400], [210 + 6 * step, 400]);
  await fingers('touchEnd');
  const zoom = await eventually(() => Number(new URL(page.url()).hash.split(',')[2]),
    (value) => value > 10, 'the zoom');
  assert.ok(zoom < 50, `zoom ${zoom}`);
  // The page itself neither zooms nor scrolls; that the pinch paints nothing is seen at the end.
  assert.deepEqual(await page.evaluate(() => [visualViewport.scale, scrollX, scrollY]), [1, 0, 0]);
  await page.locator('#quick-fill').tap();
  await fingers('touchStart', [200, 300]);
  await fingers('touchEnd');
  const events = await eventually(() => eventsOf(t, 'touched'),
    (all) => all.at(-1).fill === false, 'the stamp');
  const painted = events.slice(0, -1).flatMap(({ path }) => path);
  assert.ok(painted.length > 1);
  assert.ok(painted.every(([, y]) => Math.abs(y - painted[0][1]) < 0.01), JSON.stringify(painted));
});

test('chat, layers and people are the same for all', async (t) => {
  await createMap(server.url, 'talk', SETTINGS);
  const one = await visit(t, 'talk');
  const other = await visit(t, 'talk');
  await tell(one, 'Where does the road go?');
  await reads(other, 'Where does the road go?');
  await one.locator('#chat-lines .mine').getByText('Where does the road go?').waitFor();

  await other.getByRole('button', { name: 'Add a layer' }).click();
  await one.getByRole('radio', { name: 'layer 2' }).waitFor();
  await one.getByRole('button', { name: 'Name and heights of layer 2' }).click();
  await one.keyboard.type('road');
  await one.keyboard.press('Enter');
  await other.getByRole('radio', { name: 'road' }).waitFor();
  const { settings } = await description('talk');
  assert.deepEqual(settings.layers.map(({ name }) => name), ['ground', 'road']);

  await other.getByRole('button', { name: 'Change your name and colour' }).click();
  await other.keyboard.type('Zoë');
  await other.keyboard.press('Enter');
  await one.locator('#people-list').getByText('Zoë').waitFor();
  assert.equal(await one.locator('#people-list li').count(), 2);
});

test('what is refused is said in words', async (t) => {
  const layers = Array.from({ length: 16 }, (_, i) => ({ name: `n${i}`, wall: [i, i + 1] }));
  await createMap(server.url, 'full', { ...SETTINGS, layers });
  const page = await visit(t, 'full');
  await page.getByRole('button', { name: 'Add a layer' }).click();
  await page.getByText(/at most 16 layers/).first().waitFor();
  await page.getByRole('button', { name: 'Name and heights of n0' }).click();
  await page.locator('#layer-fields-0').getByLabel('Wall down to').fill('7');
  await page.keyboard.press('Tab');
  await page.getByText(/wall.*(bottom|top|below|above)/).first().waitFor();
  assert.equal((await description('full')).seq, 0);
});

test('maps are made, opened and deleted from the page', async (t) => {
  await createMap(server.url, 'first', SETTINGS);
  const page = await visit(t, 'first');
  const watcher = await visit(t, 'first');
  await page.getByRole('button', { name: /^Map:/ }).click();
  await page.getByText('New map').click();
  await page.locator('#new-map-form').getByLabel('Name', { exact: true }).fill('second');
  await page.getByLabel('Voxel size').fill('-1');
  await page.getByRole('button', { name: 'Create and open' }).click();
  await page.getByText(/voxel_size/).waitFor();
  await page.getByLabel('Voxel size').fill('0.5');
  await page.getByRole('button', { name: 'Create and open' }).click();
  await page.waitForURL(/\?map=second/);
  await caughtUp(page);
  assert.equal((await description('second')).settings.voxel_size, 0.5);

  await page.getByRole('button', { name: /^Map:/ }).click();
  await page.getByRole('button', { name: 'Delete first' }).click();
  await page.keyboard.type('first');
  await page.getByRole('button', { name: 'Delete first for everybody' }).click();
  await watcher.getByRole('button', { name: 'Choose a map' }).waitFor();
  assert.match(await watcher.locator('#banner-words').textContent(), /\w/);
});

test('a link leads to its place, and a reload is the same author', async (t) => {
  await createMap(server.url, 'linked', SETTINGS);
  const page = await visit(t, 'linked', { place: '#12,-7,9.5' });
  assert.equal(new URL(page.url()).hash, '#12,-7,9.5');
  const stamp = async () => {
    const { seq } = await description('linked');
    await page.locator('#canvas').focus();
    await page.keyboard.press('Enter');
    await eventually(() => description('linked'), (map) => map.seq === seq + 1, 'the stamp');
  };
  await stamp();
  await page.reload();
  await caughtUp(page);
  assert.equal(new URL(page.url()).hash, '#12,-7,9.5');
  await stamp();

  const tab = await page.context().newPage();
  await openMap(tab, server, 'linked', '#12,-7,9.5');
  await tab.locator('#canvas').focus();
  await tab.keyboard.press('Enter');
  await eventually(() => description('linked'), (map) => map.seq === 3, 'the stamp of the tab');
  const events = await eventsOf(t, 'linked');
  assert.equal(events[0].author, events[1].author);
  assert.notEqual(events[2].author, events[0].author);
  assert.deepEqual(events.map(({ path }) => path), [[[12, -7]], [[12, -7]], [[12, -7]]]);
});
