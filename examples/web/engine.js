/* engine.js - dem.h as lab.c exports it, with a law that translate.js has translated. MIT licence.

   const lab = await lab_engine(module, header, files)     a compiled WebAssembly.Module, translate(...) of dem.h, laws to include
   lab.open(text)            null, or what is wrong: { line, column, text }
   lab.line(k), lab.curve(k), lab.scene(...), lab.step(n)  as in lab.c; lab.fault() is null or what stopped the law */
'use strict';
// functions of dem.h that lab.c hands to laws; other inline ones of its public part are translated as a law is
const CALLS = ['dem_body_get', ...('hertz linear hysteretic viscous step spring mindlin mindlin_rescaled roll_step roll_constant ' +
  'roll_epsd twist').split(' ').map(name => 'dem_law_' + name)];

/* A text without a function and without lines that begin with # is the body of a function. Returns { text, lines }: the whole
   law, and how many lines stand above the body. stiffness, N/m: for the row LAW; 0: that of the built-in law. */
function lab_whole(text, stiffness = 0) {
  if (/\bdem_contact\s*\*\s*\w+\s*,/.test(text) || /^\s*#/m.test(text)) return { text, lines: 0 };
  const used = [...text.matchAll(/\bmemory\s*\[\s*(\d+)\s*\]/g)].map(found => +found[1] + 1);
  const needs = [[/\bdem_law_(spring|roll_constant)\b/, 3], [/\bdem_law_(mindlin|mindlin_rescaled)\b/, 4],
    [/\bdem_law_hysteretic\b/, 1], [/\bdem_law_roll_epsd\b/, 3]].filter(([word]) => word.test(text)).map(([, many]) => many);
  const memory = Math.max(0, ...used, ...needs), vectors = memory >= 3 ? 1 : 0;
  const normal = /\bdem_law_linear\b/.test(text) ? 'LINEAR' : /\bdem_law_hysteretic\b/.test(text) ? 'HYSTERETIC' : 'HERTZ';
  const head = '/* my_law.h - made in the law lab. Examine it with make law LAW=my_law.h */\n#include <math.h>\n' +
    'static void my_law(const dem_contact *c, dem_real *memory, dem_contact_force *force) {\n    (void)c; (void)memory;\n';
  return { lines: 4, text: head + text.replace(/\s*$/, '\n') + '}\n#ifdef LAW_FILE\n' +
    `#define LAW {"my_law", my_law, 0, ${memory}, ${vectors}, ${stiffness}, DEM_NORMAL_${normal}, -1, 0, 0, 0}\n#endif\n` };
}

async function lab_engine(module, header, files) {
  let law = null, stopped = null, memory = null;
  const stop = (why, line) => {
    throw Object.assign(new Error(why), { law: { line: Math.max(1, line - law.lines), column: 1, text: {
      endless: 'the law does not end: loops and calls repeat more than 100,000 times in one contact',
      deep: 'the law calls itself too often, or its arrays are too large',
      null: 'a pointer leads nowhere (c->user is null if LAW gives no numbers; c->who needs law_who, the 1 after the range in LAW)',
      store: 'the law writes where nothing is its own: only memory, the force and its own variables may change',
      zero: 'an integer is divided by 0' }[why] } });
  };
  const guarded = f => {
    if (stopped) return;
    try { f(); } catch (fault) {
      if (fault.law) stopped = fault.law;
      else if (fault instanceof RangeError || fault instanceof TypeError) stopped = { line: 0, column: 0, text: fault.message };
      else throw fault;
    }
  };
  const system = new Proxy({}, { get: (_, name) => name !== 'clock_time_get' ? () => 52 : (_clock, _precision, to) => {
    new DataView(memory.buffer).setBigUint64(to, BigInt(Math.round(1e6*performance.now())), true);
    return 0;
  } });
  const { exports: dem } = await WebAssembly.instantiate(module, { wasi_snapshot_preview1: system, lab: {
    law: (c, own, force) => guarded(() => law.run.call(law.function, c, own, force)),
    made: (c, own, user) => guarded(() => law.run.call(law.made, c, own, user)) } });
  memory = dem.memory;
  dem._initialize?.();
  const string = a => { const b = new Uint8Array(memory.buffer, a); return new TextDecoder().decode(b.slice(0, b.indexOf(0))); };
  const stack = { at: dem.lab_zone(0), end: dem.lab_zone(1), from: dem.lab_zone(0), until: dem.lab_zone(3) };
  const calls = Object.fromEntries(CALLS.map(name => [name, dem['lab_' + name]]));
  function begin(text, stiffness) {
    const { text: whole, lines } = lab_whole(text, stiffness), unit = translate(whole, { header, files, data: dem.lab_zone(1) });
    const wrong = text => ({ line: 1, column: 1, text });
    stopped = null;
    law = null;
    if (unit.error) {
      const { line, column, file, text } = unit.error;
      return file ? wrong(`${file}, line ${line}: ${text}`) : { line: Math.max(1, line - lines), column, text };
    }
    if (!unit.LAW) return wrong('the text has no line #define LAW {"name", function, numbers, reals of memory, vectors, stiffness}, or ' +
      'this line stands behind an #ifdef that is not LAW_FILE');
    if (unit.size > dem.lab_zone(2) - dem.lab_zone(1)) return wrong('the law has too many numbers of its own');
    law = { lines, whole, run: new Function(unit.code)()(memory, stop, calls, stack) };
    guarded(() => law.run.init());
    if (stopped) return stopped;
    const words = new Int32Array(memory.buffer, unit.LAW, 14), real = new DataView(memory.buffer, unit.LAW);  // as lab_row.h
    Object.assign(law, { function: words[1], made: words[13], name: words[0] ? string(words[0]) : 'my law', memory: words[3],
      vectors: words[4], who: words[12], stiffness: real.getFloat64(24, true), range: real.getFloat64(40, true) });
    if (!law.function) return wrong('the second value of LAW is the function of the law');
    return dem.lab_open(unit.LAW) ? stopped ?? wrong(string(dem.lab_found())) : stopped;
  }
  const failed = code => stopped ?? (code ? { line: 0, column: 0, text: string(dem.lesson_error()) } : null);
  return {
    dem, string,
    /* Translates a law and makes it the one that is in force. */
    open(text) {
      let fault = begin(text, 0);
      if (!fault && law.lines && !/\bdem_law_(hertz|linear|hysteretic)\b/.test(text)) {   // a body: its stiffness is measured
        const { x, y } = this.curve(0);
        let most = 0;
        for (let k = 1; k < x.length; k++) if (x[k] > 0 && x[k - 1] > 0) most = Math.max(most, (y[k] - y[k - 1])/(x[k] - x[k - 1]));
        if (most > 0 && most < Infinity) fault = begin(text, +most.toPrecision(3));
      }
      return stopped ?? fault;
    },
    get law() { return law; },
    /* What has stopped the law, or null. */
    fault() {
      const beyond = dem.lab_beyond();
      return stopped ?? (beyond ? { line: 1, column: 1, text: `the law writes memory[${beyond - 1}], but its row LAW gives it ` +
        `${law.memory} reals: the fourth value of LAW must be ${beyond} or more` } : null);
    },
    lines: dem.lab_lines(),
    asks: k => string(dem.lab_asks(k)),
    line(k) {
      const passed = !stopped && dem.lab_line(k) > 0 && !stopped;
      return { passed, asks: string(dem.lab_asks(k)), found: stopped?.text ?? string(dem.lab_found()) };
    },
    curve(k) {
      const n = dem.lab_curve(k);
      return { x: [...new Float64Array(memory.buffer, dem.lab_x(), n)], y: [...new Float64Array(memory.buffer, dem.lab_y(), n)] };
    },
    scene: (kind, grains, friction, own) => failed(dem.lab_scene(kind, grains, friction, own)),
    step: n => failed(dem.lesson_step(n)),
    grains() { const n = dem.lesson_count(); return new Float32Array(memory.buffer, dem.lesson_grains(), 5*n); },
    walls() { const n = dem.lesson_line_count(); return new Float32Array(memory.buffer, dem.lesson_lines(), 4*n); }
  };
}
if (typeof module !== 'undefined') module.exports = { lab_engine, lab_whole, CALLS };
