// node tests/lab.mjs DIR [BROWSER PICTURES]: DIR/lab.html as examples/web/make.sh made it, and DIR/lab_NAME, the same with law
// NAME compiled by a C compiler. What the page translates must give what C gives. In the browser three laws are typed, a
// scene runs, and a link opens the same page. Ends with "N passed, N failed".
import { readFileSync, readdirSync, existsSync } from 'fs';
import { execFileSync } from 'child_process';
import { gunzipSync } from 'zlib';
import { open_page } from './page.mjs';

const [dir, browser, pictures] = process.argv.slice(2);
const page = readFileSync(dir + '/lab.html', 'utf8');
let passed = 0, failed = 0;
function check(holds, what) {
  if (holds) passed++; else failed++;
  console.log((holds ? 'ok    ' : 'FAILED ') + what);
}
const part = id => new RegExp(`<script id="${id}"[^>]*>\\n?([^]*?)</script>`).exec(page)[1];
const scripts = [...page.matchAll(/<script>\n([^]*?)<\/script>/g)].map(found => found[1]);
const { translate, lab_engine, CALLS } = new Function(scripts[0] + scripts[1] + '\nreturn { translate, lab_engine, CALLS };')();
const module = new WebAssembly.Module(gunzipSync(Buffer.from(part('wasm'), 'base64')));
const header = translate(part('header'), { calls: CALLS });
const files = Object.fromEntries([...page.matchAll(/<script [^>]*class="law" data-name="([^"]*)">\n([^]*?)<\/script>/g)]
  .map(([, name, text]) => [name, text]));
check(!header.error, 'the public part of dem.h' + (header.error ? ': ' + header.error.text : ''));

// ---- C in general ----
{
  const text = readFileSync('tests/lab_subset.h', 'utf8') +
    'static void all(double *out) { int k; for (k = 0; k < CASES; k++) out[k] = subset(k); }\nstatic void (*first)(double *) = all;';
  const unit = translate(text, { header: { ...header, names: header.names }, data: 4096 }), memory = { buffer: new ArrayBuffer(65536) };
  const right = execFileSync(dir + '/lab_subset').toString().trim().split('\n').map(Number);
  const run = new Function(unit.code)()(memory, (why, line) => { throw new Error(`${why} in line ${line}`); }, {},
    { at: 16384, end: 32768, from: 1024, until: 65536 });
  run.init();
  run.call(unit.table.indexOf('all') + 1, 40960);
  const mine = [...new Float64Array(memory.buffer, 40960, right.length)], wrong = right.findIndex((v, k) => !Object.is(v, mine[k]));
  check(wrong < 0 && right.length > 30, `${right.length} pieces of C give the numbers of a C compiler` +
    (wrong < 0 ? '' : `: case ${wrong} gives ${mine[wrong]}, not ${right[wrong]}`));
}

// ---- what is wrong is named, with its place ----
for (const [text, line, column, word] of [
  ['force->normal = 1e4*c->overlp;', 1, 24, 'did you mean overlap'], ['force->normal = 1e4*c->overlap', 1, 31, 'a ; is missing'],
  ['double k = 3\nforce->normal = k;', 1, 13, 'a ; is missing'], ['force->normal == 1;', 1, 15, '= assigns'],
  ['c->overlap = 1;', 1, 1, 'copy it first'], ['force.normal = 1;', 1, 6, 'write ->'], ['force->normal = c->slip;', 1, 15, 'dem_vec3'],
  ['dem_vec3 v = c->slip*2;', 1, 21, 'for x, y and z'], ['force->normal = stiff;', 1, 17, 'not known'],
  ['printf("x");', 1, 1, 'nothing else of the C library'], ['force->normal = 2.0^3;', 1, 20, 'pow(x, y)'], ['goto x;', 1, 1, 'goto'],
  ['force->normal = sqrt(1, 2);', 1, 17, 'takes 1 argument'], ['double a[3]; a[3] = 1;', 1, 15, 'outside this array'],
  ['long long n = 3;', 1, 11, '64 bits'], ['return 3;', 1, 8, 'returns nothing'], ['dem_world_step(0, 3);', 1, 1, 'cannot be called'],
  ['dem_law_hertz(c, force, memory);', 1, 18, 'dem_contact_force *'], ['force->normal = law_hertz(c);', 1, 17, 'did you mean dem_law_hertz'],
  ['double f(double x) { return x; }', 1, 20, 'inside another'], ['/* abc', 1, 1, 'no end'], ['#define A', 1, 1, 'no line #define LAW'],
  ['while (c->overlap > 0) force->normal = 0;', 1, 1, 'does not end'], ['double *p = 0; force->normal = *p;', 1, 1, 'leads nowhere'],
  ['force[9].normal = 1;', 1, 1, 'nothing is its own'], ['int k = 0; force->normal = 3/k;', 1, 1, 'divided by 0']]) {
  const lab = await lab_engine(module, header, files), e = lab.open(text);
  check(e && e.text.includes(word) && e.line === line && e.column === column, `${JSON.stringify(text)}: ` +
    (e ? `line ${e.line}, column ${e.column}: ${e.text}` : 'accepted'));
}

// ---- the shipped laws: curves, lines of the exam, scenes as compiled by C ----
let equal = 0, worked = 0, all = 0;
for (const name of Object.keys(files)) {
  const told = execFileSync(`${dir}/lab_${name.replace('.h', '')}`, { maxBuffer: 1 << 26 }).toString().trim().split('\n');
  const lab = await lab_engine(module, header, files), e = lab.open(files[name]);
  check(!e, `${name} is translated` + (e ? `: line ${e.line}: ${e.text}` : ''));
  if (e) continue;
  let worst = 0, lines = 0, same = 0, at = 0;
  for (let k = 0; k < 11; k++) {
    const count = +told[at++].split(' ')[2], mine = lab.curve(k), right = told.slice(at, at += count).map(row => row.split(' ').map(Number));
    const most = Math.max(1e-300, ...right.map(([, y]) => Math.abs(y)));
    if (mine.y.length !== count) worst = Infinity;
    right.forEach(([x, y], i) => { worst = Math.max(worst, Math.abs(mine.y[i] - y)/most, Math.abs(mine.x[i] - x)/Math.max(...mine.x.map(Math.abs))); });
  }
  for (let k = 0; k < lab.lines; k++, lines++) {
    const [, , verdict] = told[at++].split(' '), line = lab.line(k);
    same += line.passed === (verdict === '1');
  }
  check(worst < 1e-9 && same === lines, `${name}: curves differ by ${worst.toExponential(0)} of the largest value, ${same} of ${lines} lines alike`);
  for (let k = 0; k < 5; k++) {
    const [, , steps, measure, hash, rate] = told[at++].split(' '), own = [40, 8, 0.07, 30, 0.1][k];
    const e = lab.scene(k, 200, 0.5, own) ?? lab.step(+steps);
    const near = (a, b) => Math.abs(a - b) <= 1e-6*Math.max(1, Math.abs(b)), mine = lab.dem.lab_rate();
    check(!e && near(lab.dem.lab_measure(), measure) && near(1e6*mine, 1e6*rate), `${name}: scene ${k}, ` +
      `${steps} steps: ` + (e ? e.text : `measure ${lab.dem.lab_measure().toPrecision(6)}, rate ${mine.toPrecision(6)}`));
    worked += k === 0 && mine > 0;
    equal += BigInt.asUintN(64, lab.dem.lesson_hash()).toString(16).padStart(16, '0') === hash;
    all++;
  }
}
check(worked > 0, `the drum works on the grains: power > 0 with ${worked} laws`);
console.log(`      ${equal} of ${all} scenes end with the same digest`);

// ---- laws of a class: what the exam says of each in C, it says here ----
for (const file of existsSync('build/out/verdicts') ? readdirSync('build/out/verdicts').filter(name => name.endsWith('.h')) : []) {
  const name = file.replace('.h', ''), lab = await lab_engine(module, header, files);
  const log = readFileSync(`build/out/verdicts/${name}.txt`, { encoding: 'utf8', flag: 'a+' });
  const right = [...log.matchAll(/^FOUND {3}(.{38})/gm)].map(found => found[1].trim()).filter(line => line !== 'quick');
  let e = lab.open(readFileSync('build/out/verdicts/' + file, 'utf8'));
  const found = [];
  for (let k = 0; !e && k < lab.lines; k++) { const line = lab.line(k); if (!line.passed) found.push(line.asks); e = lab.fault(); }
  check(e ? right.length || !log : found.join() === right.join(), `${name}: ${e ? `line ${e.line}: ${e.text}` : found.join(', ') || 'all lines passed'}`);
}

// ---- the page in a browser ----
async function probe() {
  const said = { laws: [], scenes: [] }, $ = id => document.getElementById(id), wait = ms => new Promise(done => setTimeout(done, ms));
  const type = async text => { $('text').value = text; $('text').dispatchEvent(new Event('input')); await lab.settled(); };
  await lab.ready;
  await lab.settled();
  for (const text of ['force->normal = 1e4*c->overlap + 0.02*c->closing_speed;', 'force->normal = 1e4*c->overlap - 0.02*c->closing_speed;',
    'force->normal = 1e4*c->overlap +;', 'while (1) ;']) {
    const start = performance.now();
    await type(text);
    said.laws.push({ ms: performance.now() - start, said: $('said').textContent, marks: $('marks').textContent,
      found: [...document.querySelectorAll('#exam .found td:nth-child(2)')].map(cell => cell.textContent),
      paths: document.querySelectorAll('#curves path').length, top: Math.max(...(lab.curves[0]?.y ?? [0])) });
  }
  await type('dem_law_hertz(c, memory, force);\ndem_law_mindlin_rescaled(c, memory, force);');
  $('tab_scene').click();
  for (let k = 0; k < 5; k++) {
    lab.choose(k);
    await wait(1500);
    const first = lab.frames, start = performance.now();
    await wait(3000);
    said.scenes.push({ perSecond: 1000*(lab.frames - first)/(performance.now() - start), steps: lab.stepsAFrame, measure: $('measure').textContent,
      rate: $('rate').textContent, error: lab.error?.text ?? '' });
  }
  $('grains').value = 300; $('grains').onchange();
  said.hash = await lab.keep();
  said.state = [lab.text, lab.scene, lab.tab, $('grains').value];
  await fetch('/said', { method: 'POST', body: JSON.stringify(said) });
}
async function again() {
  await lab.ready;
  await lab.settled();
  await fetch('/said', { method: 'POST', body: JSON.stringify([lab.text, lab.scene, lab.tab, document.getElementById('grains').value]) });
}
if (browser) {
  const flags = ['--remote-debugging-port=0'];
  const { said, console: lines } = await open_page(browser, page, { more: `<script>(${probe})()</script>`, flags });
  check(said !== null, 'the page answers');
  check(!lines.length, 'nothing on the console' + lines.map(line => '\n' + line).join(''));
  const [right, gains, syntax, endless] = said?.laws ?? [];
  check(right?.marks === '16/16' && right.paths > 20 && Math.abs(right.top - 0.2) < 0.01, `a right law: ${right?.marks}, largest force ${right?.top} N, ${right?.ms.toFixed(0)} ms`);
  check(gains?.found.includes('no energy from impacts'), `a law that gains energy: ${gains?.found.join(', ')}`);
  check(/line 1, column 33/.test(syntax?.said), `a law with a syntax error: ${syntax?.said}`);
  check(/does not end/.test(endless?.said), `a law that does not end: ${endless?.said}`);
  for (const [k, scene] of (said?.scenes ?? []).entries())
    check(!scene.error && scene.perSecond >= 20 && (k === 3 || scene.steps >= 50), `scene ${k}: ${scene.perSecond.toFixed(0)} frames per second, ${scene.steps} ` +
      `steps each; ${scene.measure} ${scene.error}`);
  const other = await open_page(browser, page, { more: `<script>(${again})()</script>`, flags, hash: said?.hash });
  check(said && JSON.stringify(other.said) === JSON.stringify(said.state), `a link opens the same law and scene: ${JSON.stringify(other.said)}`);
  for (const [name, size, more] of pictures ? [['lab_curves', '1400,960', ''], ['lab_exam', '1400,960', 'document.getElementById("tab_exam").click()'],
    ['lab_scene', '1400,960', 'document.getElementById("tab_scene").click()'], ['lab_phone', '500,900', '']] : [])
    await open_page(browser, page, { more: `<script>lab.ready.then(() => { lab.set_text(files['jkr.h']); ${more} })</script><img src="/slow" hidden>`,
      wait: 9000, size, flags: [`--screenshot=${pictures}/${name}.png`] });
}
console.log(`${passed} passed, ${failed} failed`);
process.exit(failed ? 1 : 0);
