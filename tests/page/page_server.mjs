// Serves the page's own files beside the fake viewer, and an HTTP side of maps in memory: enough to
// test panels without a server, an epoch or a build.
import { once } from 'node:events';
import { readFile } from 'node:fs/promises';
import { createServer } from 'node:http';
import path from 'node:path';
import { fileURLToPath } from 'node:url';

const here = path.dirname(fileURLToPath(import.meta.url));
const PAGE = path.join(here, '../../client/viewer/web/page');
const TYPES = { '.wasm': 'application/wasm', '.html': 'text/html; charset=utf-8', '.css': 'text/css', '.svg': 'image/svg+xml',
  '.mjs': 'text/javascript', '.js': 'text/javascript' };
// As strict as the real server's.
const POLICY = "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; "
  + "img-src 'self' blob:; connect-src 'self'; base-uri 'none'; form-action 'none'";

// Returns {url, maps: a Set of names, close()}.
export async function servePage() {
  const maps = new Set(['demo', 'other']);
  const server = createServer((request, response) => {
    answer(request, response, maps).catch((error) => response.writeHead(500).end(String(error)));
  });
  server.listen(0, '127.0.0.1');
  await once(server, 'listening');
  return {
    url: `http://127.0.0.1:${server.address().port}`,
    maps,
    close() {
      server.closeAllConnections();
      server.close();
    },
  };
}

async function answer(request, response, maps) {
  const { pathname } = new URL(request.url, 'http://page');
  if (pathname.startsWith('/api/')) {
    await answerApi(request, response, pathname.split('/')[3], maps);
    return;
  }
  const name = pathname === '/' ? 'index.html' : path.basename(pathname);
  const file = name === 'viewer.js' ? path.join(here, 'fake_viewer.js') : path.join(PAGE, name);
  // The page asks early for what the real viewer needs and the fake one does not.
  const content = name === 'viewer.wasm' ? '' : await readFile(file).catch(() => null);
  if (content === null) {
    response.writeHead(404).end();
    return;
  }
  response.writeHead(200,
    { 'Content-Type': TYPES[path.extname(name)], 'Content-Security-Policy': POLICY });
  response.end(content);
}

async function answerApi(request, response, name, maps) {
  const json = (status, body) => response.writeHead(status,
    { 'Content-Type': status < 400 ? 'application/json' : 'application/problem+json' })
    .end(JSON.stringify(body));
  if (request.method === 'GET' && !name) {
    json(200, { maps: [...maps].sort().map((map) => ({ name: map })) });
  } else if (request.method === 'POST') {
    const asked = JSON.parse(await body(request));
    if (maps.has(asked.name))
      json(409, { type: 'urn:earthwork:map_exists', detail: `name: there is a map ${asked.name}`,
        field: 'name' });
    else json(201, { name: maps.add(asked.name) && asked.name, settings: asked.settings });
  } else if (request.method === 'DELETE') {
    if (maps.delete(name)) response.writeHead(204).end();
    else json(404, { type: 'urn:earthwork:unknown_map', detail: `name: there is no map ${name}` });
  } else {
    json(404, { detail: 'there is nothing here' });
  }
}

async function body(stream) {
  let text = '';
  for await (const part of stream) text += part;
  return text;
}
