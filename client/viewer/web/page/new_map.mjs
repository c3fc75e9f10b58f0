// The form of a new map: its name and the settings it keeps for ever.
import { createMap } from './api.mjs';
import { byId, iconButton, make, setText, showError } from './dom.mjs';
import { isMapName } from './link.mjs';
import { newLayer } from './new_layer.mjs';
import { whole } from './words.mjs';

const MOST_LAYERS = 16;

// `made(name)` is called with the map that was created.
export function newMapForm(made) {
  const form = byId('new-map-form');
  const fields = form.elements;
  const error = byId('new-map-error');
  const list = byId('new-map-layers');

  function addLayer() {
    const row = layerRow(list.children.length + 1, newLayer(layersOf(list)));
    list.append(row);
    count();
    return row;
  }
  function count() {
    byId('new-map-layer').hidden = list.children.length >= MOST_LAYERS;
    for (const button of list.querySelectorAll('button')) button.hidden = list.children.length === 1;
  }
  byId('new-map-layer').addEventListener('click', () => addLayer().querySelector('input').focus());
  list.addEventListener('click', (event) => {
    const button = event.target.closest('button');
    if (!button) return;
    button.closest('li').remove();
    count();
    byId('new-map-layer').focus();
  });
  addLayer();

  function describeSize() {
    const bounded = fields.bounds.value === 'chunks';
    byId('new-map-size').hidden = !bounded;
    const side = Number(fields.resolution.value);
    const across = whole(fields.columns.value * side);
    setText(byId('new-map-voxels'), bounded
      ? `${across} × ${whole(fields.rows.value * side)} voxels`
      : 'It ends 1,000,576 voxels from the middle.');
  }
  form.addEventListener('input', describeSize);
  describeSize();

  form.addEventListener('submit', async (event) => {
    event.preventDefault();
    const name = fields.name.value.trim();
    const submit = form.querySelector('[type=submit]');
    showError(error, null);
    if (!isMapName(name)) {
      showError(error, 'A name has 1 to 64 small letters, digits, - and _.', fields.name);
      fields.name.focus();
      return;
    }
    submit.disabled = true;
    try {
      await createMap(name, settingsOf(fields, list));
      form.reset();
      // A reset would leave them empty: they are no part of the document as it came.
      list.replaceChildren();
      addLayer();
      describeSize();
      byId('new-map').open = false;
      made(name);
    } catch (problem) {
      showError(error, problem.message, fieldOf(fields, problem.field));
    } finally {
      submit.disabled = false;
    }
  });
}

// The field that a problem means: layers are told by their place, as in layers[1].wall.
function fieldOf(fields, field = '') {
  const last = field.split('.').at(-1);
  const names = { name: 'name', chunks: 'columns', voxel_size: 'voxel_size' };
  return names[last] ? fields[names[last]] : null;
}

function layerRow(n, { color, wall: [bottom, top] }) {
  const number = (name, value, label) =>
    make('input', { type: 'number', step: 'any', name, value, 'aria-label': label, title: label });
  return make('li', {},
    make('input', { type: 'color', name: 'layer_color', value: color,
      'aria-label': `Colour of layer ${n}` }),
    make('input', { name: 'layer_name', value: n === 1 ? 'ground' : `layer ${n}`,
      autocomplete: 'off', 'aria-label': `Name of layer ${n}` }),
    number('layer_bottom', String(bottom), `Layer ${n}: wall down to`),
    number('layer_top', String(top), `Layer ${n}: surface at`),
    iconButton('close', `Remove layer ${n}`, () => {}));
}

const layersOf = (list) => [...list.children].map((row) => {
  const value = (name) => row.querySelector(`[name=${name}]`).value;
  return { name: value('layer_name'), color: value('layer_color'),
    wall: [Number(value('layer_bottom')), Number(value('layer_top'))] };
});

// Around the middle, so that 0, 0 is where one looks first.
function settingsOf(fields, list) {
  const [columns, rows] = [Number(fields.columns.value), Number(fields.rows.value)];
  const [left, bottom] = [-Math.floor(columns / 2), -Math.floor(rows / 2)];
  const settings = {
    chunk_resolution: Number(fields.resolution.value),
    voxel_size: Number(fields.voxel_size.value),
    layers: layersOf(list),
  };
  if (fields.bounds.value === 'chunks')
    settings.chunks = [left, bottom, left + columns, bottom + rows];
  return settings;
}
