// The page: starts the viewer at the place that the link names, and gives each panel its part.
import { actionButtons } from './actions.mjs';
import { mapNames } from './api.mjs';
import { CannotStart, Viewer } from './bridge.mjs';
import { brushPanel } from './brush.mjs';
import { chatPanel } from './chat.mjs';
import { connectionPanel } from './connection.mjs';
import { byId, setText } from './dom.mjs';
import { helpDialog } from './help.mjs';
import { lastId, person, seed, takeKey } from './identity.mjs';
import { labelsOverlay } from './labels.mjs';
import { layersPanel } from './layers.mjs';
import { asksForNoName, hashOf, mapOf, placeOf, queryOf } from './link.mjs';
import { toast } from './live.mjs';
import { keysToTheMap } from './map_keys.mjs';
import { mapsDialog } from './maps.mjs';
import { noticesPanel } from './notices.mjs';
import { foldingPanels } from './panels.mjs';
import { peoplePanel } from './people.mjs';
import { personDialog } from './person.mjs';
import { statusLine } from './status.mjs';

const FIRST_CHOICE = 'demo';

const viewer = new Viewer();
const who = person();
const key = takeKey(() => viewer.part('connection')?.key);
let map;
let waitingPlace = null;  // to go to once the map is there

function showPanels() {
  const seen = {};
  const isOpen = foldingPanels((id) => seen[id]?.());
  const openMaps = mapsDialog(() => map, openMap);
  actionButtons(viewer);
  brushPanel(viewer);
  seen.chat = chatPanel(viewer, () => isOpen('chat'));
  connectionPanel(viewer, openMaps);
  helpDialog(viewer);
  labelsOverlay(viewer);
  layersPanel(viewer);
  noticesPanel(viewer);
  peoplePanel(viewer, personDialog(viewer, who));
  statusLine(viewer);
  keysToTheMap();
  return openMaps;
}

function fail(words) {
  const fatal = byId('fatal');
  fatal.hidden = false;
  byId('progress').hidden = true;
  setText(fatal, words);
  setText(byId('status-connection'), 'No picture');
}

function useMap(name) {
  map = name;
  document.title = `${name} · Earthwork`;
  setText(byId('map-name'), name);
  byId('canvas').setAttribute('aria-label', `Map ${name}`);
}

async function start(name, place) {
  useMap(name);
  byId('progress').hidden = false;
  try {
    await viewer.start(
      { map: name, ...who, key, last_id: lastId(), seed: seed(), place: place ?? undefined });
  } catch (error) {
    if (!(error instanceof CannotStart)) throw error;
    fail(error.message);
  }
}

// Goes to another map, as a link does.
function openMap(name) {
  if (name === map && viewer.part('connection')?.state !== 'ended') return;
  history.pushState(null, '', queryOf(name));
  join(name);
}

function join(name, place = null) {
  if (!viewer.started) {
    start(name, place);
    return;
  }
  useMap(name);
  waitingPlace = place;
  viewer.command({ do: 'join', map: name });
}

function go(place) {
  if (place) viewer.command({ do: 'camera', ...place });
}

// The link in the address bar is always one to what is seen.
function keepLink() {
  viewer.on('camera', (place) => {
    if (viewer.part('map')?.name !== map) return;
    const link = queryOf(map) + hashOf(place);
    if (location.search + location.hash !== link) history.replaceState(null, '', link);
  });
  addEventListener('popstate', () => {
    const name = mapOf(location.search);
    if (name && name !== map) join(name, placeOf(location.hash));
    else go(placeOf(location.hash));
  });
  viewer.on('map', (part) => {
    if (part.name !== map || !waitingPlace) return;
    const place = waitingPlace;
    waitingPlace = null;
    // Not from inside of what tells of the map.
    queueMicrotask(() => go(place));
  });
}

async function firstMap() {
  const names = await mapNames().catch(() => []);
  return names.includes(FIRST_CHOICE) ? FIRST_CHOICE : names[0];
}

// For the console, and for who measures.
window.earthwork = { figures: () => viewer.figures() };

const openMaps = showPanels();
viewer.onStop(() => fail('The viewer met an error and has stopped. What was acknowledged is safe; '
  + 'reload the page to go on.'));
keepLink();
const name = mapOf(location.search) ?? await firstMap();
if (name) {
  // Nobody shall paint on one map and believe it is another.
  if (asksForNoName(location.search))
    toast(`No map can have the name in the link: this is ${name}.`, 'lost');
  await start(name, placeOf(location.hash));
} else {
  byId('progress').hidden = true;
  await openMaps();
}
