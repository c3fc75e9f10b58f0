// An example of a bot: paints a ring of stamps on a map, watches the meshes that come of it, and
// prints what it ends up with as one JSON object.
//
//   node paint.mjs http://127.0.0.1:8080 MAP
import { Client } from './client.mjs';
import { createMap } from './maps.mjs';
import { twiceArea } from './mesh_hash.mjs';

const RING_RADIUS = 20;
const STAMPS = 48;
const UNIT = 32768;  // positions per voxel

async function createUnlessThere(server, name) {
  try {
    await createMap(server, name);
  } catch (error) {
    if (error.code !== 'map_exists') throw error;
  }
}

// Edits are numbered in the order in which they are sent, so all of them may be on their way at
// once. A bot that paints without end waits for replies in between.
function paintRing(client) {
  const replies = [];
  for (let i = 0; i < STAMPS; ++i) {
    const angle = 2 * Math.PI * i / STAMPS;
    replies.push(client.edit({
      stencil: i % 2 === 0 ? 'circle' : 'square',
      fill: true,
      x: RING_RADIUS * Math.cos(angle),
      y: RING_RADIUS * Math.sin(angle),
      radius: 2.5,
      stroke: 1,
    }));
  }
  return Promise.all(replies);
}

function describe({ joined, scene }) {
  const chunks = [...scene.chunks.values()];
  const total = (count) => chunks.reduce((sum, chunk) => sum + count(chunk.mesh), 0);
  return {
    map: joined.map,
    seq: scene.seq,
    chunks: chunks.length,
    triangles: total((mesh) => mesh.indices.length / 3),
    sections: total((mesh) => mesh.sections.length),
    area: total(twiceArea) / 2 * (joined.settings.voxel_size / UNIT) ** 2,
    mesh_hash: scene.meshHash(),
  };
}

async function main(server, name) {
  await createUnlessThere(server, name);
  const client = await Client.connect(server, { name: 'ring painter' });
  await client.join(name);
  await client.view();
  const numbers = await paintRing(client);
  await client.until(numbers.at(-1));
  console.log(JSON.stringify(describe(client)));
  await client.close();
}

const [server, name] = process.argv.slice(2);
if (!name) {
  console.error('usage: node paint.mjs http://HOST:PORT MAP');
  process.exit(2);
}
await main(server, name);
