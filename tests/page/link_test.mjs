// Links and figures in words, without a browser.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { asksForNoName, hashOf, isMapName, mapOf, placeOf, queryOf }
  from '../../client/viewer/web/page/link.mjs';
import { bytes, characters, inkOn, milliseconds, whole }
  from '../../client/viewer/web/page/words.mjs';

test('a place is three numbers or five', () => {
  assert.deepEqual(placeOf('#1,-2.5,16'), { x: 1, y: -2.5, zoom: 16 });
  assert.deepEqual(placeOf('#1,2,3,-0.5,1.25'), { x: 1, y: 2, zoom: 3, yaw: -0.5, tilt: 1.25 });
  assert.deepEqual(placeOf('#1%2C2%2C3'), { x: 1, y: 2, zoom: 3 });
  for (const none of ['', '#', '#1,2', '#1,2,3,4', '#1,2,3,4,5,6', '#a,b,c', '#1,,3', '#1,2,0',
    '#1,2,-4', '#1,2,Infinity', '#%zz'])
    assert.equal(placeOf(none), null, none);
});

test('a place is written as fine as it can be seen', () => {
  assert.equal(hashOf({ x: 1.23456, y: -7.00001, zoom: 16 }), '#1.235,-7,16');
  assert.equal(hashOf({ x: 1234.56, y: 0, zoom: 0.01 }), '#1235,0,0.01');
  assert.equal(hashOf({ x: 0, y: 0, zoom: 16, yaw: 0.0001, tilt: 0 }), '#0,0,16');
  assert.equal(hashOf({ x: 0, y: 0, zoom: 16, yaw: 1, tilt: 0.5 }), '#0,0,16,1,0.5');
});

test('what is written is read again', () => {
  for (const place of [{ x: -3.25, y: 8, zoom: 12.5 }, { x: 1e5, y: 2, zoom: 3, yaw: -3, tilt: 1.3 }])
    assert.deepEqual(placeOf(hashOf(place)), place);
});

test('a query names a map, or what can be none', () => {
  assert.equal(mapOf('?map=world-land_2'), 'world-land_2');
  assert.equal(mapOf(queryOf('demo')), 'demo');
  for (const none of ['', '?map=', '?map=Caps', '?map=a/b', `?map=${'x'.repeat(65)}`, '?other=a'])
    assert.equal(mapOf(none), null, none);
  assert.ok(isMapName('x'.repeat(64)));
  assert.ok(asksForNoName('?map=Caps'));
  for (const fine of ['', '?map=', '?map=demo', '?other=a']) assert.ok(!asksForNoName(fine), fine);
});

test('figures are short', () => {
  assert.deepEqual([0, 999, 1000, 12_345, 999_600, 1_234_567, 45e9].map(bytes),
    ['0 B', '999 B', '1.0 kB', '12 kB', '1.0 MB', '1.2 MB', '45 GB']);
  assert.deepEqual([0, 999, 1000, 1_234_567].map(whole), ['0', '999', '1,000', '1,234,567']);
  assert.deepEqual([0.25, 9.94, 9.96, 120.4].map(milliseconds),
    ['0.3 ms', '9.9 ms', '10 ms', '120 ms']);
  assert.equal(characters('aé🦊'), 3);
});

test('ink is what reads better on a colour', () => {
  assert.equal(inkOn('#ffffff'), '#000000');
  assert.equal(inkOn('#ffd400'), '#000000');
  assert.equal(inkOn('#20308a'), '#ffffff');
  assert.equal(inkOn('#000000'), '#ffffff');
});
