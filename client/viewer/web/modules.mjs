// Joins the page's modules to one file, and leaves out what only people read. Strict: of imports
// and exports the plain forms alone are known, and whatever else is met is refused.
//
//   import { a, b } from './other.mjs';    import './other.mjs';
//   export const a = ...   export function a   export async function a   export class A
//
// Each module becomes a function that is called once and gives back what it exports, so that its
// names stay its own; the one that nobody imports stands last and plain (it may await). Lines and
// names stay as they were written: a stack trace still says what it is about.

const WORD = /[\p{ID_Start}$_#][\p{ID_Continue}$\u200c\u200d]*/uy;
const NUMBER = /\.?\d(?:[eE][+-]|[\w.])*/y;
const PUNCTUATION = new RegExp([
  />>>=|\.\.\.|===|!==|\*\*=|<<=|>>=|>>>|&&=|\|\|=|\?\?=|=>|==|!=|<=|>=|&&|\|\||\?\?|\?\.(?!\d)/,
  /\+\+|--|\+=|-=|\*=|\/=|%=|&=|\|=|\^=|<<|>>|\*\*|[{}()[\];,<>+\-*/%&|^!~?:=.@]/,
].map((part) => part.source).join("|"), "y");
const STRING = /(["'])(?:\\[^]|(?!\1)[^\\\n])*\1/y;
const REGEX = /\/(?:\\.|\[(?:\\.|[^\]\\\n])*\]|[^/\\[\n])+\/[a-z]*/y;
const SPACE = /(?:\s|\/\/[^\n]*|\/\*[^]*?\*\/)+/y;
const TEMPLATE_TEXT = /(?:\\[^]|\$(?!\{)|[^\\`$])*/y;

// After these a slash begins a regular expression, though they look like names.
const BEFORE_VALUE = new Set(["return", "typeof", "case", "in", "of", "do", "else", "void", "throw",
  "new", "delete", "await", "yield", "instanceof", "default"]);

const HEADS = new Set(["if", "while", "for", "with"]);

const isMark = (token, text) => token?.kind === "mark" && token.text === text;
const isWord = (token, text) => token?.kind === "word" && token.text === text;
// Whether the token at that place names a member: what a.import and a?.import name.
const isMember = (list, at) => isMark(list[at - 1], ".") || isMark(list[at - 1], "?.");

/** The tokens of a script: {kind, text, space}; space is what stood before: "", " " or "\n". */
export function tokens(text) {
  const found = [];
  const templates = []; // the depth of braces at which each open template goes on
  const heads = []; // of each open parenthesis, whether it is the head of an if or a loop
  let depth = 0;
  let at = 0;
  let space = "";
  const refuse = (why) => {
    throw new Error(`line ${text.slice(0, at).split("\n").length}: ${why}`);
  };
  const match = (pattern) => {
    pattern.lastIndex = at;
    return pattern.exec(text)?.[0];
  };
  const put = (kind, length) => {
    found.push({ kind, text: text.slice(at, at + length), space, depth });
    at += length;
    space = "";
  };
  const templateText = () => {
    const start = at++;
    at += match(TEMPLATE_TEXT).length;
    const ends = text[at] === "`" ? 1 : 2;
    if (at >= text.length) refuse("a template has no end");
    if (ends === 2) templates.push(depth);
    const length = at + ends - start;
    at = start;
    put("template", length);
  };
  // Whether the last token is one of these words, and no member called like one.
  const isOneOf = (words) => words.has(found.at(-1)?.text) && !isMember(found, found.length - 1);
  // Whether a value may begin here, and with it a regular expression.
  const valueMayBegin = () => {
    const last = found.at(-1);
    if (!last) return true;
    if (last.kind === "template") return last.text.endsWith("${");
    if (last.kind === "word") return isOneOf(BEFORE_VALUE);
    if (last.kind !== "mark") return false;
    if (last.text === "}") refuse("a slash after } is not known");
    if (last.text === ")" && last.isHead) refuse("a slash after the head is not known");
    return ![")", "]", "++", "--"].includes(last.text);
  };
  const slash = () => {
    if (!valueMayBegin()) put("mark", match(PUNCTUATION).length);
    else put("regex", (match(REGEX) ?? refuse("a regular expression has no end")).length);
  };
  const mark = (whole) => {
    if (/^[})\]]$/.test(whole)) --depth;
    const isHead = whole === "(" ? isOneOf(HEADS) : whole === ")" && heads.pop();
    if (whole === "(") heads.push(isHead);
    put("mark", whole.length);
    found.at(-1).isHead = isHead;
    if (/^[{([]$/.test(whole)) ++depth;
  };
  while (at < text.length) {
    const blank = match(SPACE);
    if (blank) {
      space = blank.includes("\n") ? "\n" : " ";
      at += blank.length;
      continue;
    }
    const c = text[at];
    let whole;
    if (c === "`") templateText();
    else if (c === "}" && templates.length > 0 && templates.at(-1) === depth) {
      templates.pop();
      templateText();
    } else if (c === "/") slash();
    else if ((whole = match(STRING))) put("string", whole.length);
    else if ((whole = match(WORD))) put("word", whole.length);
    else if ((whole = match(NUMBER))) put("number", whole.length);
    else if ((whole = match(PUNCTUATION))) mark(whole);
    else refuse(`${JSON.stringify(c)} is not known`);
  }
  if (depth !== 0 || templates.length > 0) refuse("brackets do not match");
  return found;
}

// Whether two tokens would become another one without a space between them.
function clings(before, after) {
  const isName = (token) => token.kind === "word" || token.kind === "number";
  if (isName(before) && (isName(after) || after.text[0] === ".")) return true;
  if (before.kind === "regex" && isName(after)) return true;
  return /^[+\-/<]/.test(after.text) && /[+\-/<]$/.test(before.text);
}

/** The tokens as text: each line where it was, without comments and needless spaces. */
export function print(list) {
  let out = "";
  list.forEach((token, i) => {
    const before = list[i - 1];
    if (before && (token.space === "\n" || (token.space && clings(before, token))))
      out += token.space;
    out += token.text;
  });
  return out;
}

const STYLE_PIECE = (() => {
  const string = /(?<quote>["'])(?:\\[^]|(?!\k<quote>)[^\\\n])*\k<quote>|url\([^"')]*\)/.source;
  const space = /(?:\s|\/\*[^]*?\*\/)/.source;
  const end = `${space}*;?${space}*\\}${space}*`;
  const mark = `${space}*(?<mark>[{;])${space}*`;
  return new RegExp(`(?<kept>${string})|(?<end>${end})|${mark}|${space}+`, "g");
})();

/** A style sheet without comments, indentation and spaces at braces and ends. */
export const stripStyle = (text) => `${text.replace(STYLE_PIECE, (...found) => {
  const { kept, end, mark } = found.at(-1);
  return kept ?? (end ? "}\n" : mark ?? " ");
}).trim()}\n`;

/** {imports: [{name, names}], exports, body}: a module taken apart. */
function parse(name, text) {
  const refuse = (why) => {
    throw new Error(`${name}: ${why}`);
  };
  let list;
  try {
    list = tokens(text);
  } catch (error) {
    refuse(error.message);
  }
  const imports = [];
  const exports = [];
  const body = [];
  let at = 0;

  const names = () => {
    const found = [];
    for (++at; !isMark(list[at], "}"); ++at) {
      if (list[at]?.kind !== "word") refuse("an import that is not known");
      found.push(list[at++].text);
      if (isMark(list[at], "}")) break;
      if (!isMark(list[at], ",")) refuse("an import that is not known");
    }
    if (!isWord(list[++at], "from")) refuse("an import that is not known");
    ++at;
    return found;
  };
  const takeImport = () => {
    ++at;
    const found = isMark(list[at], "{") ? names() : [];
    const from = /^["']\.\/([^"'\\/?#]+\.mjs)["']$/.exec(list[at]?.text)?.[1];
    if (!from)
      refuse(`an import that is not known: import { a, b } from "./other.mjs"; is`);
    if (!isMark(list[++at], ";")) refuse("an import without a semicolon");
    ++at;
    imports.push({ name: from, names: found });
  };
  const takeExport = () => {
    const space = list[at++].space;
    const async = isWord(list[at], "async") && isWord(list[at + 1], "function") ? 1 : 0;
    const [what, called, next] = list.slice(at + async, at + async + 3);
    const isConst = isWord(what, "const") && isMark(next, "=");
    if (called?.kind !== "word" || !(isConst || isWord(what, "function") || isWord(what, "class")))
      refuse("an export that is not known: of a const, a function or a class only");
    exports.push(called.text);
    body.push({ ...list[at++], space });
  };

  while (at < list.length) {
    const token = list[at];
    const isPart = isMember(list, at) || isMark(list[at + 1], ":");
    if (token.kind === "word" && token.text.startsWith("$from_")) refuse(`${token.text}: is taken`);
    if (isWord(token, "export") && !isPart) {
      if (token.depth !== 0) refuse("an export that is not known: inside of something");
      takeExport();
    } else if (isWord(token, "import") && !isPart && !isMark(list[at + 1], "(")
        && !isMark(list[at + 1], ".")) {
      if (token.depth !== 0) refuse("an import that is not known: inside of something");
      takeImport();
    } else {
      body.push(token);
      ++at;
    }
  }
  return { imports, exports, body };
}

// The name that a module's exports have in the joined file.
const variable = (name) => `$from_${name.slice(0, -".mjs".length).replace(/[^\w]/g, "_")}`;

/**
 * The modules (name to text) joined: {joined, parts}, name to text of each that nobody imports, and
 * name to name of it for each that is in it.
 */
export function join(modules) {
  const parsed = new Map();
  for (const [name, text] of modules) parsed.set(name, parse(name, text));

  const owner = new Map(); // of each: the entry it is in
  const needs = (name, path, order) => {
    if (path.includes(name))
      throw new Error(`${[...path, name].join(" -> ")}: a circle of imports`);
    if (order.includes(name)) return order;
    for (const { name: from, names } of parsed.get(name).imports) {
      if (!parsed.has(from)) throw new Error(`${name} refers to ./${from}, which is not there`);
      const missing = names.find((each) => !parsed.get(from).exports.includes(each));
      if (missing) throw new Error(`${name} imports ${missing}, which ${from} does not export`);
      needs(from, [...path, name], order);
    }
    order.push(name);
    return order;
  };
  const orders = new Map([...modules.keys()].map((name) => [name, needs(name, [], [])]));
  const imported = new Set([...parsed.values()].flatMap((each) => each.imports.map((i) => i.name)));

  const joined = new Map();
  for (const [entry, order] of orders) {
    if (imported.has(entry)) continue;
    const variables = new Set();
    const parts = order.map((name) => {
      if (owner.has(name))
        throw new Error(`${name} would be there twice: in ${owner.get(name)} and in ${entry}`);
      owner.set(name, entry);
      const { imports, exports, body } = parsed.get(name);
      const lines = imports.filter((each) => each.names.length > 0)
        .map((each) => `const{${each.names.join(",")}}=${variable(each.name)};\n`).join("");
      if (name !== entry && body.some((each) => isWord(each, "await") && each.depth === 0))
        throw new Error(`${name} awaits, and is imported`);
      const code = `${lines}${print(body)}\n`;
      if (name === entry) return code;
      if (variables.has(variable(name))) throw new Error(`${name} has the name of another module`);
      variables.add(variable(name));
      return `const ${variable(name)}=(()=>{\n${code}return{${exports.join(",")}};\n})();\n`;
    });
    joined.set(entry, parts.join(""));
  }
  return { joined, parts: owner };
}
