// The mesh hash of protocol/README.md: two programs that hold the same mesh find the same 64 bits,
// the server among them (GET /api/maps/NAME/figures).
import { createXXHash3 } from 'hash-wasm';

const hasher = await createXXHash3(0, 0);

function xxh3(bytes) {
  return BigInt(`0x${hasher.init().update(bytes).digest('hex')}`);
}

// Twice the area of the triangles in position units squared. Positions have 22 bits, so that the
// products, and their sum over a chunk, are exact in a double.
export function twiceArea({ xs, ys, indices }) {
  let sum = 0;
  for (let i = 0; i < indices.length; i += 3) {
    const [a, b, c] = indices.subarray(i, i + 3);
    sum += (xs[b] - xs[a]) * (ys[c] - ys[a]) - (ys[b] - ys[a]) * (xs[c] - xs[a]);
  }
  return sum;
}

// Of one chunk's mesh, as a BigInt.
export function chunkMeshHash(mesh) {
  const bytes = Buffer.alloc(8 + 24 * mesh.sections.length);
  bytes.writeBigUInt64LE(BigInt.asUintN(64, BigInt(twiceArea(mesh))));
  let at = 8;
  for (const { start, end, startNormal, endNormal } of mesh.sections) {
    for (const vertex of [start, end]) {
      at = bytes.writeInt32LE(mesh.xs[vertex], at);
      at = bytes.writeInt32LE(mesh.ys[vertex], at);
    }
    for (const component of [...startNormal, ...endNormal]) at = bytes.writeInt16LE(component, at);
  }
  return xxh3(bytes);
}

// What a chunk adds to the hash of the map.
export function hashTerm({ layer, x, y, z, mesh }) {
  const bytes = Buffer.alloc(24);
  let at = 0;
  for (const part of [layer, x, y, z]) at = bytes.writeInt32LE(part, at);
  bytes.writeBigUInt64LE(chunkMeshHash(mesh), at);
  return xxh3(bytes);
}

// Of all chunks that have a mesh, in any order; 16 hex digits.
export function meshHash(chunks) {
  let sum = 0n;
  for (const chunk of chunks) sum += hashTerm(chunk);
  return BigInt.asUintN(64, sum).toString(16).padStart(16, '0');
}
