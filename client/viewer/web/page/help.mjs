// All keys and gestures. What keys do is the viewer's to tell; `?` alone is the page's.
import { byId, dialog, make } from './dom.mjs';

const GESTURES = [
  ['With a mouse or pen', [
    ['Drag', 'Paint or move, as chosen'],
    [['Middle drag', 'Shift + drag', 'Space + drag'], 'Move'],
    [['Right drag', 'Alt + drag'], 'Turn and tilt'],
    ['Wheel', 'Zoom to the pointer'],
    ['Shift + wheel', 'Radius of the brush'],
  ]],
  ['With fingers', [
    ['One', 'Paint or move, as chosen'],
    ['Two', 'Move, zoom and turn'],
  ]],
];
const PAGE = ['Page', [['?', 'This list'], ['Esc', 'Close what is open']]];
const NAMES = { ArrowLeft: '←', ArrowRight: '→', ArrowUp: '↑', ArrowDown: '↓', Escape: 'Esc',
  PageUp: 'Page up', PageDown: 'Page down', ' ': 'Space', '-': '−' };

export function helpDialog(viewer) {
  const open = dialog(byId('help-dialog'));
  viewer.on('shortcuts', ({ shortcuts }) => {
    const keys = shortcuts.map(({ keys, does }) => [keys.map(nameOf), does]);
    byId('help-body').replaceChildren(...[['Keys', keys], ...GESTURES, PAGE].map(group));
  });
  byId('help-button').addEventListener('click', open);
  addEventListener('keydown', (event) => {
    if (event.key !== '?' || event.ctrlKey || event.metaKey || isText(event.target)) return;
    if (document.querySelector('dialog[open]')) return;
    event.preventDefault();
    open();
  });
}

const nameOf = (key) => NAMES[key] ?? (key.length === 1 ? key.toUpperCase() : key);

const isText = (element) =>
  element.matches?.('textarea, select, input:not([type=radio], [type=range], [type=color])');

function group([title, rows]) {
  const list = rows.map(([keys, does]) => make('div', {},
    make('dt', {}, ...[keys].flat().map((key) => make('kbd', {}, key))), make('dd', {}, does)));
  return make('section', {}, make('h3', {}, title), make('dl', {}, ...list));
}
