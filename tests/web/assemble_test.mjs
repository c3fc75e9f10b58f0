// How the page is put together, on small pages made here.
import assert from "node:assert/strict";
import { mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { afterEach, beforeEach, test } from "node:test";
import { gunzipSync } from "node:zlib";

import { assemble } from "../../client/viewer/web/assemble.mjs";

let scratch;
beforeEach(() => {
  scratch = mkdtempSync(join(tmpdir(), "earthwork-assemble-"));
});
afterEach(() => rmSync(scratch, { recursive: true }));

const PAGE = {
  "index.html": '<link href="style.css"><a href="/api">x</a><use href="#mark"/>' +
    '<script type=module src="./main.mjs"></script><a href="https://example.org">y</a>',
  "style.css": "a { background: url(mark.svg) } b { background: url('data:x') }",
  "mark.svg": "<svg/>",
  "main.mjs": 'import { a } from "./a.mjs";\n' +
    'const m = await import("./viewer.js"); const other = "./not-a-file.txt";',
  "a.mjs": "export const a = 1;",
  "viewer.js": 'const at = new URL("viewer.wasm", import.meta.url);',
  "viewer.wasm": "\0asm",
};
// a.mjs becomes a part of main.mjs.
const ASSEMBLED = Object.keys(PAGE).filter((name) => name !== "a.mjs");

// Writes the files and assembles them; gives back {name as it was: {name, text}}.
function assembled(files, out = "out") {
  const source = join(scratch, "source");
  rmSync(source, { recursive: true, force: true });
  mkdirSync(source);
  for (const [name, text] of Object.entries(files)) writeFileSync(join(source, name), text);
  assemble(join(scratch, out), [source]);
  const result = {};
  for (const name of readdirSync(join(scratch, out))) {
    if (name.endsWith(".gz")) continue;
    const plain = name.replace(/\.[0-9a-f]{12}(\.[a-z]+)$/, "$1");
    result[plain] = { name, text: readFileSync(join(scratch, out, name), "utf8") };
  }
  return result;
}

test("every file but index.html is named by its content", () => {
  const page = assembled(PAGE);
  assert.deepEqual(Object.keys(page).sort(), [...ASSEMBLED].sort());
  assert.equal(page["index.html"].name, "index.html");
  for (const name of ASSEMBLED.filter((each) => each !== "index.html"))
    assert.match(page[name].name, /^[a-z]+\.[0-9a-f]{12}\.[a-z]+$/);
});

test("references lead to the new names, all others stay", () => {
  const page = assembled(PAGE);
  const name = (plain) => page[plain].name;
  assert.equal(page["index.html"].text,
    `<link href="${name("style.css")}"><a href="/api">x</a><use href="#mark"/>` +
    `<script type=module src="./${name("main.mjs")}"></script>` +
    '<a href="https://example.org">y</a>');
  assert.equal(page["style.css"].text,
    `a{background: url(${name("mark.svg")})}\nb{background: url('data:x')}\n`);
  assert.equal(page["main.mjs"].text,
    "const $from_a=(()=>{\nconst a=1;\nreturn{a};\n})();\nconst{a}=$from_a;\n" +
    `const m=await import("./${name("viewer.js")}");const other="./not-a-file.txt";\n`);
  assert.equal(page["viewer.js"].text,
    `const at = new URL("${name("viewer.wasm")}", import.meta.url);`);
});

test("a change renames the file and all that lead to it, and nothing else", () => {
  const before = assembled(PAGE);
  const after = assembled({ ...PAGE, "a.mjs": "export const a = 2;" });
  const renamed = ASSEMBLED.filter((name) => before[name].name !== after[name].name);
  assert.deepEqual(renamed, ["main.mjs"]);
  assert.notEqual(before["index.html"].text, after["index.html"].text);
});

test("a query and a fragment stay with a reference", () => {
  const page = assembled({ "index.html": '<use href="mark.svg?a=1#b"/>', "mark.svg": "<svg/>" });
  assert.equal(page["index.html"].text, `<use href="${page["mark.svg"].name}?a=1#b"/>`);
});

test("beside each file stands the same one compressed", () => {
  const page = assembled(PAGE);
  for (const { name, text } of Object.values(page))
    assert.equal(gunzipSync(readFileSync(join(scratch, "out", `${name}.gz`))).toString(), text);
});

test("without zopfli zlib compresses", (context) => {
  const path = process.env.PATH;
  context.after(() => { process.env.PATH = path; });
  process.env.PATH = scratch;
  const page = assembled(PAGE);
  for (const { name, text } of Object.values(page))
    assert.equal(gunzipSync(readFileSync(join(scratch, "out", `${name}.gz`))).toString(), text);
});

test("the same input gives the same bytes", () => {
  assembled(PAGE, "one");
  assembled(PAGE, "two");
  const names = readdirSync(join(scratch, "one"));
  assert.equal(names.length, 2 * ASSEMBLED.length);
  assert.deepEqual(names, readdirSync(join(scratch, "two")));
  for (const name of names)
    assert.deepEqual(readFileSync(join(scratch, "one", name)),
      readFileSync(join(scratch, "two", name)));
  const packed = readFileSync(join(scratch, "one", "index.html.gz"));
  assert.deepEqual([...packed.subarray(4, 8)], [0, 0, 0, 0], "no time");
  assert.equal(packed[9], 255, "no system");
});

test("what was there before is gone", () => {
  assembled(PAGE);
  assert.deepEqual(Object.keys(assembled({ "index.html": "x" })), ["index.html"]);
});

test("what cannot be put together is refused by name", () => {
  const refused = (files, words) => assert.throws(() => assembled(files), { message: words });
  refused({ ...PAGE, "main.mjs": 'import "./b.mjs";' }, /main\.mjs refers to \.\/b\.mjs/);
  refused({ ...PAGE, "style.css": "@import 'more.css';" }, /style\.css refers to more\.css/);
  refused({ ...PAGE, "index.html": '<img src="no.png">' }, /index\.html refers to no\.png/);
  refused({ ...PAGE, "a.mjs": 'import "./main.mjs"; export const a = 1;' },
    /a\.mjs -> main\.mjs -> a\.mjs: a circle/);
  refused({ ...PAGE, "viewer.js": 'import("./main.mjs"); new URL("main.mjs", import.meta.url)' },
    /main\.mjs -> viewer\.js -> main\.mjs: a circle/);
  refused({ ...PAGE, "index.html": '<script type="module" src="a.mjs">' },
    /index\.html refers to a\.mjs, which is not there: it is a part of main\.mjs/);
  refused({ "a.mjs": "" }, /no index\.html/);
});

test("a page that is refused leaves the one before", () => {
  assembled(PAGE);
  assert.throws(() => assembled({ "index.html": '<img src="no.png">' }));
  assert.equal(readdirSync(join(scratch, "out")).length, 2 * ASSEMBLED.length);
});
