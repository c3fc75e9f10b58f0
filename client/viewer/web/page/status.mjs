// The line of figures, and how far the first picture is.
import { byId, setText } from './dom.mjs';
import { bytes, milliseconds, whole } from './words.mjs';

const NONE = '–';

export function statusLine(viewer) {
  const progress = byId('progress');

  function wait() {
    const [status, connection] = [viewer.part('status'), viewer.part('connection')];
    const waits = connection?.state !== 'ended' && connection?.state !== 'lost' && !status?.caught_up;
    progress.hidden = !waits;
    const chunks = status?.chunks ?? 0;
    progress.setAttribute('aria-valuetext', `${whole(chunks)} chunks`);
    const words = byId('status-progress');
    words.hidden = !waits;
    setText(words, chunks > 0 ? `Loading, ${whole(chunks)} chunks` : 'Loading');
  }
  viewer.on('connection', wait);
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
