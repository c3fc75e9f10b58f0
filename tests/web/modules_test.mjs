// How the page's modules are joined and shortened.
import assert from "node:assert/strict";
import { test } from "node:test";

import { join, print, stripStyle, tokens } from "../../client/viewer/web/modules.mjs";

const strip = (text) => print(tokens(text));
const joined = (modules) => Object.fromEntries(join(new Map(Object.entries(modules))).joined);
// What a joined module, which exports nothing, pushes to `said`.
const run = async (text) => {
  const said = [];
  await Object.getPrototypeOf(async () => {}).constructor("said", text)(said);
  return said;
};

test("comments, indentation and needless spaces go, lines stay", () => {
  assert.equal(strip("// Words.\n  a = b + c;  /* more */ d ( e ) ;\n\n\n  f\n  g\n"),
    "a=b+c;d(e);\nf\ng");
  assert.equal(strip("a /* one\ntwo */ b"), "a\nb");
});

test("what would become something else keeps its space", () => {
  for (const text of ["return a", "a+ +b", "a- --b", "5 .toFixed()", "a in b", "typeof a",
    "/a/ in b", "a/ /b/", "class A extends B{}", "async function f(){}"])
    assert.equal(strip(text), text);
});

test("strings, templates and regular expressions stay to the last space", () => {
  for (const text of ["'a  // b'", '"a \\"  b"', "`a  // ${b+`  ${c}  /*`}  d`", "`\\`  ${{a:1}.a}`",
    "/[/\"']  \\/ /g.test(a)", "f(/  '/)", "a=>/  \"/u", "`${/  `/.exec(a)}  `", "return /  '/",
    "'a\\\n  b'"])
    assert.equal(strip(text), text.replace("return /", "return/"));
});

test("a slash divides after a value", () => {
  assert.equal(strip("(a + b) / c / 'd  e'"), "(a+b)/c/'d  e'");
  assert.equal(strip("a[0] / 2 + b.of / c / 1"), "a[0]/2+b.of/c/1");
  assert.equal(strip("`a` / 2 / 3"), "`a`/2/3");
});

test("a script that is not known is refused with its line", () => {
  const refused = (text, words) => assert.throws(() => strip(text), { message: words });
  refused("a\n'b\n'", /line 2: .* is not known/);
  refused("{}\n/a/", /line 2: a slash after }/);
  refused("if (a) /b/.test(c)", /line 1: a slash after the head/);
  refused("`a ${b}", /a template has no end/);
  refused("f((1)", /brackets do not match/);
  refused("const a = \\u0061", /is not known/);
});

test("a style sheet keeps what it says", () => {
  assert.equal(stripStyle("/* Words; { */\na :hover,\n  b > c {\n  color : red ;\n" +
    "  content: '  /* ; } */';\n  background: url(a;b.svg);\n}\n\n@media (width < 1px) { d { e: f } }\n"),
  "a :hover, b > c{color : red;content: '  /* ; } */';background: url(a;b.svg)}\n" +
    "@media (width < 1px){d{e: f}\n}\n");
  assert.equal(stripStyle("a/**/b { margin: 0 /* none */ 1px }"), "a b{margin: 0 1px}\n");
  assert.equal(stripStyle("a { content: ';}' }"), "a{content: ';}'}\n");
});

test("joined modules do what they did apart", async () => {
  const page = joined({
    "main.mjs": "import { A, both } from './b.mjs';\nimport { name } from './a.mjs';\n" +
      "import './said.mjs';\nconst own = 'main'; said.push(await both(), name, new A().own, own);\n",
    "b.mjs": "import { name } from './a.mjs';\nconst own = 'b';\n" +
      "export async function both() { return `${own} ${name}`; }\n" +
      "export class A { own = own; }\nsaid.push('b');\n",
    "a.mjs": "const own = 'a';\nexport const name = own;\nsaid.push('a');",
    "said.mjs": "said.push('said');",
  });
  assert.deepEqual(Object.keys(page), ["main.mjs"]);
  assert.deepEqual(await run(page["main.mjs"]), ["a", "b", "said", "b a", "a", "b", "main"]);
});

test("functions keep their names and lines", async () => {
  const page = joined({ "main.mjs": "import { fails } from './a.mjs';\nfails();\n",
    "a.mjs": "export function fails() {\n  // Why.\n  throw new Error('x');\n}\n" });
  assert.match(page["main.mjs"], /\nfunction fails\(\)\{\nthrow new Error\('x'\);\n\}\n/);
  await assert.rejects(run(page["main.mjs"]), (error) => /at fails /.test(error.stack));
});

test("members and strings called like imports are none", () => {
  const text = "const a={import:1,export:2};\na.import=a?.export;\nconst b='import c from \"d\"';\n" +
    "import('./x.js');import.meta.url;";
  assert.equal(joined({ "main.mjs": text })["main.mjs"], `${text}\n`);
});

test("imports and exports that are not known are refused by name", () => {
  const refused = (text, words, other = "export const a = 1;") =>
    assert.throws(() => joined({ "main.mjs": text, "a.mjs": other }), { message: words });
  refused("import a from './a.mjs';", /^main\.mjs: an import that is not known/);
  refused("import * as a from './a.mjs';", /main\.mjs: an import that is not known/);
  refused("import { a as b } from './a.mjs';", /main\.mjs: an import that is not known/);
  refused("import { a } from './a.js';", /main\.mjs: an import that is not known/);
  refused("import { a } from 'a.mjs';", /main\.mjs: an import that is not known/);
  refused("import { a } from './a.mjs'\n", /main\.mjs: an import without a semicolon/);
  refused("if (1) { import './a.mjs'; }", /main\.mjs: .* inside of something/);
  refused("import { a, b } from './a.mjs';", /main\.mjs imports b, which a\.mjs does not export/);
  refused("import { a } from './c.mjs';", /main\.mjs refers to \.\/c\.mjs, which is not there/);
  for (const text of ["export default 1;", "export let a = 1;", "export { a };", "export * from 'b';",
    "export function* a() {}", "export const { a } = b;"])
    refused("import { a } from './a.mjs';", /a\.mjs: an export that is not known/, text);
  refused("import './a.mjs';", /a\.mjs awaits, and is imported/, "await 1;");
  refused("import './a.mjs';", /a\.mjs: \$from_b: is taken/, "$from_b;");
  refused("import './a.mjs';", /main\.mjs -> a\.mjs -> main\.mjs: a circle/, "import './main.mjs';");
  refused("import './a.mjs';", /a\.mjs: line 2: .* is not known/, "\n'");
});

test("a module that two files would hold is refused", () => {
  assert.throws(() => joined({ "one.mjs": "import './a.mjs';", "two.mjs": "import './a.mjs';",
    "a.mjs": "" }), { message: /a\.mjs would be there twice: in one\.mjs and in two\.mjs/ });
  assert.throws(() => joined({ "m.mjs": "import './a-b.mjs';import './a_b.mjs';", "a-b.mjs": "",
    "a_b.mjs": "" }), { message: /a_b\.mjs has the name of another module/ });
});
