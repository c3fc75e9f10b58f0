// A wire between clients and a server that breaks as networks do: at any byte, either way.
import { once } from 'node:events';
import { connect, createServer } from 'node:net';

class Wire {
  url;
  #host;                     // of the server
  #connections = new Set();  // {client, upstream, left: bytes that the server may still say}
  #isDown = false;

  // Ends the connections that there are.
  cut() { for (const { client } of this.#connections) client.destroy(); }

  // Ends them once the server has said so many bytes more, a whole number.
  cutAfter(bytes) { for (const one of this.#connections) one.left = bytes; }

  // Ends them, and new ones too until it is up.
  down() {
    this.#isDown = true;
    this.cut();
  }

  up() { this.#isDown = false; }

  // Nothing that the server says gets through to the clients of now. It still hears them.
  mute() {
    for (const { upstream } of this.#connections) upstream.removeAllListeners('data').resume();
  }

  async lay(t, server) {
    this.#host = new URL(server).host;
    const listener = createServer((client) => this.#accept(client));
    listener.listen(0, '127.0.0.1');
    await once(listener, 'listening');
    this.url = `http://127.0.0.1:${listener.address().port}`;
    t.after(() => {
      listener.close();
      this.down();
    });
  }

  #accept(client) {
    if (this.#isDown) return client.destroy();
    const [hostname, port] = this.#host.split(':');
    const upstream = connect(port, hostname);
    const connection = { client, upstream, left: Infinity };
    this.#connections.add(connection);
    // The server answers to its own name only, which is said once, in the first bytes.
    client.once('data', (bytes) => {
      const greeting = bytes.toString('latin1').replace(/^Host: .*$/m, `Host: ${this.#host}`);
      upstream.write(greeting, 'latin1');
      client.on('data', (more) => upstream.write(more));
    });
    upstream.on('data', (bytes) => {
      const passed = bytes.subarray(0, Math.min(connection.left, bytes.length));
      connection.left -= passed.length;
      client.write(passed);
      if (connection.left === 0) client.end();
    });
    for (const [one, other] of [[client, upstream], [upstream, client]]) {
      one.on('error', () => {});
      one.on('close', () => {
        other.destroy();
        this.#connections.delete(connection);
      });
    }
  }
}

// A wire to the server at that URL, for as long as the test runs; clients connect to its `url`.
export async function layWire(t, server) {
  const wire = new Wire();
  await wire.lay(t, server);
  return wire;
}
