// The HTTP side of the server: maps are made, described and deleted there.
import { Refusal } from './connection.mjs';

// Errors come as problem documents; the code is at the end of their type.
async function request(url, options) {
  const response = await fetch(url, options);
  const body = await response.text();
  if (response.ok) return body ? JSON.parse(body) : undefined;
  const problem = JSON.parse(body);
  throw new Refusal({
    code: problem.type.split(':').at(-1), message: problem.detail, field: problem.field,
  });
}

export function createMap(server, name, settings = {}) {
  return request(`${server}/api/maps`, {
    method: 'POST',
    headers: { 'Content-Type': 'application/json' },
    body: JSON.stringify({ name, settings }),
  });
}

export function describeMap(server, name) { return request(`${server}/api/maps/${name}`); }
export function figuresOf(server, name) { return request(`${server}/api/maps/${name}/figures`); }
export function deleteMap(server, name) {
  return request(`${server}/api/maps/${name}`, { method: 'DELETE' });
}
