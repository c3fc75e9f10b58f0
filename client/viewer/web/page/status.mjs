// The line of figures, how far the first picture is, and what waits for the server to be back.
import { byId, setText } from './dom.mjs';
import { bytes, milliseconds, whole } from './words.mjs';

const NONE = '–';

export function statusLine(viewer) {
  const [progress, words] = [byId('progress'), byId('status-progress')];

  function wait() {
    const [status, connection] = [viewer.part('status'), viewer.part('connection')];
    const away = connection?.state === 'lost';
    const loads = !away && connection?.state !== 'ended' && !status?.caught_up;
    const chunks = whole(status?.chunks ?? 0);
    const kept = away ? status?.unanswered ?? 0 : 0;
    progress.hidden = !loads;
    progress.setAttribute('aria-valuetext', `${chunks} chunks`);
    words.hidden = !loads && kept === 0;
    setText(words, loads ? `Loading, ${chunks} chunks`
      : `${whole(kept)} ${kept === 1 ? 'edit waits' : 'edits wait'} for the server`);
  }
  viewer.on('connection', wait);
  // With the page goes what the server did not answer yet: the browser asks first.
  addEventListener('beforeunload', (event) => {
    if (viewer.part('status')?.unanswered > 0) event.preventDefault();
  });
  viewer.on('status', (part) => {
    setText(byId('figure-latency'),
      part.latency_ms === undefined ? NONE : milliseconds(part.latency_ms));
    setText(byId('figure-fps'), `${Math.round(part.fps)} fps`);
    setText(byId('figure-seq'), whole(part.seq));
    setText(byId('figure-bytes'), bytes(part.bytes));
    setText(byId('figure-triangles'), whole(part.triangles));
    wait();
  });
}
