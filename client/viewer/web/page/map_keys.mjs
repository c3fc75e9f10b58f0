// After a click the keys are the map's again. A radio or a button that kept the focus would take
// the arrows, Space and Enter for itself: who clicked Square and then moves the view by an arrow
// would paint circles. Who goes by keys keeps the focus where it is.
import { byId } from './dom.mjs';

const TAKES_KEYS = '#brush input[type=radio], #layers input[type=radio], #layers button, '
  + '#actions button, .fold';

export function keysToTheMap() {
  addEventListener('click', ({ pointerType, target }) => {
    if (pointerType !== 'mouse' && pointerType !== 'pen') return;
    const choice = target.closest('label, button');
    if (!choice) return;
    // Once the click has done all it does.
    setTimeout(() => {
      const focused = document.activeElement;
      if (focused.matches(TAKES_KEYS) && choice.contains(focused)) byId('canvas').focus();
    });
  });
}
