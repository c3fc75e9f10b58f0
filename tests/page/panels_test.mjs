// The panels alone: the page's own files around a fake viewer, so that each state of it can be had.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { readFile } from 'node:fs/promises';
import { fileURLToPath } from 'node:url';
import { violations } from './accessibility.mjs';
import { NARROW, openBrowser, openTab } from './browser.mjs';
import { servePage } from './page_server.mjs';

let browser;
let server;
before(async () => {
  server = await servePage();
  browser = await openBrowser();
});
after(async () => {
  await browser?.close();
  server?.close();
});

// A page at `link` with the fake viewer running.
async function open(t, { link = '/?map=demo', ...options } = {}) {
  const page = await browser.page(options);
  t.after(() => page.context().close());
  await page.goto(server.url + link);
  await page.waitForFunction(() => window.fake?.options);
  return page;
}
const tell = (page, parts) => page.evaluate((change) => window.fake.tell(change), parts);
const commands = (page) => page.evaluate(() => window.fake.commands.splice(0));
const refuse = (page, answer) => page.evaluate((no) => { window.fake.refuse = no; }, answer);
const options = (page) => page.evaluate(() => window.fake.options);

const person = (session, name, more = {}) =>
  ({ session, name, color: '#2f7fd1', me: false, view: true, followed: false, ...more });
const said = (n, text, more = {}) =>
  ({ n, time: 1_700_000_000_000 + n, name: 'Quiet Heron', color: '#2f7fd1', text, mine: false, ...more });

test('the brush is shown as the viewer says, and asked for', async (t) => {
  const page = await open(t);
  await page.getByRole('radio', { name: 'Empty' }).check();
  await page.getByRole('radio', { name: 'Square' }).check();
  await page.getByRole('radio', { name: 'Lines' }).check();
  await page.getByRole('radio', { name: 'Move' }).check();
  await page.getByRole('slider', { name: 'Radius' }).fill('12.5');
  await page.getByRole('spinbutton', { name: 'Radius' }).fill('7.25');
  await page.keyboard.press('Enter');
  assert.deepEqual(await commands(page), [
    { do: 'brush', fill: false }, { do: 'brush', stencil: 'square' }, { do: 'brush', snap: 'lines' },
    { do: 'tool', tool: 'move' }, { do: 'brush', radius: 12.5 }, { do: 'brush', radius: 7.25 }]);

  await tell(page, { brush:
    { tool: 'paint', stencil: 'circle', fill: true, radius: 20, layer: 0, snap: 'none' } });
  assert.ok(await page.getByRole('radio', { name: 'Fill' }).isChecked());
  assert.ok(await page.getByRole('radio', { name: 'Paint' }).isChecked());
  assert.equal(await page.locator('#radius-slider').inputValue(), '20');

  await refuse(page, { field: 'radius', message: 'radius: 60 is beyond the limit of 50' });
  await page.locator('#radius').fill('60');
  await page.keyboard.press('Enter');
  assert.equal(await page.locator('#brush-error').textContent(), 'radius: 60 is beyond the limit of 50');
  assert.equal(await page.locator('#radius').getAttribute('aria-invalid'), 'true');
});

test('after a click, and after Enter in the radius, the keys are the map\'s', async (t) => {
  const page = await open(t);
  const focused = () => page.evaluate(() => document.activeElement.id || document.activeElement.name);
  const onTheMap = () => page.waitForFunction(() => document.activeElement.id === 'canvas');
  await page.getByRole('radio', { name: 'Square' }).click();
  await onTheMap();
  await page.keyboard.press('ArrowLeft');
  assert.deepEqual(await commands(page), [{ do: 'brush', stencil: 'square' }]);
  await page.getByRole('button', { name: 'Hide ground' }).click();
  await onTheMap();
  assert.match(await page.locator('#layers-unseen').textContent(), /^ground is painted on/);
  await page.getByRole('button', { name: 'Show ground' }).click();
  assert.equal(await page.locator('#layers-unseen').textContent(), '');
  await page.getByRole('button', { name: 'Name and heights of ground' }).click();
  await page.keyboard.type('moss');
  assert.equal(await page.locator('#layer-fields-0').getByLabel('Name').inputValue(), 'moss');

  await page.locator('#radius').fill('12');
  await page.keyboard.press('Enter');
  await onTheMap();
  await page.locator('#radius').fill('');
  await page.keyboard.press('Tab');
  assert.equal(await page.locator('#radius').inputValue(), '12');
  await page.getByRole('radio', { name: 'Square' }).focus();
  await page.keyboard.press('ArrowLeft');
  assert.equal(await focused(), 'stencil');
});

test('layers are chosen, hidden, added and changed', async (t) => {
  const page = await open(t);
  await page.getByRole('button', { name: 'Add a layer' }).click();
  await page.getByRole('radio', { name: 'layer 2' }).check();
  await page.getByRole('button', { name: 'Hide ground' }).click();
  await page.getByRole('button', { name: 'Show ground' }).click();
  await page.getByLabel('Colour of layer 2').fill('#112233');
  await page.getByRole('button', { name: 'Name and heights of layer 2' }).click();
  await page.keyboard.type('water');
  await page.keyboard.press('Enter');
  await page.locator('#layer-fields-1').getByLabel('Surface at').fill('2.5');
  await page.keyboard.press('Tab');
  assert.deepEqual(await commands(page), [
    { do: 'layer', color: '#b08d57', wall: [0, 1] }, { do: 'brush', layer: 1 },
    { do: 'show', layer: 0, visible: false }, { do: 'show', layer: 0, visible: true },
    { do: 'layer', layer: 1, color: '#112233' }, { do: 'layer', layer: 1, name: 'water' },
    { do: 'layer', layer: 1, wall: [0, 2.5] }]);
  assert.ok(await page.getByRole('radio', { name: 'water' }).isChecked());

  await refuse(page, { field: 'wall', message: 'wall: the bottom is not below the top' });
  await page.locator('#layer-fields-1').getByLabel('Wall down to').fill('9');
  await page.keyboard.press('Tab');
  assert.equal(await page.locator('#layer-error-1').textContent(),
    'wall: the bottom is not below the top');
});

test('what arrives does not disturb a field that is being typed in', async (t) => {
  const page = await open(t);
  await page.getByRole('button', { name: 'Name and heights of ground' }).click();
  const field = page.locator('#layer-fields-0').getByLabel('Name');
  await field.fill('half a na');
  await tell(page, { map: { name: 'demo', epoch: '', hidden: [], settings: {
    layers: [{ name: 'meadow', color: '#00ff00', wall: [-4, 4] }] } } });
  assert.equal(await field.inputValue(), 'half a na');
  assert.equal(await page.locator('#layer-fields-0').getByLabel('Surface at').inputValue(), '4');
  assert.equal(await page.locator('.layer-name').textContent(), 'meadow');
});

test('people are followed where they have a view', async (t) => {
  const page = await open(t);
  const me = person('s1', 'Amber Fox', { me: true });
  await tell(page, { people: { people: [me, person('s2', 'Quiet Heron'),
    person('s3', 'a bot', { view: false })] } });
  assert.ok(await page.getByRole('button', { name: 'Follow a bot' }).isDisabled());
  await page.getByRole('button', { name: 'Follow Quiet Heron' }).click();
  assert.equal(await page.locator('#following-words').textContent(), 'Following Quiet Heron');
  await page.getByRole('button', { name: 'Stop', exact: true }).click();
  assert.deepEqual(await commands(page), [{ do: 'follow', session: 's2' }, { do: 'follow' }]);
  assert.ok(await page.locator('#following').isHidden());
  await tell(page, { people: { people: [me] } });
  assert.equal(await page.locator('#people-list li').count(), 1);
});

test('new lines of the chat are announced and counted while it is folded', async (t) => {
  const page = await open(t);
  await tell(page, { chat: { lines: [said(1, 'earlier')] } });
  assert.equal(await page.locator('#chat-lines').getAttribute('aria-live'), 'polite');
  await page.getByRole('button', { name: 'Chat' }).click();
  await tell(page, { chat: { lines: [said(1, 'earlier'), said(2, 'hello'),
    said(3, 'mine', { mine: true })] } });
  assert.equal(await page.locator('#chat-unread').textContent(), '1 unread');
  await page.getByRole('button', { name: 'Chat' }).click();
  assert.ok(await page.locator('#chat-unread').isHidden());
  assert.deepEqual(await page.locator('#chat-lines p').allTextContents(), ['earlier', 'hello', 'mine']);
  assert.equal(await page.locator('#chat-lines .mine').count(), 1);
});

test('what was said before one came is not announced, and a new server counts anew', async (t) => {
  const page = await open(t);
  const list = page.locator('#chat-lines');
  await page.getByRole('button', { name: 'Chat' }).click();
  await tell(page, { chat: { lines: [], known: false } });
  await tell(page, { chat: { lines: [said(1, 'one'), said(2, 'two')], known: false } });
  await tell(page, { chat: { lines: [said(1, 'one'), said(2, 'two')], known: true } });
  assert.equal(await list.getAttribute('aria-live'), 'off');
  assert.ok(await page.locator('#chat-unread').isHidden());
  const later = (n, text) => said(n, text, { time: 1_800_000_000_000 + n });
  await tell(page, { chat: { lines: [later(1, 'a'), later(2, 'b'), later(3, 'c')], known: true } });
  assert.deepEqual(await list.locator('p').allTextContents(), ['a', 'b', 'c']);
});

test('a line of the chat has at most 500 characters, counted near the end', async (t) => {
  const page = await open(t);
  const text = page.getByRole('textbox', { name: 'Say something' });
  await text.fill('x'.repeat(399));
  assert.ok(await page.locator('#chat-counter').isHidden());
  await text.fill('🦊'.repeat(500));
  assert.equal(await page.locator('#chat-counter').textContent(), '500 of 500 characters');
  await refuse(page, { field: 'text', message: 'text: at most 500 characters' });
  await text.fill('x'.repeat(501));
  await page.keyboard.press('Enter');
  assert.equal(await page.locator('#chat-error').textContent(), 'text: at most 500 characters');
  assert.equal(await text.inputValue(), 'x'.repeat(501));
  await text.fill(' short ');
  await page.keyboard.press('Enter');
  assert.deepEqual((await commands(page)).at(-1), { do: 'chat', text: 'short' });
  assert.equal(await text.inputValue(), '');
});

test('a map is made with its settings, and opened', async (t) => {
  const page = await open(t);
  await page.getByRole('button', { name: /^Map:/ }).click();
  await page.getByText('New map').click();
  const form = page.locator('#new-map-form');
  await form.getByLabel('Name', { exact: true }).fill('Not So');
  await page.keyboard.press('Enter');
  assert.match(await page.locator('#new-map-error').textContent(), /small letters/);
  await form.getByLabel('Name', { exact: true }).fill('demo');
  await page.keyboard.press('Enter');
  await page.waitForFunction(() => /there is a map demo/.test(
    document.getElementById('new-map-error').textContent));
  await form.getByLabel('Name', { exact: true }).fill('moor');
  await form.getByLabel('Chunks across').fill('5');
  await form.getByLabel('Voxels along a chunk').selectOption('64');
  assert.equal(await page.locator('#new-map-voxels').textContent(), '320 × 512 voxels');
  await page.getByRole('button', { name: 'One more layer' }).click();
  await form.getByLabel('Name of layer 2').fill('reed');
  const made = page.waitForRequest((request) => request.method() === 'POST');
  await page.getByRole('button', { name: 'Create and open' }).click();
  assert.deepEqual((await made).postDataJSON(), { name: 'moor', settings: {
    chunk_resolution: 64, voxel_size: 1, chunks: [-2, -4, 3, 4], layers: [
      { name: 'ground', color: '#8a9a5b', wall: [-1, 0] },
      { name: 'reed', color: '#b08d57', wall: [0, 1] }] } });
  await page.waitForURL(/\?map=moor/);
  assert.deepEqual(await commands(page), [{ do: 'join', map: 'moor' }]);
  await page.goBack();
  await page.waitForFunction(() => window.fake.commands.length === 2);
  assert.deepEqual(await commands(page),
    [{ do: 'join', map: 'demo' }, { do: 'camera', x: 0, y: 0, zoom: 16 }]);
  server.maps.delete('moor');

  // The next one starts as the first did.
  await page.getByRole('button', { name: /^Map:/ }).click();
  await page.getByText('New map').click();
  assert.equal(await form.getByLabel('Name of layer 1').inputValue(), 'ground');
  assert.equal(await form.getByLabel('Layer 1: wall down to').inputValue(), '-1');
  assert.equal(await form.getByLabel('Name of layer 2').count(), 0);
});

test('a map is deleted once its name was typed', async (t) => {
  server.maps.add('fen');
  const page = await open(t);
  await page.getByRole('button', { name: /^Map:/ }).click();
  await page.getByRole('button', { name: 'Delete fen' }).click();
  const sure = page.getByRole('button', { name: 'Delete fen for everybody' });
  await page.keyboard.type('fe');
  assert.ok(await sure.isDisabled());
  await page.keyboard.press('Escape');
  assert.equal(await sure.count(), 0);
  assert.ok(await page.locator('#maps-dialog').isVisible());
  await page.keyboard.press('Enter');
  await page.keyboard.type('fen');
  await sure.click();
  await page.getByRole('button', { name: 'Delete fen', exact: true }).waitFor({ state: 'detached' });
  assert.ok(!server.maps.has('fen'));
});

test('a link names the map and the place, and follows the camera', async (t) => {
  const page = await open(t, { link: '/?map=other#10.5,-2,8,0.5,0.25' });
  assert.equal((await options(page)).map, 'other');
  assert.deepEqual((await options(page)).place, { x: 10.5, y: -2, zoom: 8, yaw: 0.5, tilt: 0.25 });
  await tell(page, { camera: { x: 3.14159, y: -7, zoom: 20.12345, yaw: 0, tilt: 0 } });
  assert.equal(await page.evaluate(() => location.search + location.hash), '?map=other#3.142,-7,20.12');
  await page.evaluate(() => { location.hash = '#1,2,3'; });
  await page.waitForFunction(() => window.fake.commands.length === 1);
  assert.deepEqual(await commands(page), [{ do: 'camera', x: 1, y: 2, zoom: 3 }]);
});

test('without a map in the link it is demo, else the first, else the dialog', async (t) => {
  const page = await open(t, { link: '/' });
  assert.equal((await options(page)).map, 'demo');
  const before = [...server.maps];
  server.maps.delete('demo');
  await page.goto(server.url);
  await page.waitForFunction(() => window.fake?.options);
  assert.equal((await options(page)).map, 'other');
  server.maps.clear();
  await page.goto(server.url);
  await page.getByText('There is no map yet').waitFor();
  for (const name of before) server.maps.add(name);
});

test('a link with what can be no name says which map is open instead', async (t) => {
  const page = await open(t, { link: '/?map=Demo' });
  assert.equal((await options(page)).map, 'demo');
  await page.getByText(/name in the link: this is demo/).first().waitFor();
});

test('the browser asks before edits are lost with the page', async (t) => {
  const page = await open(t);
  const asked = [];
  page.on('dialog', async (dialog) => {
    asked.push(dialog.type());
    await dialog.accept();
  });
  const figures = { seq: 7, fps: 0, bytes: 0, chunks: 1, triangles: 2, caught_up: true };
  await page.getByRole('radio', { name: 'Empty' }).check();
  await tell(page, { status: { ...figures, unanswered: 0 } });
  await page.reload();
  assert.deepEqual(asked, []);
  await page.waitForFunction(() => window.fake?.options);
  await page.getByRole('radio', { name: 'Empty' }).check();
  await tell(page, { status: { ...figures, unanswered: 2 } });
  await page.reload();
  assert.deepEqual(asked, ['beforeunload']);
});

test('name and colour are remembered, the key by the tab alone', async (t) => {
  const page = await open(t);
  const first = await options(page);
  assert.match(first.name, /^[A-Z][a-z]+ [A-Z][a-z]+$/);
  assert.match(first.color, /^#[0-9a-f]{6}$/);
  assert.equal(first.key, undefined);
  await page.getByRole('button', { name: 'Change your name and colour' }).click();
  await page.keyboard.type('Zoë');
  await page.getByRole('radio', { name: /#9a52c7/ }).check();
  await page.keyboard.press('Enter');
  assert.deepEqual(await commands(page), [{ do: 'person', name: 'Zoë', color: '#9a52c7' }]);

  await page.reload();
  await page.waitForFunction(() => window.fake?.options);
  const second = await options(page);
  assert.equal(second.name, 'Zoë');
  assert.equal(second.key, 'f'.repeat(32));
  assert.ok(second.last_id > first.last_id);
  // What a duplicated tab would start with.
  assert.deepEqual(await page.evaluate(() => ({ ...sessionStorage })), {});

  const tab = await openTab(page.context());
  await tab.goto(`${server.url}/?map=demo`);
  await tab.waitForFunction(() => window.fake?.options);
  assert.equal((await options(tab)).key, undefined);
  assert.equal((await options(tab)).name, 'Zoë');
});

test('a lost connection is told in words, with a countdown and a button', async (t) => {
  const page = await open(t);
  await tell(page, { connection: { state: 'lost', words: 'The server is away.', retry_ms: 9500 } });
  assert.match(await page.locator('#banner-words').textContent(),
    /^The server is away\. Next attempt in (10|9) s\.$/);
  assert.equal(await page.locator('#alert').textContent(), 'The server is away.');
  await tell(page, { status: { seq: 7, fps: 0, bytes: 0, chunks: 1, triangles: 2, unanswered: 3,
    caught_up: true } });
  assert.equal(await page.locator('#status-progress').textContent(), '3 edits wait for the server');
  await page.getByRole('button', { name: 'Retry now' }).click();
  assert.deepEqual(await commands(page), [{ do: 'retry' }]);
  await tell(page, { connection: { state: 'joined', words: '' } });
  assert.ok(await page.locator('#banner').isHidden());
  assert.ok(await page.locator('#status-progress').isHidden());
  await tell(page, { connection: { state: 'ended', words: 'The map was deleted.' } });
  await page.getByRole('button', { name: 'Choose a map' }).click();
  assert.ok(await page.locator('#maps-dialog').isVisible());
});

test('notices are written for some time and kept to be read', async (t) => {
  const page = await open(t);
  await tell(page, { notices: { notices: [
    { n: 1, kind: 'rejected', words: 'radius: too large here', x: 4, y: 5 },
    { n: 2, kind: 'said', words: 'Painting goes on.' }] } });
  assert.equal(await page.locator('#alert').textContent(), 'Refused: radius: too large here');
  assert.equal(await page.locator('#say').textContent(), 'Painting goes on.');
  assert.equal(await page.locator('.toast').count(), 2);
  await page.locator('.toast').first().getByRole('button', { name: 'Dismiss' }).click();
  await page.getByRole('button', { name: 'Messages' }).click();
  await page.getByRole('button', { name: /^Show where/ }).click();
  assert.deepEqual(await commands(page), [{ do: 'camera', x: 4, y: 5, zoom: 16, yaw: 0, tilt: 0 }]);
});

test('a screenshot and a glTF are saved under the map\'s name', async (t) => {
  const page = await open(t);
  const saved = page.waitForEvent('download');
  await page.getByRole('button', { name: 'Screenshot' }).click();
  const download = await saved;
  assert.equal(download.suggestedFilename(), 'demo.png');
  const png = await readFile(await download.path());
  assert.equal(png.subarray(1, 4).toString(), 'PNG');
  assert.equal(await page.evaluate(() => window.fake.draws), 1);
  assert.equal(await page.getByRole('link', { name: 'Export glTF' }).getAttribute('href'),
    '/api/maps/demo/export.glb');
});

test('labels lie at their places and catch no pointers', async (t) => {
  const page = await open(t);
  await page.evaluate(() => window.fake.label([
    { kind: 'person', text: 'Quiet Heron', color: '#ffee88', x: 640, y: 300 },
    { kind: 'notice', text: 'too large', color: '', x: 600, y: 500 }]));
  const box = await page.locator('.label.person').boundingBox();
  assert.deepEqual([Math.round(box.x), Math.round(box.y)], [650, 308]);
  assert.equal(await page.locator('.label.person').evaluate((label) => label.style.color), 'rgb(0, 0, 0)');
  assert.equal(await page.evaluate(() => document.elementFromPoint(655, 312).id), 'canvas');
  await page.evaluate(() => window.fake.label([]));
  assert.equal(await page.locator('.label').count(), 0);
});

test('on a narrow screen panels are sheets, and targets fit a finger', async (t) => {
  const page = await open(t, NARROW);
  await tell(page, { people: { people: [person('s1', 'Amber Fox', { me: true }),
    person('s2', 'Quiet Heron')] } });
  for (const sheet of ['Brush', 'Layers', 'People', 'Chat', 'More']) {
    const button = page.locator('#bar').getByRole('button', { name: sheet });
    await button.tap();
    assert.equal(await button.getAttribute('aria-expanded'), 'true');
    const small = await page.evaluate(() =>
      [...document.querySelectorAll('button, a, select, label:has(input), input:not(label *)')]
        .filter((element) => element.checkVisibility()).map((element) => {
          const { width, height } = element.getBoundingClientRect();
          return { what: element.id || element.textContent, width, height };
        }).filter(({ width, height }) => width > 1 && (height < 43.9 || width < 35)));
    assert.deepEqual(small, [], sheet);
    const open = await page.locator('.sheet:not(.shut)').count();
    assert.equal(open, 1);
  }
  await page.keyboard.press('Escape');
  assert.equal(await page.locator('.sheet:not(.shut)').count(), 0);
  assert.deepEqual(await page.evaluate(() => [document.documentElement.scrollWidth,
    document.documentElement.scrollHeight]), [390, 844]);
  await page.locator('#quick-fill').tap();
  await page.locator('#quick-tool').tap();
  assert.deepEqual(await commands(page), [{ do: 'brush', fill: false }, { do: 'tool', tool: 'move' }]);
});

test('without WebGL 2 or the viewer a sentence says so', async (t) => {
  const page = await browser.page();
  t.after(() => page.context().close());
  await page.addInitScript(() => { HTMLCanvasElement.prototype.getContext = () => null; });
  await page.goto(`${server.url}/?map=demo`);
  await page.getByText('offers no WebGL 2').waitFor();

  const other = await browser.page();
  t.after(() => other.context().close());
  await other.route('**/viewer.js', (route) => route.abort());
  await other.goto(`${server.url}/?map=demo`);
  await other.getByText('could not be loaded').waitFor();
});

test('axe finds nothing in any state, and the page complains about nothing', async (t) => {
  for (const look of [{}, { colorScheme: 'dark' }, NARROW]) {
    const page = await open(t, look);
    await tell(page, { chat: { lines: [said(1, 'hello'), said(2, 'you too', { mine: true })] },
      people: { people: [person('s1', 'Amber Fox', { me: true }),
        person('s2', 'Quiet Heron', { followed: true })] },
      connection: { state: 'lost', words: 'The server is away.', retry_ms: 60_000 },
      notices: { notices: [{ n: 1, kind: 'rejected', words: 'Too large.', x: 1, y: 1 }] } });
    assert.deepEqual(await violations(page), []);
    if (look === NARROW) {
      for (const sheet of ['brush', 'layers', 'people', 'chat', 'actions']) {
        await page.locator(`[data-sheet=${sheet}]`).tap();
        assert.deepEqual(await violations(page), [], sheet);
      }
    } else {
      await page.getByRole('button', { name: 'Name and heights of ground' }).click();
      assert.deepEqual(await violations(page), []);
      await page.getByRole('button', { name: 'Keys and gestures' }).click();
      assert.deepEqual(await violations(page), []);
      await page.keyboard.press('Escape');
    }
    await page.getByRole('button', { name: /^Map:/ }).click();
    await page.getByText('New map').click();
    await page.getByRole('button', { name: 'Delete other' }).click();
    assert.deepEqual(await violations(page), []);
    assert.deepEqual(page.complaints, []);
  }
});

test('scripts and styles stand in files of their own', async () => {
  const html = await readFile(fileURLToPath(
    new URL('../../client/viewer/web/page/index.html', import.meta.url)), 'utf8');
  assert.doesNotMatch(html, /<style|\sstyle=|<script>|\son[a-z]+=/);
});
