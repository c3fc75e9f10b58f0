// Who one is: a name and a colour, remembered by the browser, and a key, remembered by the tab.
//
// The key proves to the server that a reload is the same author. It lies in the tab's storage only
// while the page is away: a tab that is duplicated copies that storage, and two tabs with one key
// would throw each other out.

const PERSON = 'earthwork.person';
const KEY = 'earthwork.key';

const FIRST = ['Amber', 'Brisk', 'Calm', 'Dusty', 'Early', 'Fern', 'Golden', 'Hazel', 'Jolly',
  'Lucky', 'Misty', 'Noble', 'Olive', 'Quiet', 'Rusty', 'Sandy', 'Silver', 'Swift', 'Velvet', 'Wild'];
const SECOND = ['Badger', 'Beaver', 'Crane', 'Dormouse', 'Ferret', 'Finch', 'Fox', 'Hare', 'Heron',
  'Ibex', 'Lark', 'Lynx', 'Marmot', 'Mole', 'Otter', 'Owl', 'Robin', 'Stoat', 'Swan', 'Wren'];

// Told apart from each other, and on light and dark ground.
export const PALETTE = ['#d1495b', '#e07a3f', '#d9a404', '#7fa23a', '#2f8f5b', '#1f9aa0',
  '#2f7fd1', '#5b63d3', '#9a52c7', '#c94f9b', '#8c6d52', '#6b7785'];

const pick = (list) => list[crypto.getRandomValues(new Uint32Array(1))[0] % list.length];

// Storage may be forbidden: then nothing is remembered.
export function remember(storage, name, value) {
  try {
    if (value === null) window[storage].removeItem(name);
    else window[storage].setItem(name, value);
  } catch { /* as said above */ }
}

export function remembered(storage, name) {
  try {
    return window[storage].getItem(name);
  } catch {
    return null;
  }
}

const isColor = (text) => /^#[0-9a-f]{6}$/i.test(text);

// {name, color}: as they were chosen, or friendly ones.
export function person() {
  let known = null;
  try {
    known = JSON.parse(remembered('localStorage', PERSON));
  } catch { /* written by nobody we know */ }
  if (typeof known?.name === 'string' && known.name && isColor(known.color)) return known;
  const made = { name: `${pick(FIRST)} ${pick(SECOND)}`, color: pick(PALETTE) };
  rememberPerson(made);
  return made;
}

export function rememberPerson({ name, color }) {
  remember('localStorage', PERSON, JSON.stringify({ name, color }));
}

// The key of this tab's earlier page, or undefined. From now on `keyNow` tells what to keep for
// the page that follows.
export function takeKey(keyNow) {
  const take = () => {
    const key = remembered('sessionStorage', KEY);
    remember('sessionStorage', KEY, null);
    return key ?? undefined;
  };
  addEventListener('pagehide', () => {
    const key = keyNow();
    if (key) remember('sessionStorage', KEY, key);
  });
  addEventListener('pageshow', (event) => { if (event.persisted) take(); });
  return take();
}

// No page ever used so large an id with this key before: the clock goes forward.
export const lastId = () => Date.now() * 1000;

export const seed = () => crypto.getRandomValues(new Uint32Array(1))[0];
