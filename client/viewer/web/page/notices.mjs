// What went wrong or happened: said once, and kept to be read later.
import { byId, dialog, make, setText } from './dom.mjs';
import { toast } from './live.mjs';
import { clock } from './words.mjs';

const KEPT = 100;
const TITLES = { rejected: 'Refused', lost: 'Lost', said: '' };

export function noticesPanel(viewer) {
  const list = byId('notices-list');
  const button = byId('notices-button');
  const open = dialog(byId('notices-dialog'));
  let last = 0;

  button.addEventListener('click', () => {
    button.classList.remove('fresh');
    open();
  });
  viewer.on('notices', ({ notices }) => {
    for (const notice of notices) {
      if (notice.n <= last) continue;
      last = notice.n;
      const words = TITLES[notice.kind] ? `${TITLES[notice.kind]}: ${notice.words}` : notice.words;
      toast(words, notice.kind);
      list.prepend(line(viewer, notice, words));
      while (list.children.length > KEPT) list.lastChild.remove();
      button.classList.toggle('fresh', notice.kind !== 'said' || button.classList.contains('fresh'));
    }
    byId('notices-none').hidden = list.children.length > 0;
  });
}

// With a button that goes to the place, where there is one.
function line(viewer, { kind, x, y }, words) {
  const now = Date.now();
  const item = make('li', { className: kind },
    make('time', { dateTime: new Date(now).toISOString() }, clock(now)), make('p', {}, words));
  if (x === undefined) return item;
  const go = make('button', { type: 'button', className: 'quiet' });
  setText(go, 'Show');
  go.setAttribute('aria-label', `Show where: ${words}`);
  go.addEventListener('click', () => {
    const { zoom, yaw, tilt } = viewer.part('camera');
    viewer.command({ do: 'camera', x, y, zoom, yaw, tilt });
    byId('notices-dialog').close();
  });
  item.append(go);
  return item;
}
