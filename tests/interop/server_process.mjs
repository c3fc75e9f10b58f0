// The real server, on a port of its own, for as long as a test file runs.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { createInterface } from 'node:readline';
import { after } from 'node:test';

const program = process.env.EARTHWORK_SERVER;

// Returns {url, stop()}; stop() resolves with the server's exit status.
export async function startServer() {
  if (!program) throw new Error('EARTHWORK_SERVER must name the program earthwork-server');
  const server = spawn(program, ['serve', '--memory', '--listen', '127.0.0.1:0'],
    { stdio: ['ignore', 'pipe', 'inherit'] });
  const ended = once(server, 'exit').then(([status]) => status);
  const said = once(createInterface(server.stdout), 'line').then(([line]) => line);
  const line = await Promise.race([said, ended.then((status) => `it ended with ${status}`)]);
  const url = /^listening on (http:\S+)$/.exec(line)?.[1];
  if (!url) throw new Error(`${program}: ${line}`);
  return {
    url,
    stop() {
      server.kill('SIGTERM');
      return ended;
    },
  };
}

// Starts it for all tests of a file, after which it must end well. Returns its url.
export async function serverForThisFile() {
  const server = await startServer();
  after(async () => assert.equal(await server.stop(), 0));
  return server.url;
}
