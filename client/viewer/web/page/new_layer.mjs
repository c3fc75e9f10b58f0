// A layer as it is offered first: in a colour that none of the others has, standing on the highest,
// so that it is told apart and no two surfaces lie in one plane.

const COLORS = ['#8a9a5b', '#b08d57', '#5b8a9a', '#9a5b6e', '#7d6bb0', '#c2a84e'];

// `layers` are those that are there, with {color, wall: [bottom, top]}. Returns the same of a new one.
export function newLayer(layers) {
  const has = new Set(layers.map(({ color }) => color));
  const color = COLORS.find((one) => !has.has(one)) ?? COLORS[layers.length % COLORS.length];
  const top = layers.length === 0 ? -1 : Math.max(...layers.map(({ wall }) => wall[1]));
  return { color, wall: [top, top + 1] };
}
