// The server's HTTP side, as far as the page needs it.

// What the server said no to, in its words; `field` where one is meant.
export class Problem extends Error {
  constructor(words, field) {
    super(words);
    this.field = field;
  }
}

async function request(path, options) {
  let response;
  try {
    response = await fetch(path, { ...options, cache: 'no-store' });
  } catch {
    throw new Problem('The server does not answer. Try again in a moment.');
  }
  const text = await response.text();
  let body;
  try {
    body = text ? JSON.parse(text) : undefined;
  } catch {
    throw new Problem(`The server's answer (${response.status}) is not understood.`);
  }
  if (response.ok) return body;
  throw new Problem(body?.detail ?? `The server answered with ${response.status}.`, body?.field);
}

const of = (name) => `/api/maps/${encodeURIComponent(name)}`;

// Names, in order.
export async function mapNames() {
  return (await request('/api/maps')).maps.map((map) => map.name);
}

export function createMap(name, settings) {
  return request('/api/maps', {
    method: 'POST',
    headers: { 'Content-Type': 'application/json' },
    body: JSON.stringify({ name, settings }),
  });
}

export const deleteMap = (name) => request(of(name), { method: 'DELETE' });

export const exportUrl = (name) => `${of(name)}/export.glb`;
