// Delta records: what an edit makes of a chunk's mesh, as protocol/README.md, "Delta record", has
// it. Whatever does not follow it throws BadFrame.
import { BadFrame, Reader, expect, unzigzag, COORDINATE_END, MAX_LENGTH, MAX_VERTICES }
  from './records.mjs';

const LINE = 32768;  // from one row or column to the next
const FAR = 2 ** 23;
const ADDED = 65536;  // vertices of the base are below it, new ones from here on

// A direction or point seen from a row (x along it), or from a column (y along it).
const seen = (row, { x, y }) => (row ? { along: x, across: y } : { along: y, across: x });
const minus = (a, b) => ({ x: a.x - b.x, y: a.y - b.y });
const dot = (a, b) => a.x * b.x + a.y * b.y;
const same = (a, b) => a.x === b.x && a.y === b.y;
const precedes = (a, b) => (a.y === b.y ? a.x < b.x : a.y < b.y);
const rounded = (value, otherwise) =>
  Math.floor((Math.abs(value) < FAR ? value : otherwise) + 0.5);
const goes = (normal) => ({ x: -normal.y, y: normal.x });
const toPoint = ([x, y]) => ({ x, y });

function normalAlong(d) {
  const scale = 32767 / Math.sqrt(dot(d, d));
  return { x: Math.floor(d.x * scale + 0.5), y: Math.floor(d.y * scale + 0.5) };
}

const rightOf = (a, b) => ({ x: b.y - a.y, y: a.x - b.x });

function mirrored(a, b, normal) {
  const d = rightOf(a, b);
  const turn = 2 * dot(normal, d) / dot(d, d);
  return normalAlong({ x: turn * d.x - normal.x, y: turn * d.y - normal.y });
}

function nextLine(wall, row, behind) {
  const at = seen(row, wall.at).across - LINE / 2;
  const up = seen(row, goes(wall.normal)).across >= 0 !== behind;
  return LINE / 2 + LINE * (up ? Math.floor(at / LINE) + 1 : Math.ceil(at / LINE) - 1);
}

// Where the wall meets the line: on the circle of the last section, if it was bent, or straight on.
function guessOnLine({ at, normal, bend }, row, position) {
  const here = seen(row, at);
  const going = seen(row, goes(normal));
  let guess = here.along;
  if (going.across !== 0) guess += (position - here.across) * going.along / going.across;
  if (!(Math.abs(guess - here.along) < 2 * LINE)) guess = here.along;
  if (bend) {
    const turned = minus(normal, bend.normal);
    const reach = dot(minus(at, bend.from), turned) / dot(turned, turned);
    const n = seen(row, normal);
    const along = here.along - reach * n.along;
    const off = position - (here.across - reach * n.across);
    const square = reach * 32767 * (reach * 32767) - off * off;
    if (square >= 0) {
      const [high, low] = [along + Math.sqrt(square), along - Math.sqrt(square)];
      guess = Math.abs(high - here.along) < Math.abs(low - here.along) ? high : low;
    }
  }
  return rounded(guess, here.along);
}

class Delta {
  #reader;
  #base;       // the mesh: points, sections with points for normals, indices
  #added = [];
  #kept;       // of the base's vertices, those that a section of the new mesh stands on
  #sections = [];
  #last = 0;   // the vertex of the base that was named last
  #numbers;    // of a vertex in the new mesh

  constructor(mesh, operations) {
    this.#reader = new Reader(operations);
    this.#base = {
      points: Array.from(mesh.xs, (x, i) => ({ x, y: mesh.ys[i] })),
      indices: mesh.indices,
      sections: mesh.sections.map(({ start, end, startNormal, endNormal }) =>
        ({ start, end, startNormal: toPoint(startNormal), endNormal: toPoint(endNormal) })),
    };
    this.#kept = new Uint8Array(mesh.xs.length);
  }

  apply() {
    this.#readSections();
    this.#readVertices();
    const points = this.#putVertices();
    const sections = this.#sections.map(({ start, end, startNormal, endNormal }) => ({
      start: this.#number(start),
      end: this.#number(end),
      startNormal: [startNormal.x, startNormal.y],
      endNormal: [endNormal.x, endNormal.y],
    }));
    const indices = this.#readTriangles(points.length, sections);
    expect(this.#reader.left === 0, 'a delta has bytes left over');
    return {
      xs: Int32Array.from(points, ({ x }) => x),
      ys: Int32Array.from(points, ({ y }) => y),
      indices: Int32Array.from(indices),
      sections,
    };
  }

  #point(vertex) {
    return vertex < ADDED ? this.#base.points[vertex] : this.#added[vertex - ADDED];
  }

  #readSections() {
    const { sections } = this.#base;
    const count = this.#reader.varint();
    let next = 0;
    let copies = 0;
    while (this.#sections.length < count) {
      const added = this.#reader.varint();
      const copied = this.#reader.varint();
      if (copied > 0) next += this.#reader.step();
      copies += copied;
      expect(added + copied > 0 && this.#sections.length + added + copied <= count &&
        copies <= sections.length, 'a piece has too many sections, or none');
      expect(copied === 0 || (next >= 0 && next + copied <= sections.length),
        'sections are copied that the base does not have');
      const joined = copied > 0 ? sections[next] : undefined;
      for (let i = 0; i < added; ++i) this.#sections.push(this.#readSection(joined));
      for (const section of sections.slice(next, next + copied)) {
        this.#kept[section.start] = this.#kept[section.end] = 1;
        this.#sections.push(section);
      }
      next += copied;
    }
  }

  // `joined` is the first section that is copied after this one.
  #readSection(joined) {
    const head = this.#reader.varint();
    const given = head & 1;
    const [kind, startKind, endKind] = [1, 3, 5].map((shift) => head >> shift & 3);
    const before = this.#sections.at(-1);
    expect(head < 256 && startKind < 3 && endKind < 3, 'a section has no such head');
    expect(given ? startKind !== 0 : before !== undefined, 'a section starts nowhere');
    const copy = () => {
      expect(joined, 'a section joins a copied one that is not there');
      return joined;
    };
    const start = given ? this.#readVertex() : before.end;
    const wall = given
      ? { at: this.#point(start), normal: { x: 0, y: 0 } } : this.#wallAfter(before);
    const end = kind < 3 ? this.#readEnd(wall, kind, startKind !== 0)
      : head & 128 ? this.#readVertex() : copy().start;
    const [a, b] = [this.#point(start), this.#point(end)];
    expect(!same(a, b), 'a section ends where it starts');
    const startNormal = startKind === 0 ? before.endNormal
      : startKind === 1 ? this.#readNormal(normalAlong(rightOf(a, b))) : copy().startNormal;
    const endNormal = endKind === 0 ? startNormal
      : endKind === 1 ? this.#readNormal(mirrored(a, b, startNormal)) : copy().startNormal;
    return { start, end, startNormal, endNormal };
  }

  #wallAfter({ start, end, startNormal, endNormal }) {
    const bend = same(startNormal, endNormal)
      ? undefined : { from: this.#point(start), normal: startNormal };
    return { at: this.#point(end), normal: endNormal, bend };
  }

  #readVertex() {
    const bits = this.#reader.varint();
    const value = Math.floor(bits / 4);
    if (bits % 4 === 2) return this.#add({ x: value, y: this.#reader.varint() });
    if (bits % 4 === 1) {
      expect(value < this.#added.length, 'a new vertex is named that is not there');
      return ADDED + value;
    }
    this.#last += unzigzag(value);
    expect(bits % 4 === 0 && this.#last >= 0 && this.#last < this.#kept.length,
      'a vertex is named that the base does not have');
    this.#kept[this.#last] = 1;
    return this.#last;
  }

  #readEnd(wall, kind, creased) {
    if (kind === 2) return this.#add(this.#readBeside(wall, creased));
    const row = kind === 0;
    const bits = this.#reader.varint();
    const across = nextLine(wall, row, bits % 2 === 1);
    const guess = creased ? seen(row, wall.at).along : guessOnLine(wall, row, across);
    const along = guess + unzigzag(Math.floor(bits / 2));
    return this.#add(row ? { x: along, y: across } : { x: across, y: along });
  }

  #readBeside({ at, normal }, creased) {
    const byX = Math.abs(normal.y) > Math.abs(normal.x);
    const going = seen(byX, goes(normal));
    const ahead = this.#reader.step();
    const guess = creased || going.along === 0
      ? 0 : rounded(ahead * going.across / going.along, 0);
    const beside = guess + this.#reader.step();
    return byX ? { x: at.x + ahead, y: at.y + beside } : { x: at.x + beside, y: at.y + ahead };
  }

  #readNormal(guess) {
    const steps = this.#reader.u8();
    expect(steps <= 240, `${steps} is no normal`);
    const normal = steps === 240 ? { x: this.#reader.i16(), y: this.#reader.i16() }
      : { x: guess.x + unzigzag(steps >> 4), y: guess.y + unzigzag(steps & 15) };
    expect(Math.abs(Math.sqrt(dot(normal, normal)) - 32767) <= 1, 'a normal is no unit normal');
    return normal;
  }

  #add(point) {
    expect(point.x >= 0 && point.x < COORDINATE_END && point.y >= 0 && point.y < COORDINATE_END,
      'a coordinate is outside the chunk');
    return ADDED + this.#added.push(point) - 1;
  }

  // What sections of the base stood on goes, unless a section stands on it now.
  #readVertices() {
    const walled = new Uint8Array(this.#kept.length);
    for (const { start, end } of this.#base.sections) walled[start] = walled[end] = 1;
    this.#kept.forEach((kept, i) => { this.#kept[i] = kept | !walled[i]; });
    let next = 0;
    for (let left = this.#reader.varint(); left > 0; --left) {
      next += this.#reader.varint();
      expect(next < this.#kept.length, 'a vertex is listed that the base does not have');
      this.#kept[next++] ^= 1;
    }
    for (let left = this.#reader.varint(); left > 0; --left)
      this.#add({ x: this.#reader.varint(), y: this.#reader.varint() });
  }

  #putVertices() {
    const { points } = this.#base;
    const vertices = [...points.keys()].filter((i) => this.#kept[i])
      .concat([...this.#added.keys()].map((i) => ADDED + i));
    const outOfOrder = (at, i) => i > 0 && !precedes(points[i - 1], at);
    expect(!points.some(outOfOrder), 'the vertices of the base are out of order');
    vertices.sort((i, j) => (precedes(this.#point(i), this.#point(j)) ? -1 : 1));
    expect(vertices.length <= MAX_VERTICES, `${vertices.length} vertices are too many`);
    this.#numbers = new Map(vertices.map((vertex, number) => [vertex, number]));
    const sorted = vertices.map((vertex) => this.#point(vertex));
    expect(!sorted.some((at, i) => i > 0 && !precedes(sorted[i - 1], at)),
      'a vertex is there twice');
    return sorted;
  }

  #number(vertex) {
    const number = this.#numbers.get(vertex);
    expect(number !== undefined, 'a section stands on a vertex that is gone');
    return number;
  }

  #readTriangles(vertices, sections) {
    const reader = this.#reader;
    const triangles = new Triangles(vertices, sections);
    const count = reader.varint();
    expect(2 * vertices + 3 * count + sections.length <= MAX_LENGTH, 'the mesh is too large');
    let at = 0;
    const pass = (many, copy) => {
      for (let left = many; left > 0; at += 3) {
        expect(at < this.#base.indices.length, 'triangles are passed that the base does not have');
        const corners = Array.from(this.#base.indices.subarray(at, at + 3),
          (i) => this.#numbers.get(i));
        if (corners.includes(undefined)) continue;
        --left;
        if (copy) triangles.put(corners);
      }
    };
    while (triangles.count < count) {
      const head = reader.varint();
      expect(head > 0, 'a run of nothing');
      const [skipped, added] = [head >>> 2 & 3, head & 3]
        .map((few) => (few < 3 ? few : 3 + reader.varint()));
      expect(triangles.count + (head >>> 4) + added <= count, 'there are more triangles than said');
      pass(head >>> 4, true);
      pass(skipped, false);
      for (let i = 0; i < added; ++i) triangles.read(reader);
    }
    return triangles.indices;
  }
}

// The triangles so far, and the edges that wait for one on their left.
class Triangles {
  indices = [];
  #last = [0, 0, 0];
  #into;
  #out;

  constructor(vertices, sections) {
    this.#into = new Array(vertices);
    this.#out = new Array(vertices);
    for (const { start, end } of sections) this.#open(start, end);
  }

  get count() { return this.indices.length / 3; }

  read(reader) {
    const bits = reader.varint();
    const value = Math.floor(bits / 4);
    if (bits % 4 === 3) return this.put(this.#readCorners(reader, value));
    const v = Math.max(...this.#last) + unzigzag(value);
    if (bits % 4 === 0) return this.put([this.#into[this.#into[v]], this.#into[v], v]);
    const [first, second] = [this.#out[v], this.#out[this.#out[v]]];
    return this.put(bits % 4 === 1 ? [v, first, second] : [first, second, v]);
  }

  #readCorners(reader, codes) {
    expect(codes < 64, 'a triangle has no such corners');
    const corners = [];
    let value = this.#last[0];
    for (const shift of [0, 2, 4]) {
      const code = codes >> shift & 3;
      value = code === 3 ? value + reader.step() : this.#last[code];
      corners.push(value);
    }
    return corners;
  }

  put(corners) {
    const [a, b, c] = corners;
    expect(a !== b && b !== c && c !== a, 'a triangle has a vertex twice');
    expect(corners.every((i) => i >= 0 && i < this.#into.length), 'a triangle has no such vertex');
    const edges = [[a, b], [b, c], [c, a]];
    for (const [from, to] of edges.filter((edge) => !this.#close(...edge))) this.#open(to, from);
    this.indices.push(a, b, c);
    this.#last = corners;
  }

  #open(from, to) {
    this.#out[from] = to;
    this.#into[to] = from;
  }

  #close(from, to) {
    if (this.#out[from] !== to || this.#into[to] !== from) return false;
    this.#out[from] = this.#into[to] = undefined;
    return true;
  }
}

// The record that `delta` makes of `base`, the chunk's record of its base revision.
export function applyDelta(base, { layer, x, y, z, revision, baseRevision, operations }) {
  if (!base?.mesh || base.revision !== baseRevision) throw new BadFrame('a delta without its base');
  return { layer, x, y, z, revision, mesh: new Delta(base.mesh, operations).apply() };
}
