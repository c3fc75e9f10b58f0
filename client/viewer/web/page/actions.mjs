// What is done with the view and the map as a whole: fit, look down, screenshot, export.
import { byId, make } from './dom.mjs';
import { exportUrl } from './api.mjs';
import { toast } from './live.mjs';

export function actionButtons(viewer) {
  const camera = (id, action) =>
    byId(id).addEventListener('click', () => viewer.command({ do: 'camera', action }));
  camera('fit', 'fit');
  camera('look-down', 'top');
  byId('screenshot').addEventListener('click', () => savePicture(viewer));

  viewer.on('map', ({ name }) => {
    const link = byId('export');
    link.href = exportUrl(name);
    link.download = `${name}.glb`;
  });
}

function savePicture(viewer) {
  if (!viewer.started) return;
  const name = viewer.part('map')?.name ?? 'earthwork';
  viewer.draw();
  // Asked for in the task that drew it: later the picture may be gone.
  byId('canvas').toBlob((blob) => {
    if (!blob) {
      toast('The picture could not be saved.', 'lost');
      return;
    }
    const url = URL.createObjectURL(blob);
    make('a', { href: url, download: `${name}.png` }).click();
    setTimeout(() => URL.revokeObjectURL(url), 60_000);
    toast(`Saved ${name}.png`);
  }, 'image/png');
}
