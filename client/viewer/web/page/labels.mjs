// Names beside cursors and words beside places. They catch no pointers, and are for eyes only: the
// people's list and the messages say the same.
import { byId, make, setText } from './dom.mjs';
import { inkOn } from './words.mjs';

export function labelsOverlay(viewer) {
  const place = byId('labels');
  viewer.onLabels((labels) => {
    while (place.children.length > labels.length) place.lastChild.remove();
    while (place.children.length < labels.length) place.append(make('div'));
    labels.forEach((label, index) => {
      const element = place.children[index];
      element.className = `label ${label.kind}`;
      setText(element, label.text);
      element.style.transform = `translate(${Math.round(label.x)}px, ${Math.round(label.y)}px)`;
      const own = label.kind === 'person' && label.color;
      element.style.background = own ? label.color : '';
      element.style.color = own ? inkOn(label.color) : '';
    });
  });
}
