// The dialog with all maps of the server: open one, make one, delete one after a second thought.
import { deleteMap, mapNames } from './api.mjs';
import { byId, dialog, iconButton, make, setText, showError } from './dom.mjs';
import { say } from './live.mjs';
import { queryOf } from './link.mjs';
import { newMapForm } from './new_map.mjs';

// `current()` is the map in use, or undefined; `openMap(name)` goes to another. Returns the
// function that opens the dialog.
export function mapsDialog(current, openMap) {
  const element = byId('maps-dialog');
  const [list, error] = [byId('maps-list'), byId('maps-error')];
  const show = dialog(element);

  function choose(name) {
    element.close();
    openMap(name);
  }
  newMapForm(choose);

  async function refresh() {
    try {
      const names = await mapNames();
      list.replaceChildren(...names.map((name) =>
        mapRow(name, { inUse: name === current(), choose, refresh })));
      byId('new-map').open ||= names.length === 0;
      showError(error, names.length === 0 ? 'There is no map yet: make the first.' : null);
    } catch (problem) {
      list.replaceChildren();
      showError(error, problem.message);
    }
  }
  byId('map-button').addEventListener('click', open);

  function open() {
    show();
    return refresh();
  }
  return open;
}

function mapRow(name, { inUse, choose, refresh }) {
  const link = make('a', { href: queryOf(name) }, make('span', {}, name),
    ...(inUse ? [make('span', { className: 'you' }, 'open')] : []));
  if (inUse) link.setAttribute('aria-current', 'page');
  link.addEventListener('click', (event) => {
    if (event.ctrlKey || event.metaKey || event.shiftKey) return;
    event.preventDefault();
    choose(name);
  });
  const row = make('li', {});
  const remove = iconButton('trash', `Delete ${name}`, () => {
    row.append(...(row.querySelector('form') ? [] : [secondThought(name, remove, refresh)]));
    row.querySelector('input').focus();
  });
  row.append(make('div', { className: 'map-row' }, link, remove));
  return row;
}

// A map is gone for everybody, so its name is to be written once more.
function secondThought(name, remove, refresh) {
  const error = make('p', { className: 'error', id: `delete-error-${name}`, role: 'alert' });
  const typed = make('input', { autocomplete: 'off', spellcheck: false, autocapitalize: 'none' });
  const yes = make('button', { type: 'submit', className: 'danger', disabled: true });
  setText(yes, `Delete ${name} for everybody`);
  const no = make('button', { type: 'button' }, 'Keep it');
  const form = make('form', { className: 'second-thought', noValidate: true },
    make('label', {}, `There is no way back. To delete the map, type its name: ${name}`, typed),
    error, make('div', { className: 'buttons' }, no, yes));

  const away = () => {
    form.remove();
    remove.focus();
  };
  typed.addEventListener('input', () => { yes.disabled = typed.value !== name; });
  no.addEventListener('click', away);
  form.addEventListener('keydown', (event) => {
    if (event.key !== 'Escape') return;
    event.preventDefault();
    away();
  });
  form.addEventListener('submit', async (event) => {
    event.preventDefault();
    if (typed.value !== name) return;
    yes.disabled = true;
    try {
      await deleteMap(name);
      say(`The map ${name} is deleted.`);
      await refresh();
      byId('maps-title').closest('header').querySelector('button').focus();
    } catch (problem) {
      yes.disabled = false;
      showError(error, problem.message, typed);
    }
  });
  return form;
}
