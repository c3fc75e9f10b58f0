// Links to a place of a map: /?map=NAME#x,y,zoom or #x,y,zoom,yaw,tilt (map units, CSS pixels a
// unit, radians).

const MAP_NAME = /^[a-z0-9_-]{1,64}$/;

export const isMapName = (name) => MAP_NAME.test(name);

// The map that a query names; null for none, or what can be no name.
export function mapOf(query) {
  const name = new URLSearchParams(query).get('map');
  return name !== null && isMapName(name) ? name : null;
}

// Whether a query asks for a map by what can be no name.
export const asksForNoName = (query) =>
  Boolean(new URLSearchParams(query).get('map')) && mapOf(query) === null;

export const queryOf = (map) => `?map=${map}`;

// The place that a fragment names; null where it is none.
export function placeOf(hash) {
  const parts = decodeURIComponentOrNone(hash.replace(/^#/, '')).split(',');
  const numbers = parts.map((part) => (part.trim() === '' ? NaN : Number(part)));
  if ((numbers.length !== 3 && numbers.length !== 5) || !numbers.every(Number.isFinite)) return null;
  const [x, y, zoom, yaw, tilt] = numbers;
  if (!(zoom > 0)) return null;
  return numbers.length === 3 ? { x, y, zoom } : { x, y, zoom, yaw, tilt };
}

// No finer than a tenth of a CSS pixel; straight down and north up go without saying.
export function hashOf({ x, y, zoom, yaw = 0, tilt = 0 }) {
  const decimals = Math.min(6, Math.max(0, Math.ceil(Math.log10(zoom * 10))));
  const numbers = [x.toFixed(decimals), y.toFixed(decimals), zoom.toPrecision(4)];
  const turned = Math.abs(yaw) >= 0.0005 || Math.abs(tilt) >= 0.0005;
  if (turned) numbers.push(yaw.toFixed(3), tilt.toFixed(3));
  return `#${numbers.map(Number).join(',')}`;
}

function decodeURIComponentOrNone(text) {
  try {
    return decodeURIComponent(text);
  } catch {
    return '';
  }
}
