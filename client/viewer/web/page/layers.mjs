// The map's layers: which one is painted on, which are shown, and what they are called, coloured
// and how high they stand.
import { byId, icon, iconButton, make, nameButton, setIcon, setText, setValue, showError }
  from './dom.mjs';
import { newLayer } from './new_layer.mjs';

export function layersPanel(viewer) {
  const list = byId('layer-list');
  const error = byId('layers-error');
  const [add, unseen] = [byId('layer-add'), byId('layers-unseen')];
  const rows = [];

  add.addEventListener('click', () => {
    const layers = viewer.part('map')?.settings.layers ?? [];
    showError(error, viewer.command({ do: 'layer', ...newLayer(layers) })?.message);
  });

  function show() {
    const [map, brush] = [viewer.part('map'), viewer.part('brush')];
    if (!map) return;
    const { layers } = map.settings;
    while (rows.length > layers.length) rows.pop().element.remove();
    while (rows.length < layers.length) {
      rows.push(layerRow(viewer, rows.length));
      list.append(rows.at(-1).element);
    }
    rows.forEach((row, index) =>
      row.show(layers[index], !map.hidden.includes(index), brush?.layer === index));
    setText(unseen, map.hidden.includes(brush?.layer)
      ? `${layers[brush.layer]?.name} is painted on, and hidden.` : '');
  }
  viewer.on('map', show);
  viewer.on('brush', show);
}

function layerRow(viewer, index) {
  const error = make('p', { className: 'error', id: `layer-error-${index}`, role: 'alert' });
  const ask = (change, input) =>
    showError(error, viewer.command({ do: 'layer', layer: index, ...change })?.message, input);

  const chosen = make('input', { type: 'radio', name: 'layer', value: String(index) });
  const name = make('span', { className: 'layer-name' });
  const color = make('input', { type: 'color' });
  let visible = true;
  const eye = iconButton('eye', '', () =>
    showError(error, viewer.command({ do: 'show', layer: index, visible: !visible })?.message));
  const fields = layerFields(ask);
  fields.element.id = `layer-fields-${index}`;
  fields.element.hidden = true;
  const edit = iconButton('edit', '', () => {
    fields.element.hidden = !fields.element.hidden;
    edit.setAttribute('aria-expanded', String(!fields.element.hidden));
    if (!fields.element.hidden) fields.name.select();
  });
  edit.setAttribute('aria-expanded', 'false');
  edit.setAttribute('aria-controls', fields.element.id);
  chosen.addEventListener('change', () => viewer.command({ do: 'brush', layer: index }));
  color.addEventListener('change', () => ask({ color: color.value }, color));

  const element = make('li', {},
    make('div', { className: 'layer' }, color,
      make('label', { title: 'Paint on this layer' }, chosen, name, icon('brush', true)), eye, edit),
    fields.element, error);

  return {
    element,
    show(layer, shown, painted) {
      visible = shown;
      chosen.checked = painted;
      setText(name, layer.name);
      color.value = layer.color;
      color.setAttribute('aria-label', `Colour of ${layer.name}`);
      setIcon(eye, shown ? 'eye' : 'eye-off');
      nameButton(eye, `${shown ? 'Hide' : 'Show'} ${layer.name}`);
      nameButton(edit, `Name and heights of ${layer.name}`);
      element.classList.toggle('hidden-layer', !shown);
      fields.show(layer);
    },
  };
}

// Name and heights of one layer; each is asked for when its field is left or Enter is pressed.
function layerFields(ask) {
  const name = make('input', { autocomplete: 'off' });
  const number = () => make('input', { type: 'number', step: 'any', inputMode: 'decimal' });
  const [bottom, top] = [number(), number()];
  name.addEventListener('change', () => ask({ name: name.value }, name));
  for (const input of [bottom, top]) {
    input.addEventListener('change', () => {
      if (bottom.value !== '' && top.value !== '')
        ask({ wall: [Number(bottom.value), Number(top.value)] }, input);
    });
  }
  const line = (label, input) => make('label', { className: 'line' }, make('span', {}, label), input);
  const element = make('div', { className: 'layer-fields' },
    line('Name', name), line('Surface at', top), line('Wall down to', bottom));
  return {
    element,
    name,
    show(layer) {
      setValue(name, layer.name);
      setValue(bottom, String(layer.wall[0]));
      setValue(top, String(layer.wall[1]));
    },
  };
}
