// A client of the server: says hello, joins a map, looks, paints. Every request is a promise of its
// reply; a request that the server turns down throws a Refusal. Reconnecting is the caller's: open
// a new client with `key`, and tell view() what `have` is still held.
import { EventEmitter } from 'node:events';
import WebSocket from 'ws';
import { Scene } from './scene.mjs';

const SUBPROTOCOL = 'earthwork.v1';
const VERSIONS = [1, 1];
const MAX_SERVER_MESSAGE_BYTES = 1048576;

// What the server said no to: `code` for programs, `message` for people, `field` where one is
// wrong.
export class Refusal extends Error {
  constructor({ code, message, field }) {
    super(message);
    Object.assign(this, { code, field });
  }
}

// Events: 'change' (records that became visible), 'close' (why, an Error).
export class Client extends EventEmitter {
  welcome;  // {session, key, protocol, limits}
  joined;   // {map, settings, epoch, seq, users}: the map as it was then
  scene;    // what is seen of it
  #socket;
  #lastId = 0;
  #lastView = 0;
  #requests = new Map();  // from id to what waits for the reply
  #waiting = new Set();   // what waits for the scene
  #ended;                 // why there is no connection any more

  // `server` is http://HOST:PORT. `key`, of an earlier welcome, makes this the same author again.
  static async connect(server, { name = 'a bot', color = '#40a060', key } = {}) {
    const client = new Client(new WebSocket(`${server.replace(/^http/, 'ws')}/ws`, SUBPROTOCOL, {
      maxPayload: MAX_SERVER_MESSAGE_BYTES,
    }));
    await new Promise((resolve, reject) => {
      client.#socket.once('open', resolve);
      client.once('close', reject);
    });
    client.welcome = await client.#ask({ type: 'hello', protocol: VERSIONS, name, color, key });
    return client;
  }

  constructor(socket) {
    super();
    this.#socket = socket;
    socket.on('message', (data, isBinary) => this.#receive(data, isBinary));
    socket.on('error', (error) => this.#end(error));
    socket.on('close', () => this.#end(new Error('the connection was closed')));
  }

  // The last id given to a request. Ids grow, so an author who comes back goes on from here.
  get lastId() { return this.#lastId; }

  async join(map) {
    await this.#ask({ type: 'join', map }, (joined) => {
      this.joined = joined;
      this.scene = new Scene(joined);
    });
  }

  leave() { return this.#ask({ type: 'leave' }); }
  ping() { return this.#ask({ type: 'ping' }); }

  // Looks at `rect`, [x0, y0, x1, y1] in map units, or at all of the map without one. `have`,
  // {epoch, seq, rect}, claims what `chunks` of an earlier scene held.
  view(rect, { have, chunks = [] } = {}) {
    const n = ++this.#lastView;
    const what = rect ? { rect } : { all: true };
    // The scene changes exactly at the reply: what belongs to the new view comes after it.
    return this.#ask({ type: 'view', n, ...what, have }, () => {
      for (const [key, chunk] of chunks) this.scene.chunks.set(key, chunk);
      this.scene.look({ n, rect });
    });
  }

  // Stamps {stencil, fill, x, y or path, radius, layer?, stroke?}. Returns the edit's number.
  async edit(stamp) {
    return (await this.#ask({ type: 'edit', ...stamp })).seq;
  }

  // Resolves once all of the view is held, as of `seq` or later.
  until(seq) {
    return new Promise((resolve, reject) => {
      if (this.#ended) return reject(this.#ended);
      this.#waiting.add({ seq, resolve, reject });
      this.#settle();
    });
  }

  async close() {
    if (this.#socket.readyState === WebSocket.CLOSED) return;
    const closed = new Promise((resolve) => { this.#socket.once('close', resolve); });
    this.#socket.close(1000);
    await closed;
  }

  // `atReply` runs before any later message is looked at.
  #ask(message, atReply = () => {}) {
    return new Promise((resolve, reject) => {
      if (this.#ended) return reject(this.#ended);
      const id = ++this.#lastId;
      this.#requests.set(id, { atReply, resolve, reject });
      this.#socket.send(JSON.stringify({ ...message, id }));
    });
  }

  #receive(data, isBinary) {
    try {
      if (isBinary) this.#see(data);
      else this.#hear(JSON.parse(data));
    } catch (error) {
      this.#end(error);
      this.#socket.close(1002);
    }
  }

  #see(message) {
    const records = this.scene.receive(message);
    if (records.length > 0) this.emit('change', records);
    this.#settle();
  }

  #hear(message) {
    if (message.type === 'bye') return this.#end(new Refusal(message));
    if (message.type === 'caught_up') {
      this.scene.catchUp(message);
      return this.#settle();
    }
    const request = this.#requests.get(message.id);
    if (!request) return;  // no reply, and of a type that this client does not know
    this.#requests.delete(message.id);
    if (message.type === 'rejected') return request.reject(new Refusal(message));
    request.atReply(message);
    request.resolve(message);
  }

  #settle() {
    if (!this.scene?.complete) return;
    for (const waiter of this.#waiting) {
      if (waiter.seq > this.scene.seq) continue;
      this.#waiting.delete(waiter);
      waiter.resolve();
    }
  }

  #end(why) {
    if (this.#ended) return;
    this.#ended = why;
    for (const { reject } of [...this.#requests.values(), ...this.#waiting]) reject(why);
    this.#requests.clear();
    this.#waiting.clear();
    this.emit('close', why);
  }
}
