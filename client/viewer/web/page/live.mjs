// What is said aloud by screen readers, and shortly written on the screen for everybody else.
import { byId, make, iconButton } from './dom.mjs';

const TOAST_MS = 8000;
const MOST_TOASTS = 3;

// Heard when nothing else is being said; `urgently`: at once.
export function say(words, urgently = false) {
  const place = byId(urgently ? 'alert' : 'say');
  // The same words twice are said twice.
  place.textContent = place.textContent === words ? `${words}\u00a0` : words;
}

// Written for some seconds, longer while the pointer or the focus is on it.
export function toast(words, kind = 'said') {
  const list = byId('toasts');
  // Said again, it is not written twice.
  for (const other of list.querySelectorAll('p')) {
    if (other.textContent === words) other.parentElement.remove();
  }
  const item = make('div', { className: `toast ${kind}` }, make('p', {}, words));
  let timer;
  const stay = () => clearTimeout(timer);
  const go = () => {
    stay();
    timer = setTimeout(() => item.remove(), TOAST_MS);
  };
  item.append(iconButton('close', 'Dismiss', () => item.remove()));
  item.addEventListener('pointerenter', stay);
  item.addEventListener('pointerleave', go);
  item.addEventListener('focusin', stay);
  item.addEventListener('focusout', go);
  list.append(item);
  while (list.children.length > MOST_TOASTS) list.firstChild.remove();
  go();
  say(words, kind !== 'said');
}
