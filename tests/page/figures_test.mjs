// How quick the page is. Figures are printed, and never judged: a busy machine is slow.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { createMap } from '../interop/maps.mjs';
import { Client } from '../interop/client.mjs';
import { openBrowser } from './browser.mjs';
import { drag, eventually, openMap, ring } from './painting.mjs';
import { RealServer } from './real_server.mjs';

let browser;
let server;
before(async () => {
  server = await RealServer.start();
  browser = await openBrowser();
});
after(async () => {
  await browser?.close();
  await server?.stop();
});

const figures = (page) => page.evaluate(() => window.earthwork.figures());
const median = (list) => list.toSorted((a, b) => a - b)[Math.floor(list.length / 2)];

// 1,024 x 1,024 voxels with something in every chunk.
async function largeMap() {
  await createMap(server.url, 'large', { chunk_resolution: 64, chunks: [-8, -8, 8, 8] });
  const client = await Client.connect(server.url, { name: 'builder' });
  await client.join('large');
  const edits = [];
  for (let x = -480; x < 512; x += 32)
    edits.push(client.edit({ stencil: 'circle', fill: true, radius: 9.5,
      path: Array.from({ length: 31 }, (_, i) => [x, -480 + i * 32]) }));
  await Promise.all(edits);
  await client.close();
}

test('first picture, whole picture, input to picture', async (t) => {
  await largeMap();
  const page = await browser.page();
  t.after(() => page.context().close());
  await openMap(page, server, 'large');
  const opened = await eventually(() => figures(page), (now) => now.whole_picture_ms > 0, 'the picture');
  await page.keyboard.press('e');
  for (let i = 0; i < 10; ++i) {
    const { input_to_picture_ms: before } = await figures(page);
    await drag(page, ring(20 + 10 * i, { steps: 6 }));
    await eventually(() => figures(page),
      (now) => now.input_to_picture_ms.length > before.length, 'the stroke');
  }
  const painted = await figures(page);
  const report = { first_picture_ms: opened.first_picture_ms, whole_picture_ms: opened.whole_picture_ms,
    triangles: opened.triangles, input_to_picture_ms_median: median(painted.input_to_picture_ms),
    draw_ms_median: median(painted.draw_ms), heap_bytes: painted.heap_bytes };
  t.diagnostic(JSON.stringify(report));
  assert.ok(Object.values(report).every(Number.isFinite));
});
