// All but free painting without a pointer: Tab, Enter, Space, arrows and typing, on the real page.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { createMap, describeMap } from '../interop/maps.mjs';
import { violations } from './accessibility.mjs';
import { openBrowser } from './browser.mjs';
import { caughtUp, eventually, openMap, seqOf, SETTINGS } from './painting.mjs';
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

const MOST_STOPS = 80;

// Goes on with Tab until what has the focus is called that.
async function tabTo(page, name) {
  const seen = [];
  for (let stop = 0; stop < MOST_STOPS; ++stop) {
    const found = await page.evaluate(() => {
      const at = document.activeElement;
      return at.getAttribute('aria-label') ?? at.labels?.[0]?.textContent.trim() ?? at.textContent.trim();
    });
    if (found === name) return;
    seen.push(found);
    await page.keyboard.press('Tab');
  }
  assert.fail(`Tab does not lead to "${name}", but to ${seen.join(' | ')}`);
}

async function choose(page, name, key = 'Enter') {
  await tabTo(page, name);
  await page.keyboard.press(key);
}

async function type(page, name, text) {
  await tabTo(page, name);
  await page.keyboard.press('Control+A');
  await page.keyboard.type(text);
}

test('a map is made, changed, talked about, painted and exported by keys', async (t) => {
  await createMap(server.url, 'demo', SETTINGS);
  const page = await browser.page();
  t.after(() => page.context().close());
  await openMap(page, server, 'demo');

  await choose(page, 'Map: demo');
  await choose(page, 'New map');
  await type(page, 'Name', 'keys');
  await choose(page, 'Create and open');
  await page.waitForURL(/\?map=keys/);
  await caughtUp(page);

  await choose(page, 'Add a layer');
  await page.getByRole('radio', { name: 'layer 2' }).waitFor();
  await choose(page, 'Name and heights of layer 2');
  await page.keyboard.type('terrace');
  await page.keyboard.press('Enter');
  await page.getByRole('radio', { name: 'terrace' }).waitFor();
  await type(page, 'Surface at', '3');
  await page.keyboard.press('Tab');
  const layer = async () => (await describeMap(server.url, 'keys')).settings.layers[1];
  await eventually(layer, ({ name, wall }) => name === 'terrace' && wall[1] === 3, 'the layer');

  const guest = await browser.page();
  t.after(() => guest.context().close());
  await openMap(guest, server, 'keys');
  const name = await guest.evaluate(() => JSON.parse(localStorage['earthwork.person']).name);
  await page.getByRole('button', { name: `Follow ${name}` }).waitFor();
  await page.waitForFunction((label) =>
    !document.querySelector(`[aria-label="Follow ${label}"]`).disabled, name);
  await choose(page, `Follow ${name}`);
  await page.getByText(`Following ${name}`).waitFor();
  await choose(page, 'Stop');

  await type(page, 'Say something', 'done by keys');
  await page.keyboard.press('Enter');
  await guest.getByRole('log').getByText('done by keys').waitFor();

  const { seq } = await describeMap(server.url, 'keys');
  await tabTo(page, 'Map keys');
  await page.keyboard.press('Enter');
  await eventually(() => describeMap(server.url, 'keys'), (map) => map.seq === seq + 1, 'the stamp');

  const saved = page.waitForEvent('download');
  await choose(page, 'Export glTF');
  assert.equal((await saved).suggestedFilename(), 'keys.glb');
  await page.keyboard.press('?');
  await page.getByRole('dialog', { name: 'Keys and gestures' }).waitFor();
  await page.keyboard.press('Escape');
  assert.equal(await page.evaluate(() => document.activeElement.id), 'export');
});

test('every control has a name, and axe finds nothing', async (t) => {
  const page = await browser.page();
  t.after(() => page.context().close());
  await openMap(page, server, 'demo');
  const tree = await page.locator('body').ariaSnapshot();
  const controls = tree.split('\n').filter((line) =>
    /^\s*- (button|link|textbox|spinbutton|slider|radio|combobox|application)/.test(line));
  assert.ok(controls.length > 25, tree);
  assert.deepEqual(controls.filter((line) => !/"[^"]+"/.test(line)), []);
  assert.deepEqual(await violations(page), []);
});

test('space is not held any more once the window lost the keyboard', async (t) => {
  await createMap(server.url, 'space', SETTINGS);
  const page = await browser.page();
  t.after(() => page.context().close());
  await openMap(page, server, 'space');
  const before = await seqOf(page);
  const drag = async () => {
    await page.mouse.move(640, 400);
    await page.mouse.down();
    await page.mouse.move(660, 400);
    await page.mouse.up();
  };
  await page.keyboard.down('Space');
  await drag();
  // Its release is told to the other window.
  await page.evaluate(() => window.dispatchEvent(new FocusEvent('blur')));
  await drag();
  await eventually(() => seqOf(page), (seq) => seq > before, 'painted after the blur');
});
