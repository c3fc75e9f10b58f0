// The dialog about oneself: name and colour.
import { byId, dialog, make, showError } from './dom.mjs';
import { PALETTE, rememberPerson } from './identity.mjs';

// `who` is {name, color} as of now, and kept up to date. Returns the function that opens it.
export function personDialog(viewer, who) {
  const [name, color, error] = [byId('person-name'), byId('person-color'), byId('person-error')];
  const open = dialog(byId('person-dialog'));
  const swatches = PALETTE.map((value, index) => {
    const input = make('input', { type: 'radio', name: 'swatch', value });
    input.setAttribute('aria-label', `Colour ${index + 1}, ${value}`);
    input.addEventListener('change', () => { color.value = value; });
    const dot = make('span', {});
    dot.style.background = value;
    byId('person-palette').append(make('label', {}, input, dot));
    return input;
  });
  const mark = () => {
    for (const swatch of swatches) swatch.checked = swatch.value === color.value;
  };
  color.addEventListener('input', mark);

  byId('person-form').addEventListener('submit', (event) => {
    event.preventDefault();
    const chosen = { name: name.value.trim(), color: color.value };
    const no = chosen.name === '' ? { message: 'A name has at least one character.' }
      : viewer.started ? viewer.command({ do: 'person', ...chosen }) : null;
    showError(error, no?.message, name);
    if (no) return;
    Object.assign(who, chosen);
    rememberPerson(chosen);
    byId('person-dialog').close();
  });

  return () => {
    name.value = who.name;
    color.value = who.color;
    mark();
    showError(error, null);
    open();
    name.select();
  };
}
