// The whole page as a picture, compared with the ones in golden/ that somebody has looked at.
// EARTHWORK_GOLDEN=write makes those anew.
import assert from 'node:assert/strict';
import { mkdir, readFile, writeFile } from 'node:fs/promises';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { createMap } from '../interop/maps.mjs';
import { Client } from '../interop/client.mjs';
import { NARROW, openBrowser } from './browser.mjs';
import { eventually, openMap, seqOf } from './painting.mjs';
import { Pictures } from './pictures.mjs';
import { RealServer } from './real_server.mjs';

const FOLDER = path.join(import.meta.dirname, 'golden');
// Measured: the same build draws the same bytes; another one may round a channel differently.
const CHANNEL_TOLERANCE = 8;
const MOST_DIFFERING = 0.002;  // of the pixels

let browser;
let server;
let pictures;
before(async () => {
  server = await RealServer.start();
  browser = await openBrowser();
  pictures = await Pictures.open(browser);
  await paintVillage();
});
after(async () => {
  await browser?.close();
  await server?.stop();
});

let lastSeq;

// A pond with an island, a road of squares and a wall, on three layers.
async function paintVillage() {
  await createMap(server.url, 'village', { chunk_resolution: 32, chunks: [-2, -2, 2, 2], layers: [
    { name: 'meadow', color: '#8a9a5b', wall: [-2, 0] },
    { name: 'road', color: '#b08d57', wall: [0, 0.4] },
    { name: 'wall', color: '#9a8f86', wall: [0, 6] }] });
  const client = await Client.connect(server.url, { name: 'builder' });
  await client.join('village');
  const edit = (change) => client.edit({ stencil: 'circle', fill: true, layer: 0, ...change });
  await edit({ stencil: 'square', x: 0, y: 0, radius: 54 });
  await edit({ fill: false, x: 14, y: 12, radius: 24 });
  await edit({ x: 20, y: 12, radius: 7.5 });
  await edit({ layer: 1, radius: 3, path: Array.from({ length: 40 },
    (_, i) => [-50 + i * 2.2, -34 + 8 * Math.sin(i / 6)]) });
  for (const [x, y] of [[-30, 20], [-30, 38], [-12, 38]])
    await edit({ layer: 2, stencil: 'square', x, y, radius: 5.5 });
  await edit({ layer: 2, stencil: 'square', fill: false, x: -30, y: 20, radius: 3.5 });
  lastSeq = await edit({ layer: 2, x: -42, y: -10, radius: 6.25 });
  await client.close();
}

async function show(t, look, place = '') {
  const page = await browser.page({ reducedMotion: 'reduce', ...look });
  t.after(() => page.context().close());
  await page.addInitScript(() => localStorage.setItem('earthwork.person',
    JSON.stringify({ name: 'Amber Fox', color: '#d1495b' })));
  await openMap(page, server, 'village', place);
  await eventually(() => seqOf(page), (seq) => seq === lastSeq, 'the village');
  await page.locator('#people-list').getByText('Amber Fox').waitFor({ state: 'attached' });
  return page;
}

// What is different each time is left out: figures that are measured.
async function compareWithGolden(page, name) {
  await page.locator('#figures').evaluate((figures) => { figures.style.display = 'none'; });
  const shot = await page.screenshot();
  const file = path.join(FOLDER, `${name}.png`);
  if (process.env.EARTHWORK_GOLDEN === 'write') {
    await mkdir(FOLDER, { recursive: true });
    await writeFile(file, shot);
    return;
  }
  const { width, height, differing, largest } =
    await pictures.compare(shot, await readFile(file), CHANNEL_TOLERANCE);
  const share = differing === null ? 1 : differing / (width * height);
  if (share > MOST_DIFFERING) await writeFile(path.join(process.cwd(), `page-${name}.png`), shot);
  assert.ok(share <= MOST_DIFFERING,
    `${name}: ${differing} pixels differ, by up to ${largest}; see page-${name}.png`);
}

test('the desktop', async (t) => compareWithGolden(await show(t, {}), 'desktop'));
test('the desktop, dark and tilted', async (t) =>
  compareWithGolden(await show(t, { colorScheme: 'dark' }, '#0,-4,7,0.5,0.9'), 'dark'));
test('a narrow screen', async (t) => compareWithGolden(await show(t, NARROW), 'narrow'));
test('a narrow screen with the brush', async (t) => {
  const page = await show(t, NARROW);
  await page.locator('[data-sheet=brush]').tap();
  await compareWithGolden(page, 'narrow_brush');
});
