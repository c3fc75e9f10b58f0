// Whether there is a server, in words, and what one can do about it. Looking around goes on.
import { byId, setText } from './dom.mjs';
import { say } from './live.mjs';

const SHORT = { connecting: 'Connecting', joined: 'Connected', lost: 'Not connected', ended: 'Ended' };

// `openMaps` opens the dialog with all maps.
export function connectionPanel(viewer, openMaps) {
  const [banner, words] = [byId('banner'), byId('banner-words')];
  let state = 'connecting';
  let told = '';
  let retryAt = null;

  function count() {
    const seconds = retryAt === null ? 0 : Math.ceil((retryAt - performance.now()) / 1000);
    setText(words, seconds > 0 ? `${told} Next attempt in ${seconds} s.` : told);
  }
  setInterval(() => { if (!banner.hidden) count(); }, 250);

  byId('banner-retry').addEventListener('click', () => {
    if (state === 'ended') location.reload();
    else viewer.command({ do: 'retry' });
  });
  byId('banner-maps').addEventListener('click', openMaps);

  viewer.on('connection', (part) => {
    const before = state;
    ({ state } = part);
    told = part.words;
    retryAt = part.retry_ms === undefined ? null : performance.now() + part.retry_ms;
    document.body.dataset.connection = state;
    setText(byId('status-connection'), SHORT[state]);
    banner.hidden = state === 'joined' || state === 'connecting';
    setText(byId('banner-retry'), state === 'ended' ? 'Reload' : 'Retry now');
    byId('banner-maps').hidden = state !== 'ended';
    count();
    if (state === before) return;
    if (!banner.hidden) say(told, true);
    else if (state === 'joined' && before === 'lost') say('Connected again.');
  });
}
