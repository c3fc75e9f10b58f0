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
  viewer.on('chat', (part) => count(lines.show(part)));

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
  let [shown, wasKnown] = [[], false];
  const toEnd = () => { list.scrollTop = list.scrollHeight; };

  return {
    toEnd,
    // Returns how many new lines others have said since the last time.
    show({ lines, known = true }) {
      // A server that was started anew counts from 1 again, so a number alone says nothing.
      const last = shown.at(-1);
      const at = last ? lines.findIndex(({ n, time }) => n === last.n && time === last.time) : -1;
      // What was said before one came is there to be read, but not announced.
      const again = !wasKnown || (last && at < 0);
      list.setAttribute('aria-live', again ? 'off' : 'polite');
      if (again) list.replaceChildren();
      const fresh = again ? lines : lines.slice(at + 1);
      const atEnd = again || list.scrollHeight - list.scrollTop - list.clientHeight < 40;
      list.append(...fresh.map(chatLine));
      while (list.children.length > KEPT_LINES) list.firstChild.remove();
      if (atEnd || fresh.some((line) => line.mine)) toEnd();
      [shown, wasKnown] = [lines, known];
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
