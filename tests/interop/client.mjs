// A client of the server: says hello, joins a map, looks, paints. Every request is a promise of its
// reply; a request that the server turns down throws a Refusal.
//
// A connection that is lost is opened again, and nobody who uses the client needs to know: it comes
// back under its key, sends every request again that was not answered, and is sent what changed in
// its view meanwhile. No edit is lost, and none is done twice.
import { EventEmitter } from 'node:events';
import { setTimeout as delay } from 'node:timers/promises';
import { waitBefore } from './backoff.mjs';
import { Connection, Disconnected } from './connection.mjs';
import { People } from './people.mjs';
import { Scene } from './scene.mjs';

const VERSIONS = [1, 1];

// Events: 'change' (records that became visible), 'presence' (sessions, see `people`), 'event' (an
// edit that the map accepted), 'lost' (why), 'back', and 'close' (why, an Error) when it is over.
export class Client extends EventEmitter {
  welcome;  // {session, key, protocol, limits} of the last connection
  joined;   // {map, settings, epoch, seq, users}: the map as it was then
  scene;    // what is seen of it
  people;   // who is there
  #server;
  #who;
  #connection;
  #live = false;  // requests are sent at once
  #lastId;
  #lastView = 0;
  #nextEvent;               // the seq of the event that comes next, when they were asked for
  #unanswered = new Set();  // requests, in the order of their ids
  #waiting = new Set();     // what waits for the scene
  #ended;                   // why it is over

  // `server` is http://HOST:PORT. `key`, of an earlier welcome, makes this the same author again;
  // then `lastId` is the largest id that was given to a request under that key.
  static async connect(server, { name = 'a bot', color = '#40a060', key, lastId = 0 } = {}) {
    const client = new Client();
    client.#server = server;
    client.#who = { protocol: VERSIONS, name, color, key };
    client.#lastId = lastId;
    await client.#open();
    return client;
  }

  get lastId() { return this.#lastId; }

  join(map) {
    return this.#ask({ type: 'join', map }, (joined) => {
      this.joined = joined;
      this.scene = new Scene(joined);
      this.people = new People(joined.users);
    });
  }

  leave() {
    return this.#ask({ type: 'leave' }, () => {
      this.joined = this.scene = this.people = this.#nextEvent = undefined;
    });
  }

  ping() { return this.#ask({ type: 'ping' }); }

  // Looks at `rect`, [x0, y0, x1, y1] in map units, or at all of the map without one.
  view(rect) { return this.#ask(...this.#viewOf(rect)); }

  // Stamps {stencil, fill, x, y or path, radius, layer?, stroke?}. Returns the edit's number.
  async edit(stamp) { return (await this.#ask({ type: 'edit', ...stamp })).seq; }

  // Points at {x, y}, or nowhere without it, with a brush {stencil, radius, fill, layer?} in hand.
  // To be said again within 30 seconds.
  cursor(at, brush) {
    return this.#ask({ type: 'cursor', ...(at ?? { hidden: true }), brush });
  }

  // All that the map accepted from that seq on, as 'event', and then what it accepts.
  events(fromSeq) {
    return this.#ask({ type: 'events', from_seq: fromSeq }, () => { this.#nextEvent = fromSeq; });
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
    this.#end(new Error('the client was closed'));
    await this.#connection.close();
  }

  #ask(message, atReply) {
    return new Promise((resolve, reject) => {
      if (this.#ended) return reject(this.#ended);
      const request = { message: this.#numbered(message), atReply, resolve, reject };
      this.#unanswered.add(request);
      if (this.#live) this.#send(request);
    });
  }

  #numbered(message) { return { ...message, id: ++this.#lastId }; }

  async #send(request) {
    try {
      const reply = await this.#connection.ask(request.message, request.atReply);
      request.resolve(reply);
    } catch (error) {
      if (error instanceof Disconnected) return;  // it is sent again
      request.reject(error);
    }
    this.#unanswered.delete(request);
  }

  async #open() {
    const connection = new Connection(this.#server);
    this.#connection = connection;
    connection.on('binary', (message) => this.#see(message));
    connection.on('control', (message) => this.#hear(message));
    this.welcome = await connection.ask(this.#numbered({ type: 'hello', ...this.#who }));
    this.#who.key = this.welcome.key;
    if (this.joined) await this.#rejoin(connection);
    if (connection.ended) throw connection.ended;
    connection.once('end', (why) => this.#lose(why));
    this.#live = true;
    for (const request of this.#unanswered) this.#send(request);
  }

  // Back into the map, to the same view, as far as it was seen, and the same place in the events.
  async #rejoin(connection) {
    const { map, epoch } = this.joined;
    const joined = await connection.ask(this.#numbered({ type: 'join', map }), ({ users }) => {
      this.people = new People(users);
    });
    if (joined.epoch !== epoch) throw new Error(`${map} was made anew: what was drawn is lost`);
    const have = this.scene.interrupt();
    const again = [];
    if (this.scene.view) again.push(this.#viewOf(this.scene.view.rect, have));
    if (this.#nextEvent) again.push([{ type: 'events', from_seq: this.#nextEvent }]);
    for (const [message, atReply] of again) await connection.ask(this.#numbered(message), atReply);
  }

  // The message, and what to do at its reply: from there on all that comes belongs to this view.
  #viewOf(rect, have) {
    const n = ++this.#lastView;
    return [
      { type: 'view', n, ...(rect ? { rect } : { all: true }), have },
      () => this.scene.look({ n, rect }),
    ];
  }

  async #lose(why) {
    this.#live = false;
    if (this.#ended) return;
    this.emit('lost', why);
    for (let attempt = 0; ; ++attempt) {
      if (!(why instanceof Disconnected)) return this.#end(why);
      await delay(Math.max(waitBefore(attempt), why.retryAfterMs), undefined, { ref: false });
      if (this.#ended) return;
      try {
        await this.#open();
        return this.emit('back');
      } catch (error) {
        why = error;
      }
    }
  }

  #see(message) {
    if (!this.scene) return;  // of a map that was left
    const records = this.scene.receive(message);
    if (records.length > 0) this.emit('change', records);
    this.#settle();
  }

  // A message that is no reply; one of a type that this client does not know is ignored.
  #hear(message) {
    if (!this.joined) return;
    if (message.type === 'caught_up') {
      this.scene.catchUp(message);
      this.#settle();
    } else if (message.type === 'presence') {
      this.emit('presence', this.people.apply(message));
    } else if (message.type === 'event') {
      if (message.seq !== this.#nextEvent) return;  // on its way before they began anew
      ++this.#nextEvent;
      this.emit('event', message);
    }
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
    for (const { reject } of [...this.#unanswered, ...this.#waiting]) reject(why);
    this.#unanswered.clear();
    this.#waiting.clear();
    this.emit('close', why);
  }
}
