// What people say to each other. New lines are counted while nobody can see them.
import { byId, make, setText, showError } from './dom.mjs';
import { characters, clock } from './words.mjs';

const MOST_CHARACTERS = 500;
const TELL_FROM = 400;
const KEPT_LINES = 100;

// `isOpen()` tells whether the lines can be seen; the result is to be called when they come to be.
export function chatPanel(viewer, isOpen) {
  const [list, text] = [byId('chat-lines'), byId('chat-text')];
  const error = byId('chat-error');
  const lines = chatLines(list);
  let unread = 0;

  function count(fresh) {
    unread = isOpen() ? 0 : unread + fresh;
    for (const badge of [byId('chat-unread'), byId('bar-unread')]) {
      badge.hidden = unread === 0;
      badge.replaceChildren(String(unread), make('span', { className: 'unseen' }, ' unread'));
    }
  }
  viewer.on('chat', (part) => count(lines.show(part.lines)));

  text.addEventListener('input', () => {
    const length = characters(text.value);
    const counter = byId('chat-counter');
    counter.hidden = length < TELL_FROM;
    counter.classList.toggle('over', length > MOST_CHARACTERS);
    setText(counter, `${length} of ${MOST_CHARACTERS} characters`);
    showError(error, null);
  });
  byId('chat-form').addEventListener('submit', (event) => {
    event.preventDefault();
    const words = text.value.trim();
    if (!words) return;
    const no = viewer.command({ do: 'chat', text: words });
    showError(error, no?.message, text);
    if (no) return;
    text.value = '';
    byId('chat-counter').hidden = true;
  });

  return function seen() {
    count(0);
    lines.toEnd();
  };
}

// Lines are added to those that are there, so that only new ones are read aloud.
function chatLines(list) {
  let last = null;
  const toEnd = () => { list.scrollTop = list.scrollHeight; };

  return {
    toEnd,
    // Returns how many new lines others have said since the last time.
    show(lines) {
      const again = last === null || (lines.at(-1)?.n ?? 0) < last;
      // What was said before one came is there to be read, but not announced.
      list.setAttribute('aria-live', again ? 'off' : 'polite');
      if (again) list.replaceChildren();
      const fresh = again ? lines : lines.filter((line) => line.n > last);
      const atEnd = again || list.scrollHeight - list.scrollTop - list.clientHeight < 40;
      list.append(...fresh.map(chatLine));
      while (list.children.length > KEPT_LINES) list.firstChild.remove();
      if (atEnd || fresh.some((line) => line.mine)) toEnd();
      last = lines.at(-1)?.n ?? 0;
      return again ? 0 : fresh.filter((line) => !line.mine).length;
    },
  };
}

function chatLine({ time, name, color, text, mine }) {
  const dot = make('span', { className: 'person-dot' });
  dot.style.background = color;
  return make('div', { className: mine ? 'mine' : '' },
    make('div', { className: 'who' }, dot, make('b', {}, name),
      ...(mine ? [make('span', { className: 'you' }, 'you')] : []),
      make('time', { dateTime: new Date(time).toISOString() }, clock(time))),
    make('p', {}, text));
}
