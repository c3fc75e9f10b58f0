// One connection to the server: messages out, messages in, and the reply to each request. When it
// ends, what waits for a reply fails with the reason; what to do then is client.mjs's business.
import { EventEmitter } from 'node:events';
import WebSocket from 'ws';

const SUBPROTOCOL = 'earthwork.v1';
const MAX_SERVER_MESSAGE_BYTES = 1048576;
// The server pings after half of this, so a connection that is silent for longer is dead.
const SILENCE_MS = 30_000;
// After a bye with one of these, another connection may be welcome.
const PASSING = new Set(['internal', 'shutting_down', 'timeout']);

// What the server said no to: `code` for programs, `message` for people, `field` where one is
// wrong.
export class Refusal extends Error {
  constructor({ code, message, field }) {
    super(message);
    Object.assign(this, { code, field });
  }
}

// The connection is gone, and another one may do better, `retryAfterMs` from now on.
export class Disconnected extends Error {
  constructor(message, retryAfterMs = 0) {
    super(message);
    this.retryAfterMs = retryAfterMs;
  }
}

// Events: 'control' (a message that is no reply), 'binary' (bytes), and 'end' (why, an Error),
// which comes once and last.
export class Connection extends EventEmitter {
  ended;  // why, once it has
  #socket;
  #requests = new Map();  // from id to what waits for the reply
  #silence;

  // `server` is http://HOST:PORT. What is asked before the connection stands waits for it.
  constructor(server) {
    super();
    this.#socket = new WebSocket(`${server.replace(/^http/, 'ws')}/ws`, SUBPROTOCOL, {
      maxPayload: MAX_SERVER_MESSAGE_BYTES,
    });
    this.#socket.on('open', () => this.#requests.forEach(({ message }) => this.#send(message)));
    this.#socket.on('message', (data, isBinary) => this.#receive(data, isBinary));
    this.#socket.on('ping', () => this.#silence.refresh());
    this.#socket.on('error', (error) => this.#end(new Disconnected(error.message)));
    this.#socket.on('close', () => this.#end(new Disconnected('the connection was closed')));
    this.#silence = setTimeout(() => {
      this.#end(new Disconnected('the server fell silent'));
      this.#socket.terminate();
    }, SILENCE_MS);
  }

  // Sends `message`, which has an id, and gives its reply. `atReply` is called with it before any
  // later message is looked at.
  ask(message, atReply = () => {}) {
    return new Promise((resolve, reject) => {
      if (this.ended) return reject(this.ended);
      this.#requests.set(message.id, { message, atReply, resolve, reject });
      if (this.#socket.readyState === WebSocket.OPEN) this.#send(message);
    });
  }

  async close() {
    if (this.#socket.readyState === WebSocket.CLOSED) return;
    const closed = new Promise((resolve) => { this.#socket.once('close', resolve); });
    this.#socket.close(1000);
    await closed;
  }

  #send(message) { this.#socket.send(JSON.stringify(message)); }

  #receive(data, isBinary) {
    if (this.ended) return;
    this.#silence.refresh();
    try {
      if (isBinary) this.emit('binary', data);
      else this.#hear(JSON.parse(data));
    } catch (error) {  // a server that does not keep to the protocol
      this.#end(error);
      this.#socket.close(1002);
    }
  }

  #hear(message) {
    if (message.type === 'bye') {
      const refusal = new Refusal(message);
      return this.#end(PASSING.has(message.code)
        ? new Disconnected(message.message, message.retry_after_ms) : refusal);
    }
    const request = this.#requests.get(message.id);
    if (!request) return this.emit('control', message);
    this.#requests.delete(message.id);
    if (message.type === 'rejected') return request.reject(new Refusal(message));
    request.atReply(message);
    request.resolve(message);
  }

  #end(why) {
    if (this.ended) return;
    this.ended = why;
    clearTimeout(this.#silence);
    for (const { reject } of this.#requests.values()) reject(why);
    this.#requests.clear();
    this.emit('end', why);
  }
}
