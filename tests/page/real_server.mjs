// The real server with the real page, its maps in a folder of its own: it can be killed and started
// again at the same address.
import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { mkdtemp, rm } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { createInterface } from 'node:readline';

const program = process.env.EARTHWORK_SERVER;
const page = process.env.EARTHWORK_PAGE;

export class RealServer {
  url;
  #folder;
  #process;
  #port = 0;

  static async start() {
    if (!program || !page)
      throw new Error('EARTHWORK_SERVER must name the server, EARTHWORK_PAGE the folder of the page');
    const server = new RealServer();
    server.#folder = await mkdtemp(path.join(tmpdir(), 'earthwork-maps-'));
    await server.startAgain();
    return server;
  }

  // Once it was killed; else nothing happens.
  async startAgain() {
    if (this.#process && this.#process.exitCode === null && this.#process.signalCode === null) return;
    const process = spawn(program, ['serve', '--data', path.join(this.#folder, 'data'),
      '--listen', `127.0.0.1:${this.#port}`, '--page', page], { stdio: ['ignore', 'pipe', 'inherit'] });
    const ended = once(process, 'exit').then(([status]) => `it ended with ${status}`);
    const said = once(createInterface(process.stdout), 'line').then(([line]) => line);
    const line = await Promise.race([said, ended]);
    this.url = /^listening on (http:\S+)$/.exec(line)?.[1];
    if (!this.url) throw new Error(`${program}: ${line}`);
    this.#port = new URL(this.url).port;
    this.#process = process;
  }

  // As a power cut would end it.
  async kill() {
    const gone = once(this.#process, 'exit');
    this.#process.kill('SIGKILL');
    await gone;
  }

  async stop() {
    if (this.#process.exitCode === null && this.#process.signalCode === null) {
      const gone = once(this.#process, 'exit');
      this.#process.kill('SIGTERM');
      await gone;
    }
    await rm(this.#folder, { recursive: true, force: true });
  }
}
