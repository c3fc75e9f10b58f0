// Where neighbouring chunks meet. Both have vertices at the same places of the line between them,
// or the ground would show gaps: a viewer that applies groups whole sees none at any time.
const UNIT = 32768;

// Returns the rims at which two of `chunks` come apart, as text; none, when all is well. Holds for
// maps without bounds, and once every chunk in view has arrived.
export function openRims(chunks, resolution) {
  const rims = new Map();  // from a rim to the places that its two chunks have on it
  const near = UNIT / 2;
  const far = near + resolution * UNIT;
  const add = (rim, side, place) => {
    if (!rims.has(rim)) rims.set(rim, [new Set(), new Set()]);
    rims.get(rim)[side].add(place);
  };
  for (const { layer, x, y, mesh: { xs, ys } } of chunks) {
    for (let i = 0; i < xs.length; ++i) {
      if (xs[i] === near) add(`layer ${layer}, left of ${x},${y}`, 0, ys[i]);
      if (xs[i] === far) add(`layer ${layer}, left of ${x + 1},${y}`, 1, ys[i]);
      if (ys[i] === near) add(`layer ${layer}, below ${x},${y}`, 0, xs[i]);
      if (ys[i] === far) add(`layer ${layer}, below ${x},${y + 1}`, 1, xs[i]);
    }
  }
  const sorted = (places) => [...places].sort((a, b) => a - b).join(' ');
  return [...rims].filter(([, [one, other]]) => sorted(one) !== sorted(other)).map(([rim]) => rim);
}
