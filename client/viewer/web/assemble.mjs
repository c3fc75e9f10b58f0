// Puts the page together: assemble.mjs OUT FILE_OR_FOLDER...
//
// Each file is named by its content (style.css becomes style.<12 hex>.css), so a server may have it
// kept for ever; index.html alone keeps its name. References among the files are rewritten, and one
// that leads nowhere is refused. Beside each stands NAME.gz, made by zopfli where it is installed.
// The same input gives the same bytes. Modules (.mjs) become one file with all that they import, and
// they and style sheets lose what only people read: modules.mjs says how.
//
// A reference is relative, and one of: src and href in HTML and SVG, url() and @import in CSS,
// import and export ... from, import(), and new URL(..., import.meta.url) in JavaScript.
import { execFileSync } from "node:child_process";
import { createHash } from "node:crypto";
import { lstatSync, mkdirSync, readFileSync, readdirSync, renameSync, rmSync, writeFileSync }
  from "node:fs";
import { basename, dirname, extname, join, resolve } from "node:path";
import { argv, exit } from "node:process";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";

import { join as joinModules, stripStyle } from "./modules.mjs";

const ENTRY = "index.html";
const HASH_DIGITS = 12;
const LARGEST = 1 << 28; // bytes of a compressed file
const UNKNOWN_SYSTEM = 255; // byte 9 of a gzip file, else the system it was made on

const MARKUP = [/\b(?:src|href)=(["'])([^"']*)\1/g];
const SCRIPT = [
  /\bfrom\s*(["'])([^"'\n]*)\1/g,
  /\bimport\s*\(?\s*(["'])([^"'\n]*)\1/g,
  /\bnew URL\(\s*(["'])([^"'\n]*)\1\s*,\s*import\.meta\.url\s*\)/g,
];
const STYLE = [/\burl\(\s*(["']?)([^"')]*)\1\s*\)/g, /@import\s*(["'])([^"']*)\1/g];
const REFERENCES = {
  ".html": MARKUP, ".svg": MARKUP, ".css": STYLE, ".js": SCRIPT, ".mjs": SCRIPT,
};

// A path of the server, an address, a part of the same file: not among the files.
const leadsElsewhere = (reference) => /^(?:$|[a-z][a-z0-9+.-]*:|[/#?])/i.test(reference);

/** The files below the sources, name to bytes. A folder's files stand flat, each name once. */
function read(sources) {
  const files = new Map();
  const add = (path) => {
    const status = lstatSync(path);
    if (status.isDirectory()) {
      for (const name of readdirSync(path).sort()) add(join(path, name));
      return;
    }
    const name = basename(path);
    if (!status.isFile()) throw new Error(`${path} is no plain file`);
    if (files.has(name)) throw new Error(`there are two files named ${name}`);
    files.set(name, readFileSync(path));
  };
  sources.forEach(add);
  if (!files.has(ENTRY)) throw new Error(`there is no ${ENTRY}`);
  return files;
}

/** The files with the modules joined and the style sheets stripped; the parts: name to whole. */
function shorten(files) {
  const isModule = (name) => extname(name) === ".mjs";
  const modules = [...files].filter(([name]) => isModule(name))
    .map(([name, bytes]) => [name, bytes.toString("utf8")]);
  const short = new Map([...files].filter(([name]) => !isModule(name)));
  const { joined, parts } = joinModules(new Map(modules));
  for (const [name, text] of joined) short.set(name, Buffer.from(text));
  for (const [name, bytes] of short)
    if (extname(name) === ".css") short.set(name, Buffer.from(stripStyle(bytes.toString("utf8"))));
  return { files: short, parts };
}

function hashed(name, bytes) {
  if (name === ENTRY) return name;
  const extension = extname(name);
  const hash = createHash("sha256").update(bytes).digest("hex").slice(0, HASH_DIGITS);
  return `${basename(name, extension)}.${hash}${extension}`;
}

/** Name to {name, bytes}: what each file becomes. A file is named after all that it refers to. */
function rewrite({ files, parts }) {
  const done = new Map();
  const visit = (name, path) => {
    if (path.includes(name)) {
      throw new Error(`${[...path, name].join(" -> ")}: a circle of references has no hashes`);
    }
    if (done.has(name)) return done.get(name);
    let bytes = files.get(name);
    const patterns = REFERENCES[extname(name)];
    if (patterns) {
      let text = bytes.toString("utf8");
      for (const pattern of patterns) {
        text = text.replace(pattern, (all, quote, reference) => {
          if (leadsElsewhere(reference)) return all;
          const [, before, target, after] = /^((?:\.\/)?)([^#?]*)(.*)$/.exec(reference);
          if (!files.has(target)) {
            const whole = parts.get(target);
            const why = whole ? `: it is a part of ${whole}` : "";
            throw new Error(`${name} refers to ${reference}, which is not there${why}`);
          }
          const to = visit(target, [...path, name]).name;
          return all.replace(reference, () => before + to + after);
        });
      }
      bytes = Buffer.from(text);
    }
    done.set(name, { name: hashed(name, bytes), bytes });
    return done.get(name);
  };
  for (const name of files.keys()) visit(name, []);
  return done;
}

// The file as gzip: zopfli's is about a twentieth smaller than zlib's.
function compress(path) {
  let packed;
  try {
    packed = execFileSync("zopfli", ["-c", "--gzip", path],
      { maxBuffer: LARGEST, stdio: ["ignore", "pipe", "inherit"] });
  } catch (error) {
    if (error.code !== "ENOENT") throw error;
    packed = gzipSync(readFileSync(path), { level: 9 });
  }
  packed[9] = UNKNOWN_SYSTEM;
  return packed;
}

/** Replaces the folder OUT; gives back [{name, bytes, gzipped}], in order of the names. */
export function assemble(out, sources) {
  const files = rewrite(shorten(read(sources)));
  const fresh = `${resolve(out)}.new`;
  rmSync(fresh, { recursive: true, force: true });
  mkdirSync(fresh, { recursive: true });
  const table = [];
  for (const { name, bytes } of files.values()) {
    writeFileSync(join(fresh, name), bytes);
    const packed = compress(join(fresh, name));
    writeFileSync(join(fresh, `${name}.gz`), packed);
    table.push({ name, bytes: bytes.length, gzipped: packed.length });
  }
  mkdirSync(dirname(resolve(out)), { recursive: true });
  rmSync(out, { recursive: true, force: true });
  renameSync(fresh, out);
  return table.sort((a, b) => (a.name < b.name ? -1 : 1));
}

function print(table) {
  const line = (name, bytes, gzipped) =>
    console.log(`${name.padEnd(36)} ${String(bytes).padStart(9)} ${String(gzipped).padStart(9)}`);
  line("file", "bytes", "gzipped");
  for (const row of table) line(row.name, row.bytes, row.gzipped);
  const sum = (key) => table.reduce((total, row) => total + row[key], 0);
  line("all", sum("bytes"), sum("gzipped"));
}

if (argv[1] && resolve(argv[1]) === fileURLToPath(import.meta.url)) {
  const [out, ...sources] = argv.slice(2);
  if (sources.length === 0) {
    console.error("usage: assemble.mjs OUT FILE_OR_FOLDER...");
    exit(2);
  }
  try {
    print(assemble(out, sources));
  } catch (error) {
    console.error(`The page cannot be put together: ${error.message}`);
    exit(1);
  }
}
