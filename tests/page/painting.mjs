// What the tests do on a page as a person does, and what they wait for.
import assert from 'node:assert/strict';
import { DEADLINE_MS } from './browser.mjs';

export const SETTINGS = { chunk_resolution: 32, chunks: [-2, -2, 2, 2],
  layers: [{ name: 'ground', color: '#8a9a5b', wall: [-1, 0] }] };

// The page at a map, once all that is in view is there.
export async function openMap(page, server, map, place = '') {
  await page.goto(`${server.url}/?map=${map}${place}`);
  await caughtUp(page);
  return page;
}

export async function caughtUp(page) {
  await page.waitForFunction(() => document.body.dataset.connection === 'joined'
    && document.getElementById('progress').hidden
    && /\d/.test(document.getElementById('figure-seq').textContent));
}

export const seqOf = async (page) =>
  Number((await page.locator('#figure-seq').textContent()).replaceAll(',', ''));

// Resolves once `holds(value)` of what `read()` resolves with; asked again and again until then.
export async function eventually(read, holds, what) {
  const end = Date.now() + DEADLINE_MS;
  for (;;) {
    const value = await read();
    if (holds(value)) return value;
    assert.ok(Date.now() < end, `${what}: still ${JSON.stringify(value)}`);
    await new Promise((resolve) => { setTimeout(resolve, 50); });
  }
}

// A ring around the middle of the canvas, in CSS pixels.
export function ring(radius, { x = 640, y = 400, steps = 40 } = {}) {
  return Array.from({ length: steps + 1 }, (_, i) => {
    const angle = i / steps * 2 * Math.PI;
    return [Math.round(x + radius * Math.cos(angle)), Math.round(y + radius * Math.sin(angle))];
  });
}

export async function drag(page, [[x, y], ...path]) {
  await page.mouse.move(x, y);
  await page.mouse.down();
  for (const [toX, toY] of path) await page.mouse.move(toX, toY);
  await page.mouse.up();
}

// The middle of the picture, without panels.
export const picture = (page) =>
  page.screenshot({ clip: { x: 300, y: 110, width: 680, height: 580 } });
