// Figures as people read them.

export function bytes(count) {
  if (count < 1000) return `${count} B`;
  const units = ['kB', 'MB', 'GB'];
  let value = count / 1000;
  let unit = 0;
  while (value >= 999.5 && unit < units.length - 1) {
    value /= 1000;
    ++unit;
  }
  return `${value < 9.95 ? value.toFixed(1) : Math.round(value)} ${units[unit]}`;
}

// Thousands apart: 1,234,567.
export const whole = (count) => String(Math.round(count)).replace(/\B(?=(\d{3})+$)/g, ',');

export function milliseconds(value) {
  return `${value < 9.95 ? value.toFixed(1) : Math.round(value)} ms`;
}

export const clock = (timeMs) =>
  new Date(timeMs).toLocaleTimeString([], { hour: '2-digit', minute: '2-digit' });

// As many as there are for a reader: an emoji is one of them, though JavaScript counts two.
export const characters = (text) => [...text].length;

// Black or white, whichever reads better on '#rrggbb'.
export function inkOn(color) {
  const [red, green, blue] = [1, 3, 5].map((at) => {
    const part = parseInt(color.slice(at, at + 2), 16) / 255;
    return part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4;
  });
  return 0.2126 * red + 0.7152 * green + 0.0722 * blue > 0.179 ? '#000000' : '#ffffff';
}
