// Panels that fold where there is room, and are sheets above the bar where there is not.
import { byId } from './dom.mjs';
import { remember, remembered } from './identity.mjs';

const FOLDED = 'earthwork.folded';
const NARROW = '(max-width: 640px), (max-height: 480px) and (pointer: coarse)';

// `onSeen(id)` is called when a panel's inside comes to be seen. Returns isOpen(id).
export function foldingPanels(onSeen) {
  const narrow = matchMedia(NARROW);
  const folded = new Set((remembered('localStorage', FOLDED) ?? '').split(' ').filter(Boolean));
  const buttons = [...document.querySelectorAll('#bar [data-sheet]')];
  let sheet = null;

  const isOpen = (id) => (narrow.matches ? sheet === id : !folded.has(id));

  function show() {
    for (const fold of document.querySelectorAll('.fold')) {
      const panel = fold.closest('.panel');
      const open = narrow.matches || !folded.has(panel.id);
      fold.setAttribute('aria-expanded', String(open));
      byId(`${panel.id}-body`).hidden = !open;
    }
    for (const panel of document.querySelectorAll('.sheet'))
      panel.classList.toggle('shut', narrow.matches && sheet !== panel.id);
    for (const button of buttons)
      button.setAttribute('aria-expanded', String(sheet === button.dataset.sheet));
  }

  function openSheet(id) {
    sheet = id;
    show();
    if (id) onSeen(id);
  }

  for (const fold of document.querySelectorAll('.fold')) {
    const { id } = fold.closest('.panel');
    fold.addEventListener('click', () => {
      if (narrow.matches) {
        openSheet(null);
        buttons.find((button) => button.dataset.sheet === id).focus();
        return;
      }
      if (!folded.delete(id)) folded.add(id);
      remember('localStorage', FOLDED, [...folded].join(' '));
      show();
      if (isOpen(id)) onSeen(id);
    });
  }
  for (const button of buttons) {
    const id = button.dataset.sheet;
    button.setAttribute('aria-controls', id);
    button.addEventListener('click', () => openSheet(sheet === id ? null : id));
  }
  addEventListener('keydown', (event) => {
    if (event.key !== 'Escape' || !sheet || document.querySelector('dialog[open]')) return;
    // To the viewer it would mean something else.
    event.stopImmediatePropagation();
    buttons.find((button) => button.dataset.sheet === sheet).focus();
    openSheet(null);
  });
  narrow.addEventListener('change', () => openSheet(null));
  show();
  return isOpen;
}
