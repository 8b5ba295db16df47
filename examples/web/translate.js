/* translate.js - contact laws in C, translated to JavaScript. MIT licence.

   const header = translate(text of dem.h's public part, { calls });              // once
   const law = translate(text of my_law.h, { header, files, data });              // at every change
   law.error          null, or { line, column, text }: the first thing that is not C, or not in this subset
   law.code           JavaScript: `new Function(law.code)()(memory, stop, calls)` gives { init, call }
   law.LAW            where the row LAW stands in memory, or 0

   Structs, arrays and variables whose address is taken live in the memory of the WebAssembly module, laid out as C lays
   them out there; other variables are variables of JavaScript. So a law reads dem_contact where dem.h wrote it, and a
   pointer is a number. Arithmetic in double precision gives the bits of C; functions of math.h may differ in the last one.

   In the subset: all of C99 but goto, unions' and bit fields, arrays of variable length, integers of 64 bits, functions with
   "..." and the C library beyond math.h. Every loop and every call counts, so that a law that does not end is stopped;
   every store outside the law's own data, its memory and its force is stopped too. */
'use strict';
const translate = (() => {

// ---- words ----
const KEYWORDS = new Set(('auto break case char const continue default do double else enum extern float for goto if inline int ' +
  'long register restrict return short signed sizeof static struct switch typedef union unsigned void volatile while').split(' '));
const WORD = /[A-Za-z_]\w*/y, SPACE = /(?:[ \t\f\r]|\\\r?\n)+/y, CHAR = /'(?:[^'\\\n]|\\.)+'/y, STRING = /"(?:[^"\\\n]|\\.)*"/y;
const NUMBER = /(?:0[xX][\da-fA-F]+|(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)[fFlLuU]*/y;
const SIGN = /\.\.\.|<<=|>>=|->|\+\+|--|<<|>>|[<>=!]=|&&|\|\||[-+*/%&|^]=|[-+*/%=<>!~&|^?:;,.(){}[\]#]/y;
const ESCAPES = { n: 10, t: 9, r: 13, 0: 0, a: 7, b: 8, f: 12, v: 11 };

class Fault extends Error {
  constructor(at, text) { super(text); this.at = at; }
}
const fail = (at, text) => { throw new Fault(at, text); };

/* Splits a text into words: { kind: word number string sign end, text, line, column, first: begins its line }. */
function words(text, file) {
  const list = [];
  let at = 0, line = 1, start = 0, first = true;
  const take = pattern => { pattern.lastIndex = at; const found = pattern.exec(text); return found && found[0]; };
  const lines = part => { for (let k = 0; k < part.length; k++) if (part[k] === '\n') { line++; start = at + k + 1; } };
  for (;;) {
    const gap = take(SPACE);
    if (gap) { lines(gap); at += gap.length; continue; }
    if (at >= text.length) break;
    const here = { kind: 'sign', text: text[at], line, column: at - start + 1, first, file };
    if (text[at] === '\n') { at++; line++; start = at; first = true; continue; }
    if (text.startsWith('//', at)) { while (at < text.length && text[at] !== '\n') at++; continue; }
    if (text.startsWith('/*', at)) {
      const end = text.indexOf('*/', at + 2);
      if (end < 0) fail(here, 'this comment has no end: */');
      const part = text.slice(at, end + 2);
      lines(part); at += part.length;
      continue;
    }
    let part = take(WORD);
    if (part) here.kind = 'word';
    else if ((part = take(NUMBER))) here.kind = 'number';
    else if ((part = take(STRING))) here.kind = 'string';
    else if ((part = take(CHAR))) here.kind = 'number';
    else if (!(part = take(SIGN)))
      fail(here, text[at] === '"' || text[at] === "'" ? 'this text has no closing quote' : `"${text[at]}" is no sign of C`);
    here.text = part;
    at += part.length;
    first = false;
    list.push(here);
  }
  list.push({ kind: 'end', text: 'the end', line, column: at - start + 1, first: true, file });
  return list;
}

/* Carries out the lines that begin with #, and replaces macros. files: { "name.h": text } for #include. */
function preprocess(text, file, macros, files, out = [], depth = 0) {
  const list = words(text, file), open = [];                             // open: #if ... that are not closed
  const skipping = () => open.some(part => !part.on);
  let i = 0;
  const rest = () => { const part = []; while (!list[i].first) part.push(list[i++]); return part; };
  while (list[i].kind !== 'end') {
    const word = list[i];
    if (word.text === '#' && word.first) {
      i++;
      const what = list[i].first ? { text: '' } : list[i++], part = rest(), name = part[0]?.text;
      if (what.text === 'ifdef' || what.text === 'ifndef')
        open.push({ at: word, on: macros.has(name) === (what.text === 'ifdef') });
      else if (what.text === 'if') open.push({ at: word, on: skipping() ? false : holds(word, part, macros, depth) });
      else if (what.text === 'else' || what.text === 'endif') {
        if (!open.length) fail(word, `#${what.text} without #ifdef`);
        if (what.text === 'else') open.at(-1).on = !open.at(-1).on; else open.pop();
      } else if (skipping()) continue;
      else if (what.text === 'define') {
        if (!name) fail(word, '#define needs a name');
        const macro = { body: part.slice(1), arguments: null };
        if (part[1]?.text === '(' && part[1].column === part[0].column + name.length) {
          const end = part.findIndex(p => p.text === ')');
          if (end < 0) fail(word, 'the arguments of this macro have no closing )');
          macro.arguments = part.slice(2, end).filter(p => p.text !== ',').map(p => p.text);
          macro.body = part.slice(end + 1);
        }
        macros.set(name, macro);
      } else if (what.text === 'undef') macros.delete(name);
      else if (what.text === 'include') {
        const named = part.map(p => p.text).join('').replace(/^["<]|[">]$/g, '');
        const base = named.replace(/.*\//, '');
        if (files[base] !== undefined && depth < 20) out.push(...preprocess(files[base], base, macros, files, [], depth + 1).slice(0, -1));
        else if (!/^(dem|math|stdint|stddef|float|string|stdlib|stdio)\.h$/.test(base))
          fail(word, `"${named}" is not here: the lab has dem.h, math.h and ${Object.keys(files).join(', ') || 'no other file'}`);
      } else if (what.text === 'error') fail(word, '#error ' + part.map(p => p.text).join(' '));
      else if (what.text && what.text !== 'pragma' && what.text !== 'line')
        fail(word, `#${what.text} is not understood here`);
    } else if (skipping()) i++;
    else i = expand(list, i, macros, out, []);
  }
  if (open.length) fail(open.at(-1).at, 'this line has no #endif');
  out.push(list[i]);
  return out;
}
/* Whether the condition of #if holds. */
function holds(word, part, macros, depth) {
  const known = [], out = [];
  for (let k = 0; k < part.length; k++) {
    if (part[k].text !== 'defined') { known.push(part[k]); continue; }
    const open = part[k + 1]?.text === '(', name = part[k + (open ? 2 : 1)];
    known.push({ ...part[k], kind: 'number', text: String(+macros.has(name?.text)) });
    k += open ? 3 : 1;
  }
  const level = { kind: 'number', text: String(depth + 1), line: word.line, column: word.column };
  for (let k = 0; k < known.length;) k = expand(known, k, new Map([...macros, ['__INCLUDE_LEVEL__', { body: [level], arguments: null }]]), out, []);
  const text = out.map(w => w.kind === 'word' ? '0' : w.text.replace(/[uUlL]+$/, '')).join(' ');
  try {
    if (!/^[-\d\sxXa-fA-F()!~<>=&|+*/%^?:]+$/.test(text)) throw 0;
    return !!new Function(`return (${text});`)();
  } catch { fail(word, 'this condition of #if cannot be computed: it has integers, defined and operators only'); }
}
/* Puts word i of a list, with its macro replaced, into out; returns the index of the next word. */
function expand(list, i, macros, out, within) {
  const word = list[i], macro = word.kind === 'word' && !within.includes(word.text) && macros.get(word.text);
  if (!macro) { out.push(word); return i + 1; }
  let body = macro.body, next = i + 1;
  if (macro.arguments) {
    if (list[next]?.text !== '(') { out.push(word); return next; }
    const given = [[]];
    let depth = 1;
    for (next++; ; next++) {
      const part = list[next];
      if (!part || part.kind === 'end') fail(word, `${word.text}( has no closing )`);
      if (part.text === '(') depth++;
      if (part.text === ')' && --depth === 0) { next++; break; }
      if (part.text === ',' && depth === 1) given.push([]); else given.at(-1).push(part);
    }
    if (given.length !== Math.max(1, macro.arguments.length))
      fail(word, `the macro ${word.text} has ${macro.arguments.length} arguments, not ${given.length}`);
    body = body.flatMap(p => macro.arguments.includes(p.text) ? given[macro.arguments.indexOf(p.text)] : [p]);
  }
  body = body.map(p => ({ ...p, line: word.line, column: word.column, file: word.file }));
  for (let k = 0; k < body.length;) k = expand(body, k, macros, out, [...within, word.text]);
  return next;
}

// ---- types ----
const number = (name, size, array, rank) => ({ kind: 'number', name, size, align: size, array, shift: Math.log2(size), rank });
const VOID = { kind: 'void', name: 'void', size: 1, align: 1 };
const DOUBLE = number('double', 8, 'F64', 9), FLOAT = number('float', 4, 'F32', 8);
const INT = number('int', 4, 'I32', 3), UNSIGNED = number('unsigned', 4, 'U32', 4);
const CHAR1 = number('char', 1, 'I8', 1), UCHAR = number('unsigned char', 1, 'U8', 1);
const SHORT = number('short', 2, 'I16', 2), USHORT = number('unsigned short', 2, 'U16', 2);
const WIDE = number('64-bit integer', 8, null, 5);
const NAMED = { int8_t: CHAR1, uint8_t: UCHAR, int16_t: SHORT, uint16_t: USHORT, int32_t: INT, uint32_t: UNSIGNED, int64_t: WIDE,
  uint64_t: WIDE, size_t: UNSIGNED, ptrdiff_t: INT, intptr_t: INT, uintptr_t: UNSIGNED };
const SPELLED = { 'void': VOID, 'double': DOUBLE, 'double long': DOUBLE, 'float': FLOAT, 'char': CHAR1, 'char signed': CHAR1,
  'char unsigned': UCHAR, 'short': SHORT, 'int short': SHORT, 'short unsigned': USHORT, 'int short unsigned': USHORT, 'int': INT,
  'signed': INT, 'int signed': INT, 'unsigned': UNSIGNED, 'int unsigned': UNSIGNED, 'long': INT, 'int long': INT,
  'long unsigned': UNSIGNED, 'int long unsigned': UNSIGNED, 'long long': WIDE, 'int long long': WIDE, 'long long unsigned': WIDE,
  'int long long unsigned': WIDE };
const pointer = to => ({ kind: 'pointer', to, size: 4, align: 4, array: 'I32', shift: 2 });
const array = (of, count) => ({ kind: 'array', of, count, size: of.size*count, align: of.align });
const isReal = t => t === DOUBLE || t === FLOAT || (t.kind === 'number' && t.rank > 7);
const isInteger = t => t.kind === 'number' && t.rank < 8;
const isNumber = t => t.kind === 'number';
const plain = t => t.constant ? { ...t, constant: false } : t;
const aligned = (n, align) => Math.ceil(n/align)*align;
function same(a, b) {
  if (a.kind !== b.kind) return false;
  if (a.kind === 'number') return a.name === b.name;
  if (a.kind === 'pointer') return same(a.to, b.to);
  if (a.kind === 'array') return same(a.of, b.of);
  if (a.kind === 'struct') return a.body === b.body;
  return true;
}
function spell(t) {
  const name = t.kind === 'pointer' ? `${spell(t.to)}${t.to.kind === 'pointer' ? '' : ' '}*` : t.kind === 'array' ?
    `array of ${spell(t.of)}` : t.kind === 'function' ? 'function' : t.name;
  return t.constant ? 'const ' + name : name;
}
const allReal = t => t.kind === 'array' ? allReal(t.of) : t.kind === 'struct' ? [...t.body.fields.values()].every(f => allReal(f.t)) :
  t.name === 'double';
/* Copies a struct or an array; one of doubles alone faster, as reading what was written in other pieces would be slow. */
const copied = (to, from, t) => `${allReal(t) ? 'reals' : 'copy'}(${to}, ${from}, ${t.kind === 'struct' ? t.body.size : t.size})`;
/* Returns the name nearest to a wrong one, as ": did you mean ...?", or "". */
function nearest(name, names) {
  let best = '', least = Math.min(3, Math.ceil(name.length/2));
  for (const other of names) {
    let row = Array.from({ length: other.length + 1 }, (_, k) => k);
    for (let i = 1; i <= name.length; i++) {
      const next = [i];
      for (let k = 1; k <= other.length; k++)
        next.push(Math.min(row[k] + 1, next[k - 1] + 1, row[k - 1] + (name[i - 1] !== other[k - 1])));
      row = next;
    }
    if (row[other.length] < least) { least = row[other.length]; best = other; }
  }
  return best ? `: did you mean ${best}?` : '';
}

// ---- functions of math.h ----
const MATH = { sqrt: 1, fabs: 1, exp: 1, log: 1, log10: 1, log2: 1, log1p: 1, expm1: 1, sin: 1, cos: 1, tan: 1, asin: 1, acos: 1, atan: 1,
  sinh: 1, cosh: 1, tanh: 1, asinh: 1, acosh: 1, atanh: 1, cbrt: 1, floor: 1, ceil: 1, trunc: 1, round: 1, exp2: 1, pow: 2, atan2: 2,
  fmod: 2, hypot: 2, fmin: 2, fmax: 2, copysign: 2, fdim: 2, fma: 3, isnan: 1, isfinite: 1, isinf: 1, signbit: 1, abs: 1 };
const WHOLE = new Set(['isnan', 'isfinite', 'isinf', 'signbit', 'abs']);
const MATH_CODE = `
const math = { sqrt: Math.sqrt, fabs: Math.abs, exp: Math.exp, log: Math.log, log10: Math.log10, log2: Math.log2, log1p: Math.log1p,
  expm1: Math.expm1, sin: Math.sin, cos: Math.cos, tan: Math.tan, asin: Math.asin, acos: Math.acos, atan: Math.atan, sinh: Math.sinh,
  cosh: Math.cosh, tanh: Math.tanh, asinh: Math.asinh, acosh: Math.acosh, atanh: Math.atanh, cbrt: Math.cbrt, floor: Math.floor,
  ceil: Math.ceil, trunc: Math.trunc, round: x => x < 0 ? -Math.round(-x) : Math.round(x), exp2: x => 2**x,
  pow: (x, y) => x === 1 || (x === -1 && (y === Infinity || y === -Infinity)) ? 1 : x**y, atan2: Math.atan2, fmod: (x, y) => x%y,
  hypot: Math.hypot, fmin: (x, y) => x !== x ? y : y !== y ? x : Math.min(x, y),
  fmax: (x, y) => x !== x ? y : y !== y ? x : Math.max(x, y), copysign: (x, y) => (y < 0 || Object.is(y, -0)) ? -Math.abs(x) : Math.abs(x),
  fdim: (x, y) => x > y ? x - y : 0, fma: (x, y, z) => x*y + z, isnan: x => +(x !== x), isfinite: x => +Number.isFinite(x),
  isinf: x => +(x === Infinity || x === -Infinity), signbit: x => +(x < 0 || Object.is(x, -0)), abs: x => x < 0 ? -x|0 : x };`;

// ---- the translator: reads declarations and writes functions ----
// An expression is { t: type, js, at }: js computes its value (of a struct or an array: its address); at, where it is an
// lvalue, is { name } of a variable of JavaScript or { base, offset, safe } in memory; value: of a constant.
class Translator {
  constructor(list, setting) {
    this.list = list; this.i = 0; this.calls = setting.calls ?? []; this.inner = !!setting.header;
    const header = setting.header;
    this.scopes = [header ? new Map(header.names) : new Map()];
    this.tags = [header ? new Map(header.tags) : new Map()];
    this.functions = header ? new Map(header.functions) : new Map();      // name -> { js, uses }
    this.start = [];                                                      // statements that set static data
    this.data = setting.data ?? 0; this.used = 0;                         // where static data begin; bytes used
    this.table = [];                                                      // functions whose address is taken
    this.formulas = header ? new Set(header.formulas) : new Set();        // functions that change nothing
    if (!header) {
      const FILE = { kind: 'struct', name: 'FILE', body: { fields: null }, size: 0, align: 1 };
      for (const [name, t] of Object.entries({ ...NAMED, FILE })) this.scopes[0].set(name, { kind: 'type', t });
      for (const name in MATH) {
        const real = WHOLE.has(name) && name !== 'abs' ? INT : name === 'abs' ? INT : DOUBLE, from = name === 'abs' ? INT : DOUBLE;
        const t = { kind: 'function', result: real, takes: Array(MATH[name]).fill(from) };
        this.scopes[0].set(name, { kind: 'function', t, js: 'math.' + name, free: true });
        if (!WHOLE.has(name))
          this.scopes[0].set(name + 'f', { kind: 'function', js: 'math.' + name, free: true,
            t: { kind: 'function', result: FLOAT, takes: Array(MATH[name]).fill(FLOAT) } });
      }
    }
  }
  // ---- words ----
  get word() { return this.list[this.i]; }
  is(text) { return this.word.text === text && this.word.kind !== 'string'; }
  take(text) { if (!this.is(text)) return false; this.i++; return true; }
  need(text, after) {
    if (this.take(text)) return;
    const before = this.list[this.i - 1];
    if (text === ';' && before && before.line < this.word.line)
      fail({ ...before, column: before.column + before.text.length }, 'a ; is missing at the end of this line');
    fail(this.word, `expected ${text}${after ? ' ' + after : ''} before ${this.quote(this.word)}`);
  }
  quote(word) { return word.kind === 'end' ? 'the end of the text' : `"${word.text}"`; }
  name(what) {
    const word = this.word;
    if (word.kind !== 'word' || KEYWORDS.has(word.text)) fail(word, `expected ${what}, found ${this.quote(word)}`);
    this.i++;
    return word;
  }
  // ---- names ----
  find(name) { for (let k = this.scopes.length; k--;) { const s = this.scopes[k].get(name); if (s) return s; } return null; }
  tag(name) { for (let k = this.tags.length; k--;) { const s = this.tags[k].get(name); if (s) return s; } return null; }
  put(word, symbol) {
    const scope = this.scopes.at(-1), old = scope.get(word.text);
    if (old && !(this.scopes.length === 1 && (old.kind === 'function' || old.kind === symbol.kind)))
      fail(word, `"${word.text}" exists already in this block: choose another name`);
    scope.set(word.text, symbol);
    return symbol;
  }
  unknown(word) {
    const names = [...KEYWORDS]; for (const scope of this.scopes) names.push(...scope.keys());
    const near = names.includes('dem_' + word.text) ? `: did you mean dem_${word.text}?` :
      nearest(word.text, names.filter(n => !n.startsWith('demi_')));
    const hint = /^(printf|fprintf|puts|malloc|free|rand|exit|abort|memcpy|memset|assert)$/.test(word.text) ?
      ': a law has dem.h and math.h, and nothing else of the C library' : near || ': declare it before it is used';
    fail(word, `"${word.text}" is not known${hint}`);
  }
  // ---- declarations ----
  startsType(word = this.word) {
    if (word.kind !== 'word') return false;
    if (/^(void|char|short|int|long|float|double|signed|unsigned|struct|union|enum|const|volatile|static|extern|typedef|register|inline|auto|__inline|__extension__)$/
      .test(word.text)) return true;
    return this.find(word.text)?.kind === 'type';
  }
  specifiers() {
    const first = this.word, spelled = [], storage = {};
    let t = null, constant = false;
    for (;;) {
      const word = this.word, text = word.text;
      if (word.kind !== 'word') break;
      if (/^(static|extern|typedef|register|inline|auto|__inline|__extension__)$/.test(text)) { storage[text] = true; this.i++; }
      else if (text === 'const') { constant = true; this.i++; }
      else if (text === 'volatile' || text === 'restrict' || text === '__restrict') this.i++;
      else if (/^(void|char|short|int|long|float|double|signed|unsigned)$/.test(text)) { spelled.push(text); this.i++; }
      else if (text === 'struct' || text === 'union') { this.i++; t = this.structure(text); }
      else if (text === 'enum') { this.i++; t = this.enumeration(); }
      else if (text === '__attribute__') { this.i++; this.skip(); }
      else if (!t && !spelled.length && this.find(text)?.kind === 'type') { t = this.find(text).t; this.i++; }
      else break;
    }
    if (spelled.length) t = SPELLED[spelled.sort().join(' ')] ?? fail(first, `"${spelled.join(' ')}" is no type`);
    if (!t) {
      if (first.kind === 'word' && !KEYWORDS.has(first.text)) this.unknown(first);
      fail(first, `expected a type, found ${this.quote(first)}`);
    }
    return { t: constant ? { ...t, constant: true } : t, storage };
  }
  skip() {                                                                // over ( ... )
    let depth = 0;
    do {
      if (this.word.kind === 'end') fail(this.word, 'a closing ) is missing');
      if (this.is('(')) depth++;
      if (this.is(')')) depth--;
      this.i++;
    } while (depth);
  }
  structure(what) {
    const tag = this.word.kind === 'word' ? this.name('a name') : null;
    let t = tag && (this.is('{') ? this.tags.at(-1).get(tag.text) : this.tag(tag.text));
    if (!t) {
      t = { kind: 'struct', name: tag ? tag.text : what, body: { fields: null }, size: 0, align: 1 };
      if (tag) this.tags.at(-1).set(tag.text, t);
    }
    if (!this.is('{')) return t;
    if (t.body.fields) fail(tag, `${what} ${tag.text} exists already`);
    this.i++;
    const fields = new Map();
    let size = 0, align = 1;
    while (!this.take('}')) {
      const { t: base } = this.specifiers();
      do {
        const d = this.declarator(base);
        if (this.is(':')) fail(this.word, 'bit fields are not in the C of the lab');
        if (!d.name) fail(this.word, 'a field needs a name');
        if (d.t.kind === 'struct' && !d.t.body.fields) fail(d.name, `${spell(d.t)} is not complete here`);
        const of = this.whole(d.t);
        const offset = what === 'union' ? 0 : aligned(size, of.align);
        fields.set(d.name.text, { t: of, offset });
        size = Math.max(size, offset + of.size);
        align = Math.max(align, of.align);
      } while (this.take(','));
      this.need(';', 'after a field');
    }
    t.body.fields = fields; t.body.size = aligned(size, align); t.body.align = align;
    t.size = t.body.size; t.align = align;
    return t;
  }
  /* A struct that was completed after its type was copied (const) gets its size here. */
  whole(t) { return t.kind === 'struct' && !t.size && t.body.fields ? { ...t, size: t.body.size, align: t.body.align } : t; }
  enumeration() {
    if (this.word.kind === 'word') this.i++;
    if (!this.take('{')) return INT;
    let next = 0;
    while (!this.take('}')) {
      const word = this.name('a name');
      if (this.take('=')) next = this.constant();
      this.put(word, { kind: 'enum', value: next++ });
      if (!this.take(',')) { this.need('}'); break; }
    }
    return INT;
  }
  constant() {
    const word = this.word, e = this.conditional();
    if (e.value === undefined) fail(word, 'a constant is needed here');
    return e.value;
  }
  declarator(base) {
    while (this.take('*')) {
      base = pointer(base);
      while (this.is('const') || this.is('restrict') || this.is('__restrict') || this.is('volatile'))
        if (this.list[this.i++].text === 'const') base = { ...base, constant: true };
    }
    if (this.is('(') && (this.list[this.i + 1].text === '*' ||
      (this.list[this.i + 1].kind === 'word' && !this.startsType(this.list[this.i + 1])))) {
      const inner = this.i + 1;
      this.skip();
      const t = this.suffix(base), after = this.i;
      this.i = inner;
      const d = this.declarator(t);
      this.need(')');
      this.i = after;
      while (this.take('__attribute__')) this.skip();
      return d;
    }
    const name = this.word.kind === 'word' && !KEYWORDS.has(this.word.text) ? this.list[this.i++] : null;
    const start = this.i, t = this.suffix(base);
    while (this.take('__attribute__')) this.skip();
    return { name, t, start };
  }
  suffix(t) {
    if (this.take('[')) {
      const word = this.word, count = this.is(']') ? 0 : this.constant();
      this.need(']');
      if (!(count >= 0)) fail(word, 'the length of an array is a positive constant');
      return array(this.suffix(this.whole(t)), count);
    }
    if (this.take('(')) {
      const takes = [], names = [];
      let dots = false;
      if (this.is('void') && this.list[this.i + 1].text === ')') this.i++;
      while (!this.is(')')) {
        if (this.take('...')) { dots = true; break; }
        const d = this.declarator(this.specifiers().t);
        takes.push(d.t.kind === 'array' ? pointer(d.t.of) : d.t.kind === 'function' ? pointer(d.t) : this.whole(d.t));
        names.push(d.name);
        if (!this.take(',')) break;
      }
      this.need(')');
      return { kind: 'function', result: t, takes, names, dots };
    }
    return t;
  }
  /* One declaration at the top of a file. */
  external() {
    if (this.take(';')) return;
    const { t: base, storage } = this.specifiers();
    if (this.take(';')) return;
    for (;;) {
      const d = this.declarator(base);
      if (!d.name) fail(this.word, `expected a name, found ${this.quote(this.word)}`);
      if (storage.typedef) this.put(d.name, { kind: 'type', t: d.t });
      else if (d.t.kind === 'function') {
        const old = this.scopes[0].get(d.name.text);
        const symbol = old?.free ? old : { kind: 'function', t: d.t, js: '$' + d.name.text, name: d.name.text };
        this.put(d.name, symbol);
        if (this.is('{')) { this.define(d, symbol); return; }
      } else this.variable(d, true);
      if (!this.take(',')) break;
    }
    this.need(';', 'after a declaration');
  }
  /* Space for static data. */
  place(size, align) {
    this.used = aligned(this.used, align);
    const at = this.data + this.used;
    this.used += size;
    return at;
  }
  /* Declares a variable, with its first value if one follows. */
  variable(d, still) {
    if (d.t.kind === 'void') fail(d.name, 'a variable cannot be void');
    let t = this.whole(d.t);
    const begins = this.is('=') && this.list[this.i + 1], open = begins && begins.text === '{';
    if (t.kind === 'array' && !t.count) {                                 // length from the first values
      if (!begins) fail(d.name, 'this array needs a length');
      t = array(t.of, begins.kind === 'string' ? JSON.parse(begins.text).length + 1 : this.count());
    }
    if (t.kind === 'struct' && !t.body.fields) fail(d.name, `${spell(t)} is not complete here`);
    if (t === WIDE) fail(d.name, 'integers of 64 bits are not in the C of the lab: use double or int');
    const scalar = t.kind === 'number' || t.kind === 'pointer';
    const memory = still || !scalar || this.addressed.has(d.name.text);
    const symbol = this.put(d.name, { kind: 'variable', t, name: d.name.text });
    let store = '';
    if (memory) {
      symbol.at = still ? { base: '', offset: this.place(t.size, t.align), safe: true } : this.local(t);
      if (this.take('=')) store = open && !scalar ? this.fill(symbol.at, t) : this.first(symbol, t);
    } else {
      symbol.at = { name: `${d.name.text}_${++this.made}` };
      const first = this.take('=') ? this.convert(this.braced(), t, d.name, 'initialises') : isReal(t) ? 'NaN' : '0';
      this.variables.push(symbol.at.name);
      store = `${symbol.at.name} = ${first};`;
    }
    if (still) { if (store) this.start.push(store); return ''; }
    return store;
  }
  braced() {                                                              // = x or = {x}
    if (!this.take('{')) return this.assignment();
    const e = this.assignment();
    this.take(',');
    this.need('}');
    return e;
  }
  first(symbol, t) {
    const word = this.word;
    if (t.kind === 'array') {
      if (word.kind !== 'string') fail(word, 'an array begins with values in { }');
      const text = this.text(JSON.parse(this.list[this.i++].text));
      return `copy(${address(symbol.at)}, ${text}, ${t.size});`;
    }
    const e = this.braced(), js = this.convert(e, t, word, 'initialises');
    return (e.make ? e.make(address(symbol.at)) : this.store(symbol.at, t, js, word)) + ';';
  }
  count() {                                                               // of the values in = { ... }
    let k = this.i + 2, depth = 0, count = this.list[k].text === '}' ? 0 : 1;
    for (; ; k++) {
      const text = this.list[k].text;
      if (this.list[k].kind === 'end') fail(this.word, 'a closing } is missing');
      if (text === '{' || text === '(' || text === '[') depth++;
      if (text === '}' && !depth) return count;
      if (text === '}' || text === ')' || text === ']') depth--;
      if (text === ',' && !depth && this.list[k + 1].text !== '}') count++;
    }
  }
  /* Writes values in { } into memory; what has no value is 0. */
  fill(at, t) {
    let js = `zero(${address(at)}, ${t.size});`;
    const level = (at, t, nested) => {
      const parts = t.kind === 'array' ? null : [...t.body.fields.entries()];
      const many = parts ? parts.length : t.count;
      let k = 0;
      while (!this.is('}')) {
        if (nested && this.is('.')) {
          const word = this.list[++this.i];
          k = parts ? parts.findIndex(([name]) => name === word.text) : -1;
          if (k < 0) fail(word, `${spell(t)} has no field "${word.text}"${parts ? nearest(word.text, parts.map(p => p[0])) : ''}`);
          this.i++;
          this.need('=');
        }
        if (k >= many) { if (nested) fail(this.word, `too many values for ${spell(t)}`); return; }
        const of = this.whole(parts ? parts[k][1].t : t.of);
        const place = { ...at, offset: at.offset + (parts ? parts[k][1].offset : k*of.size) };
        k++;
        if (of.kind === 'array' || of.kind === 'struct') {
          if (this.take('{')) { level(place, of, true); this.need('}'); }
          else {
            const mark = this.i, word = this.word;
            const e = of.kind === 'struct' ? this.assignment() : null;
            if (e && same(e.t, of)) js += copied(address(place), this.read(e), of) + ';';
            else { this.i = mark; if (word.kind === 'end') fail(word, 'a closing } is missing'); level(place, of, false); if (this.is('}')) return; continue; }
          }
        } else {
          const word = this.word;
          js += this.store(place, of, this.convert(this.braced(), of, word, 'initialises'), word) + ';';
        }
        if (!nested && k >= many) return;
        if (!this.take(',')) return;
      }
    };
    this.need('{');
    level(at, t, true);
    this.need('}');
    return js;
  }
  text(value) {
    const at = this.place(value.length + 1, 1);
    this.start.push(`text(${at}, ${JSON.stringify(value)});`);
    return at;
  }
  // ---- functions ----
  local(t) {
    this.frame = aligned(this.frame, t.align);
    const at = { base: 'fp', offset: this.frame, safe: true };
    this.frame += t.size;
    return at;
  }
  define(d, symbol) {
    const name = d.name.text, t = d.t, from = this.i;
    if (t.dots) fail(d.name, 'functions with ... are not in the C of the lab');
    if (this.functions.get(name)?.mine) fail(d.name, `the function ${name} exists already`);
    this.addressed = new Set();                                           // names that follow a unary &
    for (let k = from, depth = 0; ; k++) {
      const w = this.list[k], before = this.list[k - 1];
      if (w.kind === 'end') fail(this.list[from], `the function ${name} has no closing }`);
      if (w.text === '{') depth++;
      if (w.text === '}' && --depth === 0) break;
      if (w.text === '&' && this.list[k + 1].kind === 'word' && (before.kind === 'sign' ? !/^[)\]]$/.test(before.text) :
        before.text === 'return')) this.addressed.add(this.list[k + 1].text);
    }
    // { return expression; } without assignments changes nothing: it need not copy the structs that it receives
    let end = from;
    while (this.list[end].kind !== 'end' && !/^(}|=|\+\+|--|[-+*/%&|^]=|<<=|>>=)$/.test(this.list[end].text)) end++;
    const formula = this.list[from + 1].text === 'return' && this.list[end].text === '}' &&
      this.list.slice(from, end).every(w => w.kind !== 'word' || !/^\$/.test(this.find(w.text)?.js ?? '') || this.formulas.has(w.text));
    if (formula) this.formulas.add(name);
    this.frame = 0; this.made = 0; this.variables = []; this.temporaries = 0; this.result = this.whole(t.result); this.within = name;
    this.uses = new Set(); this.loops = 0; this.breaks = 0;
    this.scopes.push(new Map());
    this.tags.push(new Map());
    const heads = [], gives = this.result.kind === 'struct';
    let prologue = '';
    if (gives) heads.push('to');
    t.takes.forEach((of, k) => {
      const word = t.names[k];
      if (!word) { heads.push('_' + k); return; }
      const js = `${word.text}_p`, s = this.put(word, { kind: 'variable', t: of, name: word.text });
      heads.push(js);
      if (of.kind === 'struct' && formula) s.at = { base: js, offset: 0, safe: true };
      else if (of.kind === 'struct') { s.at = this.local(of); prologue += copied(address(s.at), js, of) + ';'; }
      else if (this.addressed.has(word.text)) { s.at = this.local(of); prologue += this.store(s.at, of, js, word) + ';'; }
      else s.at = { name: js };
    });
    const body = this.block();
    this.scopes.pop();
    this.tags.pop();
    const frame = aligned(this.frame, 8);
    const local = [...this.variables, ...Array.from({ length: this.temporaries }, (_, k) => 't' + k)];
    const falls = this.result.kind === 'void' || gives ? '' : ` return ${isReal(this.result) ? 'NaN' : '0'};`;
    const enter = `if (--fuel < 0) stop('endless', ${d.name.line}, '${name}');` +
      (frame ? ` const fp = sp; if ((sp += ${frame}) > top) stop('deep', ${d.name.line}, '${name}');` : '');
    this.functions.set(name, { mine: true, uses: this.uses,
      js: `function $${name}(${heads.join(', ')}) { ${enter} ${local.length ? `let ${local.join(', ')};` : ''} ${prologue}\n` +
        `${body}\n${frame ? 'sp = fp;' : ''}${falls} }`.replace(/@leave@/g, frame ? 'sp = fp, ' : '') });
    symbol.defined = true;
    this.addressed = new Set();
  }
  temporary() { return 't' + this.temporaries++; }
  block() {
    this.need('{');
    this.scopes.push(new Map());
    this.tags.push(new Map());
    let js = '{\n';
    while (!this.take('}')) {
      if (this.word.kind === 'end') fail(this.word, 'a closing } is missing');
      js += this.statement() + '\n';
    }
    this.scopes.pop();
    this.tags.pop();
    return js + '}';
  }
  declaration() {
    const { t: base, storage } = this.specifiers();
    let js = '';
    if (this.take(';')) return js;
    do {
      const d = this.declarator(base);
      if (!d.name) fail(this.word, `expected a name, found ${this.quote(this.word)}`);
      if (storage.typedef) this.put(d.name, { kind: 'type', t: d.t });
      else if (d.t.kind === 'function' && this.is('{'))
        fail(this.word, 'a function stands inside another: write the whole law, its functions above each other, and a row LAW');
      else if (d.t.kind === 'function') this.put(d.name, { kind: 'function', t: d.t, js: '$' + d.name.text, name: d.name.text });
      else if (storage.static) this.variable(d, true);
      else js += this.variable(d, false);
    } while (this.take(','));
    this.need(';', 'after a declaration');
    return js;
  }
  loop(line) { return `if (--fuel < 0) stop('endless', ${line});`; }
  body() { this.loops++; this.breaks++; const js = this.statement(); this.loops--; this.breaks--; return js; }
  statement() {
    const word = this.word, text = word.kind === 'word' ? word.text : '';
    if (this.is('{')) return this.block();
    if (this.take(';')) return ';';
    if (text === 'if') {
      this.i++;
      this.need('(', 'after if');
      const test = this.truth(this.expression());
      this.need(')');
      let js = `if (${test}) { ${this.statement()} }`;
      if (this.take('else')) js += ` else { ${this.statement()} }`;
      return js;
    }
    if (text === 'while') {
      this.i++;
      this.need('(', 'after while');
      const test = this.truth(this.expression());
      this.need(')');
      return `while (${test}) { ${this.loop(word.line)} ${this.body()} }`;
    }
    if (text === 'do') {
      this.i++;
      const body = this.body();
      this.need('while', 'after the block of do');
      this.need('(');
      const test = this.truth(this.expression());
      this.need(')');
      this.need(';');
      return `do { ${this.loop(word.line)} ${body} } while (${test});`;
    }
    if (text === 'for') {
      this.i++;
      this.need('(', 'after for');
      this.scopes.push(new Map());
      let first = '';
      if (this.startsType()) first = this.declaration();
      else {
        if (!this.is(';')) first = this.only(this.expression(), ';') + ';';
        this.need(';');
      }
      const test = this.is(';') ? 'true' : this.truth(this.expression());
      this.need(';');
      const step = this.is(')') ? '' : this.only(this.expression(), ')', true);
      this.need(')');
      const body = this.body();
      this.scopes.pop();
      return `${first} for (; ${test}; ${step}) { ${this.loop(word.line)} ${body} }`;
    }
    if (text === 'switch') return this.choice();
    if (text === 'case' || text === 'default') fail(word, `${text} stands outside switch`);
    if (text === 'break' || text === 'continue') {
      if (text === 'break' ? !this.breaks : !this.loops) fail(word, `${text} stands outside a loop`);
      this.i++;
      this.need(';');
      return text + ';';
    }
    if (text === 'return') {
      this.i++;
      const gives = this.result;
      if (this.take(';')) {
        if (gives.kind !== 'void') fail(word, `${this.within} must return a ${spell(gives)}`);
        return '{ @leave@0; return; }';
      }
      const at = this.word, e = this.expression();
      this.need(';', 'after return');
      if (gives.kind === 'void') fail(at, `${this.within} is void and returns nothing: set the fields of the force instead`);
      const js = this.convert(e, gives, at, 'is returned as');
      if (gives.kind === 'struct') return `{ ${e.make ? e.make('to') : copied('to', js, gives)}; @leave@0; return; }`;
      const t = this.temporary();
      return `{ ${t} = ${js}; return (@leave@${t}); }`;
    }
    if (text === 'goto') fail(word, 'goto is not in the C of the lab');
    if (this.startsType() && this.list[this.i + 1].text !== '(') return this.declaration();
    const e = this.only(this.expression(), ';');
    this.need(';');
    return e + ';';
  }
  choice() {
    const word = this.list[this.i++];
    this.need('(', 'after switch');
    const e = this.expression(), t = e.t;
    if (!isInteger(t)) fail(word, 'switch needs an integer');
    this.need(')');
    this.need('{');
    this.scopes.push(new Map());
    this.breaks++;
    let js = `switch (${this.read(e)}) {\n`;
    while (!this.take('}')) {
      if (this.take('case')) { js += `case ${this.constant()}:`; this.need(':'); }
      else if (this.take('default')) { js += 'default:'; this.need(':'); }
      else js += this.statement() + '\n';
    }
    this.breaks--;
    this.scopes.pop();
    return js + '}';
  }
  /* An expression as a statement. */
  only(e, end, quiet) {
    if (e.idle && !quiet && !e.thrown)
      fail(e.word, e.compares ? 'this compares and throws the result away: = assigns, == compares' : 'this computes a value and throws it away');
    if (!this.is(end)) {
      const before = this.list[this.i - 1];
      if (end === ';') this.need(';');
      fail(this.word, `expected an operator or ${end} after "${before.text}", found ${this.quote(this.word)}`);
    }
    return e.t.kind === 'void' || !e.at || e.at.name ? e.js ?? this.read(e) : this.read(e);
  }
  // ---- expressions ----
  read(e) {
    if (e.js !== undefined && !e.at) return e.test ? `(${e.js} ? 1 : 0)` : e.js;
    if (e.at.name) return e.at.name;
    const t = e.t;
    if (t.kind === 'array' || t.kind === 'struct' || t.kind === 'function') return `(${address(e.at)})`;
    if (!t.array) fail(e.word ?? this.word, 'integers of 64 bits are not in the C of the lab: use double or int');
    return `${t.array}[${checked('load', e.at, e.word)}>>${t.shift}]`;
  }
  /* An expression whose value is used: arrays become pointers, functions their number. */
  value(e) {
    if (e.t.kind === 'array') return { t: pointer(e.t.of), js: this.read(e), word: e.word, whole: e.at };
    if (e.t.kind === 'function') {
      if (!e.named) fail(e.word, 'a function is called with ( )');
      this.uses?.add(e.named);
      if (!this.table.includes(e.named)) this.table.push(e.named);
      return { t: pointer(e.t), js: String(this.table.indexOf(e.named) + 1), word: e.word };
    }
    if (e.test) return { t: INT, js: this.read(e), word: e.word, value: e.value, idle: e.idle, compares: e.compares };
    return e;
  }
  truth(e) {
    if (e.test) return e.js;
    if (e.sets) fail(e.word, 'this assigns, and does not compare: write == to compare');
    const v = this.value(e);
    if (v.t.kind === 'struct' || v.t.kind === 'void') fail(e.word, `a condition is a number, not ${spell(v.t)}`);
    return `${this.read(v)} !== 0`;
  }
  store(at, t, js, word) {
    if (at.name) return `${at.name} = ${js}`;
    if (t.kind === 'struct') return copied(checked('put', at, word), js, t);
    return `${t.array}[${checked('put', at, word)}>>${t.shift}] = ${js}`;
  }
  /* The value of e as type t. */
  convert(e, t, word, does) {
    const v = this.value(e), from = v.t;
    if (from.kind === 'void') fail(word, `this call returns nothing, and its result is used`);
    if (isNumber(t) && isNumber(from)) {
      const js = this.read(v);
      if (isReal(t)) return t.name === 'float' && from.name !== 'float' ? `Math.fround(${js})` : js;
      return whole(t, js, from);
    }
    if (t.kind === 'pointer') {
      if (isInteger(from) && v.value === 0) return '0';
      if (from.kind === 'pointer') {
        if (from.to.constant && !t.to.constant)
          fail(word, `${spell(from)} ${does} ${spell(t)}: what it points to is constant; copy it, or declare a pointer to const`);
        if (t.to.kind === 'void' || from.to.kind === 'void' || same(plain(t.to), plain(from.to)) ||
          (t.to.kind === 'function' && from.to.kind === 'function')) return this.read(v);
      }
    }
    if (t.kind === 'struct' && from.kind === 'struct' && from.body === t.body) return this.read(v);
    fail(word, `${spell(from)} ${does} ${spell(t)}`);
  }
  expression() {
    let e = this.assignment();
    while (this.is(',')) {
      this.i++;
      const next = this.assignment();
      const js = `(${this.only(e, this.word.text, true)}, ${this.read(next)})`;
      e = { t: this.value(next).t, js, word: next.word };
    }
    return e;
  }
  assignment() {
    const start = this.word, left = this.conditional(), op = this.word.text;
    if (!/^([-+*/%&|^]|<<|>>)?=$/.test(op) || this.word.kind === 'string') return left;
    const word = this.list[this.i++];
    this.changes(left, start);
    const right = this.assignment(), t = left.t;
    if (op === '=') {
      const js = this.convert(right, plain(t), word, 'is assigned to');
      if (t.kind === 'struct') return { t, js: copied(checked('put', left.at, start), js, t), word };
      return { t, js: `(${this.store(left.at, t, js, start)})`, word, sets: true };
    }
    const [at, before] = this.once(left);
    const result = this.binary(op.slice(0, -1), { t, at, word: start }, right, word);
    return { t, js: `(${before}${this.store(at, t, this.convert(result, t, word, 'is assigned to'), start)})`, word };
  }
  /* An lvalue that is read and written: its address is computed once. */
  once(e) {
    const at = e.at;
    if (at.name || /^\w*$/.test(at.base)) return [at, ''];
    const t = this.temporary();
    return [{ base: t, offset: 0, safe: at.safe }, `${t} = ${address(at)}, `];
  }
  changes(e, word) {
    if (!e.at || e.t.kind === 'array' || e.t.kind === 'function') fail(word, 'only a variable, a field or an element can be assigned to');
    if (e.t.constant || e.at.constant)
      fail(word, e.at.constant && !e.at.name ? 'this is constant: a law reads *c; to change it, copy it first (dem_contact own = *c;)' :
        'this is constant: remove const where it is declared');
  }
  conditional() {
    const e = this.chain(0);
    if (!this.is('?')) return e;
    const word = this.list[this.i++], test = this.truth(e);
    const yes = this.value(this.expression());
    this.need(':', 'of ? :');
    const no = this.value(this.conditional());
    const known = e.value !== undefined ? (e.value ? yes.value : no.value) : undefined;
    if (isNumber(yes.t) && isNumber(no.t)) {
      const t = joint(yes.t, no.t);
      return { t, js: `(${test} ? ${this.convert(yes, t, word)} : ${this.convert(no, t, word)})`, word, value: known, idle: yes.idle && no.idle };
    }
    if (yes.t.kind === 'void' && no.t.kind === 'void') return { t: VOID, js: `(${test} ? ${yes.js} : ${no.js})`, word };
    const t = yes.t.kind === 'pointer' ? yes.t : no.t;
    if (t.kind === 'pointer' || (t.kind === 'struct' && same(yes.t, no.t)))
      return { t, js: `(${test} ? ${this.convert(yes, t, word, 'stands beside')} : ${this.convert(no, t, word, 'stands beside')})`, word };
    fail(word, `both sides of : must be of one type, not ${spell(yes.t)} and ${spell(no.t)}`);
  }
  chain(level) {
    if (level === LEVELS.length) return this.unary();
    let left = this.chain(level + 1);
    while (this.word.kind === 'sign' && LEVELS[level].includes(this.word.text)) {
      const word = this.list[this.i++];
      left = this.binary(word.text, left, this.chain(level + 1), word);
    }
    return left;
  }
  binary(op, a, b, word) {
    if (op === '&&' || op === '||') {
      const known = a.value !== undefined && b.value !== undefined ? +(op === '&&' ? a.value && b.value : a.value || b.value) : undefined;
      return { t: INT, test: true, js: `(${this.truth(a)} ${op} ${this.truth(b)})`, word, value: known, idle: true };
    }
    const x = this.value(a), y = this.value(b), nx = isNumber(x.t), ny = isNumber(y.t);
    const compares = /^([<>]=?|[!=]=)$/.test(op), bad = () => fail(word,
      `${spell(x.t)} ${op} ${spell(y.t)}: ${x.t.kind === 'struct' || y.t.kind === 'struct' ?
        'C has no arithmetic of structs: write it for x, y and z' : x.t.kind === 'void' || y.t.kind === 'void' ?
        'one side is a call that returns nothing' : 'these do not go together'}`);
    if (!nx || !ny) {
      const px = x.t.kind === 'pointer', py = y.t.kind === 'pointer';
      if (compares && (px || (nx && x.value === 0)) && (py || (ny && y.value === 0)))
        return { t: INT, test: true, js: `(${this.read(x)} ${op === '==' ? '===' : op === '!=' ? '!==' : op} ${this.read(y)})`, word, idle: true, compares: op === '==' };
      const size = p => p.to.kind === 'struct' ? p.to.body.size ?? 0 : p.to.size;
      if (px && isInteger(y.t) && (op === '+' || op === '-'))
        return { t: x.t, js: `(${this.read(x)} ${op} ${times(this.read(y), size(x.t), y.value)})`, word, idle: true };
      if (py && isInteger(x.t) && op === '+') return { t: y.t, js: `(${times(this.read(x), size(y.t), x.value)} + ${this.read(y)})`, word, idle: true };
      if (px && py && op === '-' && same(x.t.to, y.t.to)) return { t: INT, js: `((${this.read(x)} - ${this.read(y)})/${size(x.t)}|0)`, word, idle: true };
      bad();
    }
    const integers = isInteger(x.t) && isInteger(y.t);
    if (!integers && /^(%|&|\||\^|<<|>>)$/.test(op)) fail(word, `${op} needs integers${op === '^' ? ': a power is pow(x, y)' : op === '%' ? ': use fmod(x, y)' : ''}`);
    const t = /^(<<|>>)$/.test(op) ? joint(x.t, INT) : joint(x.t, y.t);
    const l = this.convert(x, t, word), r = this.convert(y, /^(<<|>>)$/.test(op) ? INT : t, word);
    let value;
    if (x.value !== undefined && y.value !== undefined) {
      value = evaluate(op, x.value, y.value);
      if (integers && value !== undefined) value = t === UNSIGNED ? value>>>0 : value|0;
    }
    if (compares)
      return { t: INT, test: true, js: `(${l} ${op === '==' ? '===' : op === '!=' ? '!==' : op} ${r})`, word, value, idle: true, compares: op === '==' };
    if (!integers) {
      const js = `(${l} ${op} ${r})`;
      return { t, js: t.name === 'float' ? `Math.fround${js}` : js, word, value, idle: true };
    }
    const js = op === '*' ? `Math.imul(${l}, ${r})` : op === '/' ? `(${l}/divisor(${r}, ${word.line}))` : op === '%' ?
      `(${l}%divisor(${r}, ${word.line}))` : op === '>>' && t.name === 'unsigned' ? `(${l} >>> ${r})` : `(${l} ${op} ${r})`;
    return { t, js: t.name === 'unsigned' ? `(${js}>>>0)` : `(${js}|0)`, word, value, idle: true };
  }
  typeName() {
    const { t } = this.specifiers(), d = this.declarator(t);
    if (d.name) fail(d.name, 'a type stands here, without a name');
    return this.whole(d.t);
  }
  unary() {
    const word = this.word, text = word.kind === 'string' ? '' : word.text;
    if (text === '(' && this.startsType(this.list[this.i + 1])) {
      this.i++;
      const t = this.typeName();
      this.need(')');
      if (this.is('{')) {                                                 // (dem_vec3){1, 2, 3}
        if (!this.uses) fail(word, 'a compound literal stands in functions only');
        const at = this.local(t);
        if (t.kind !== 'struct' && t.kind !== 'array') fail(word, 'values in { } are for structs and arrays');
        return { t, js: `(() => { ${this.fill(at, t)} return ${address(at)}; })()`, word };
      }
      return this.cast(this.unary(), t, word);
    }
    if (/^(\+\+|--)$/.test(text)) {
      this.i++;
      const e = this.unary();
      return this.step(e, text[0], word, false);
    }
    if (/^[-+!~*&]$/.test(text)) {
      this.i++;
      const e = this.unary();
      if (text === '&') return this.addressOf(e, word);
      if (text === '*') return this.follow(this.value(e), word);
      if (text === '!') return { t: INT, test: true, js: `!(${this.truth(e)})`, word, value: e.value === undefined ? undefined : +!e.value, idle: true };
      const v = this.value(e);
      if (!isNumber(v.t) || (text === '~' && !isInteger(v.t))) fail(word, `${text} needs a number, not ${spell(v.t)}`);
      const t = joint(v.t, v.t), js = this.read(v), value = v.value;
      if (text === '+') return { t, js, word, value, idle: true };
      const negative = `(${text}${js})`;
      return { t, js: isReal(t) ? negative : t.name === 'unsigned' ? `(${negative}>>>0)` : `(${negative}|0)`, word, idle: true,
        value: value === undefined ? undefined : text === '-' ? -value : ~value };
    }
    if (text === 'sizeof') {
      this.i++;
      let t;
      if (this.is('(') && this.startsType(this.list[this.i + 1])) { this.i++; t = this.typeName(); this.need(')'); }
      else t = this.unary().t;
      const size = t.kind === 'struct' ? t.body.size : t.size;
      return { t: UNSIGNED, js: String(size), value: size, word, idle: true };
    }
    return this.postfix();
  }
  cast(e, t, word) {
    const v = this.value(e);
    if (t.kind === 'void') return { t: VOID, js: v.t.kind === 'void' ? v.js : this.read(v), word, thrown: true };
    if (isNumber(t) && isNumber(v.t)) {
      const js = this.convert(v, t, word), value = v.value;
      return { t, js, word, idle: true, value: value === undefined ? undefined : !isReal(t) ? Math.trunc(value) : t.name === 'float' ? Math.fround(value) : value };
    }
    if (t.kind === 'pointer' && (v.t.kind === 'pointer' || isInteger(v.t))) return { t, js: this.read(v), word, idle: true };
    if (isInteger(t) && v.t.kind === 'pointer') return { t, js: whole(t, this.read(v), INT), word, idle: true };
    fail(word, `${spell(v.t)} cannot be cast to ${spell(t)}`);
  }
  addressOf(e, word) {
    if (e.t.kind === 'function') return this.value(e);
    if (!e.at || e.at.name) {
      if (e.t.kind === 'struct' && e.js) return { t: pointer(e.t), js: e.js, word };
      fail(word, '& needs a variable, a field or an element');
    }
    const to = e.at.constant && !e.t.constant ? { ...e.t, constant: true } : e.t;
    return { t: pointer(to), js: `(${address(e.at)})`, word, idle: true };
  }
  follow(v, word) {
    if (v.t.kind !== 'pointer') fail(word, `* needs a pointer, not ${spell(v.t)}`);
    if (v.t.to.kind === 'function') return { t: v.t.to, js: v.js, word, through: this.read(v) };
    if (v.t.to.kind === 'void') fail(word, 'cast this void pointer first: const my_numbers *u = (const my_numbers *)c->user;');
    return { t: this.whole(v.t.to), at: { base: this.read(v), offset: 0, constant: v.t.to.constant }, word, idle: true };
  }
  step(e, op, word, after) {
    this.changes(e, word);
    if (!isNumber(e.t) && e.t.kind !== 'pointer') fail(word, `${op}${op} needs a number or a pointer`);
    const [at, before] = this.once(e), t = e.t, was = { t, at, word };
    const next = this.convert(this.binary(op, was, { t: INT, js: '1', value: 1 }, word), t, word);
    if (!after) return { t, js: `(${before}${this.store(at, t, next, word)})`, word };
    const old = this.temporary();
    return { t, js: `(${before}${old} = ${this.read(was)}, ${this.store(at, t, next, word)}, ${old})`, word };
  }
  postfix() {
    let e = this.primary();
    for (;;) {
      const word = this.word;
      if (word.kind === 'string') return e;
      if (this.take('[')) {
        const base = e, index = this.value(this.expression());
        this.need(']');
        if (!isInteger(index.t)) fail(word, `an index is an integer, not ${spell(index.t)}`);
        if (base.t.kind === 'array') {
          const of = this.whole(base.t.of), k = index.value;
          if (k !== undefined && (k < 0 || k >= base.t.count)) fail(word, `[${k}] lies outside this array of ${base.t.count}`);
          const at = base.at ?? { base: base.js, offset: 0 };
          e = { t: at.constant ? { ...of, constant: true } : of, word, idle: true, at: k !== undefined ? { ...at, offset: at.offset + k*of.size } :
            { base: `(${address(at)} + ${times(this.read(index), of.size)})`, offset: 0, constant: at.constant } };
        } else {
          const v = this.value(base);
          if (v.t.kind !== 'pointer') fail(word, `[ ] needs an array or a pointer, not ${spell(v.t)}`);
          const to = this.whole(v.t.to);
          if (to.kind === 'void') fail(word, 'cast this void pointer first');
          e = { t: to, word, idle: true, at: index.value !== undefined ? { base: this.read(v), offset: index.value*to.size, constant: to.constant } :
            { base: `(${this.read(v)} + ${times(this.read(index), to.size)})`, offset: 0, constant: to.constant } };
        }
      } else if (this.is('.') || this.is('->')) {
        const arrow = this.list[this.i++].text === '->', name = this.name('the name of a field');
        let from = e;
        if (arrow) {
          const v = this.value(e);
          if (v.t.kind !== 'pointer') fail(word, v.t.kind === 'struct' ? 'this is no pointer: write . in place of ->' : `-> needs a pointer, not ${spell(v.t)}`);
          if (v.t.to.kind === 'void') fail(word, 'cast this void pointer first: const my_numbers *u = (const my_numbers *)c->user;');
          from = this.follow(v, word);
        } else if (e.t.kind === 'pointer') fail(word, 'this is a pointer: write -> in place of .');
        if (from.t.kind !== 'struct') fail(word, `${spell(from.t)} has no fields`);
        const fields = from.t.body.fields;
        if (!fields) fail(word, `${spell(from.t)} has no fields that are known here`);
        const field = fields.get(name.text);
        if (!field) fail(name, `${spell(plain(from.t))} has no field "${name.text}"${nearest(name.text, fields.keys())}`);
        const at = from.at ?? { base: from.js, offset: 0, safe: true }, constant = at.constant || from.t.constant;
        e = { t: this.whole(field.t), at: { ...at, offset: at.offset + field.offset, constant }, word: name, idle: true };
      } else if (this.is('(')) { this.i++; e = this.call(e, word); }
      else if (this.is('++') || this.is('--')) { this.i++; e = this.step(e, word.text[0], word, true); }
      else return e;
    }
  }
  call(e, word) {
    let f = e.t;
    if (f.kind === 'pointer' && f.to.kind === 'function') { e = { ...e, t: f.to, through: this.read(e), named: null }; f = f.to; }
    if (f.kind !== 'function') fail(word, `${e.word?.kind === 'word' ? `"${e.word.text}"` : 'this'} is no function`);
    const given = [];
    if (!this.is(')')) do { const at = this.word; given.push([this.assignment(), at]); } while (this.take(','));
    this.need(')', 'of this call');
    if (f.dots || given.length !== f.takes.length)
      fail(e.word ?? word, `${e.named ?? 'this function'} takes ${f.takes.length} argument${f.takes.length === 1 ? '' : 's'}, not ${given.length}`);
    const free = e.free, outside = this.inner && e.named && !free && this.calls.includes(e.named);
    const own = e.named && this.functions.has(e.named);
    if (e.named && !free && !outside) {
      this.uses?.add(e.named);
      if (this.inner && !own && e.named !== this.within && e.named.startsWith('dem'))
        fail(e.word, `${e.named} cannot be called in the lab: laws call dem_law_..., dem_memory_rotate and dem_vec3_make`);
    }
    const js = given.map(([part, at], k) => {
      const value = this.convert(part, plain(f.takes[k]), at, 'is given for');
      if (!outside || f.takes[k].kind !== 'struct') return value;
      const place = this.local(f.takes[k]);                               // C hands a copy over
      return copied(address(place), value, f.takes[k]);
    });
    const name = e.through ? `table[${e.through}]` : outside ? `calls.${e.named}` : e.js, gives = this.whole(f.result);
    if (gives.kind !== 'struct') {
      const call = `${name}(${js.join(', ')})`;
      return { t: gives, js: free && gives.name === 'float' ? `Math.fround(${call})` : call, word: e.word ?? word };
    }
    const place = this.local(gives);
    const make = to => `${name}(${[to, ...js].join(', ')})`;
    return { t: gives, js: `(${make(address(place))}, ${address(place)})`, make, word: e.word ?? word };
  }
  primary() {
    const word = this.list[this.i++];
    if (word.kind === 'number') return literal(word);
    if (word.kind === 'string') {
      let text = JSON.parse(word.text);
      while (this.word.kind === 'string') text += JSON.parse(this.list[this.i++].text);
      return { t: pointer({ ...CHAR1, constant: true }), js: String(this.text(text)), word, idle: true };
    }
    if (word.text === '(') {
      const e = this.expression();
      this.need(')');
      return { ...e, sets: false };
    }
    if (word.kind === 'word' && !KEYWORDS.has(word.text)) {
      const s = this.find(word.text);
      if (!s) this.unknown(word);
      if (s.kind === 'enum') return { t: INT, js: String(s.value), value: s.value, word, idle: true };
      if (s.kind === 'type') fail(word, `"${word.text}" is a type, not a value`);
      if (s.kind === 'function') return { t: s.t, js: s.js, word, named: s.name ?? word.text, free: s.free };
      return { t: s.t, at: { ...s.at, constant: s.t.constant }, word, idle: true };
    }
    this.i--;
    fail(word, `expected a value, found ${this.quote(word)}`);
  }
}
const LEVELS = [['||'], ['&&'], ['|'], ['^'], ['&'], ['==', '!='], ['<', '>', '<=', '>='], ['<<', '>>'], ['+', '-'], ['*', '/', '%']];
const address = at => at.base ? (at.offset ? `${at.base} + ${at.offset}` : at.base) : String(at.offset);
const checked = (how, at, word) => at.safe ? address(at) : `${how}(${address(at)}, ${word?.line ?? 0})`;
const times = (js, size, value) => value !== undefined ? String(value*size) : size === 1 ? js : `Math.imul(${js}, ${size})`;
const joint = (a, b) => a.name === 'double' || b.name === 'double' ? DOUBLE : a.name === 'float' || b.name === 'float' ? FLOAT :
  a.name === 'unsigned' || b.name === 'unsigned' ? UNSIGNED : INT;
function whole(t, js, from) {
  if (t.name === from.name) return js;
  return { int: `(${js}|0)`, unsigned: `(${js}>>>0)`, char: `(${js}<<24>>24)`, 'unsigned char': `(${js}&255)`, short: `(${js}<<16>>16)`,
    'unsigned short': `(${js}&65535)` }[t.name] ?? js;
}
function evaluate(op, x, y) {
  switch (op) {
    case '+': return x + y; case '-': return x - y; case '*': return x*y; case '/': return y ? x/y : undefined;
    case '%': return y ? x%y : undefined; case '<<': return x << y; case '>>': return x >> y; case '&': return x & y; case '|': return x | y;
    case '^': return x ^ y; case '<': return +(x < y); case '>': return +(x > y); case '<=': return +(x <= y); case '>=': return +(x >= y);
    case '==': return +(x === y); case '!=': return +(x !== y);
  }
}
function literal(word) {
  const text = word.text;
  if (text[0] === "'") {
    const value = text[1] === '\\' ? ESCAPES[text[2]] ?? text.charCodeAt(2) : text.charCodeAt(1);
    return { t: INT, js: String(value), value, word, idle: true };
  }
  const real = !/^0[xX]/.test(text) && /[.eE]/.test(text), value = Number(text.replace(/^0[xX].*|.*/, s => s.replace(real ? /[fFlL]+$/ : /[uUlL]+$/, '')));
  if (real) {
    const single = /[fF]$/.test(text);
    return { t: single ? FLOAT : DOUBLE, js: String(single ? Math.fround(value) : value), value: single ? Math.fround(value) : value, word, idle: true };
  }
  if (/^0\d/.test(text)) fail(word, `${text} is an octal number in C: remove the leading 0`);
  const t = /[uU]/.test(text) || value > 2147483647 ? UNSIGNED : INT;
  return { t, js: String(value), value, word, idle: true };
}

/* What every translated law needs beside its own functions. stop(why, line, name) throws. */
const FRAME = `'use strict';
return (memory, stop, calls, stack) => {
let I8, U8, I16, U16, I32, U32, F32, F64, fuel = 0, sp = 0, top = 0;
const look = () => { const b = memory.buffer; I8 = new Int8Array(b); U8 = new Uint8Array(b); I16 = new Int16Array(b); U16 = new Uint16Array(b);
  I32 = new Int32Array(b); U32 = new Uint32Array(b); F32 = new Float32Array(b); F64 = new Float64Array(b); };
const load = (a, line) => { if (a < 1024) stop('null', line); return a; };
const put = (a, line) => { if (a < stack.from || a >= stack.until) stop('store', line); return a; };
const divisor = (x, line) => x === 0 ? stop('zero', line) : x;
const copy = (to, from, size) => { U8.copyWithin(to, from, from + size); return to; };
const reals = (to, from, size) => {
  for (let k = to >> 3, j = from >> 3, end = k + (size >> 3); k < end; k++, j++) F64[k] = F64[j];
  return to;
};
const zero = (to, size) => { for (let k = 0; k < size; k++) U8[to + k] = 0; };
const text = (to, s) => { for (let k = 0; k < s.length; k++) U8[to + k] = s.charCodeAt(k); U8[to + s.length] = 0; };`;

/* Translates one text. setting: header: of an earlier call, whose names are known here; files: { name: text } for #include;
   calls: functions that the caller supplies; data: address of the static data. */
return (source, setting = {}) => {
  const macros = new Map(setting.header ? setting.header.macros : []), result = { error: null, code: '', LAW: 0, header: setting.header };
  try {
    macros.set('LAW_FILE', { body: [], arguments: null });
    const list = preprocess(source, '', macros, setting.files ?? {});
    if (setting.header && macros.has('LAW')) {
      const end = list.pop(), row = words('static const lab_row lab_law = LAW;', '').slice(0, -1);
      for (let k = 0; k < row.length;) k = expand(row.map(w => ({ ...w, line: end.line, column: 1 })), k, macros, list, []);
      list.push(end);
    }
    const t = new Translator(list, { ...setting, calls: setting.calls ?? setting.header?.calls });
    while (t.word.kind !== 'end') t.external();
    const found = name => t.functions.get(name), emitted = new Set(), out = [];
    const emit = name => {
      const f = found(name);
      if (emitted.has(name) || !f) return;
      emitted.add(name);
      f.uses.forEach(emit);
      out.push(f.js);
    };
    if (!setting.header) return { ...result, names: t.scopes[0], tags: t.tags[0], functions: t.functions, formulas: t.formulas, macros, calls: setting.calls ?? [] };
    for (const [name, f] of t.functions) if (f.mine && !setting.header.functions.has(name)) emit(name);
    t.table.forEach(emit);
    result.LAW = macros.has('LAW') ? t.scopes[0].get('lab_law').at.offset : 0;
    result.size = t.used;
    result.table = t.table;
    result.code = `${FRAME}${MATH_CODE}\n${out.join('\n')}\nconst table = [null, ${t.table.map(n => '$' + n).join(', ')}];\n` +
      `const init = () => { look(); fuel = 1e6; sp = stack.at; top = stack.end;\n${t.start.join('\n')}\n};\n` +
      `const call = (k, a, b, c) => { if (!U8.length) look(); fuel = 100000; sp = stack.at; table[k](a, b, c); };\n` +
      `return { init, call };\n};`;
  } catch (fault) {
    if (!(fault instanceof Fault)) throw fault;
    result.error = { line: fault.at.line, column: fault.at.column, file: fault.at.file ?? '', text: fault.message };
  }
  return result;
};
})();
if (typeof module !== 'undefined') module.exports = { translate };
