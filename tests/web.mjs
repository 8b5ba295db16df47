// node tests/web.mjs DIR [BROWSER PICTURES]: DIR/lesson.html and DIR/lesson as examples/web/make.sh made them. The
// digests of the page's code, in node and in the browser, must be those of the native program; in the browser pictures
// must move and grains be where they are said to be. PICTURES: a folder to put screenshots into. Ends with "N passed, N
// failed".
import { readFileSync } from 'fs';
import { execFileSync } from 'child_process';
import { gunzipSync } from 'zlib';
import { open_page } from './page.mjs';

const [dir, browser, pictures] = process.argv.slice(2);
const page = readFileSync(dir + '/lesson.html', 'utf8');
let passed = 0, failed = 0;
function check(holds, what) {
  if (holds) passed++; else failed++;
  console.log((holds ? 'ok    ' : 'FAILED ') + what);
}
// "drum 500 1000 ..." as the native program answers it
const native = words => (/digest (\w+)/.exec(execFileSync(dir + '/lesson', words.map(String)).toString()) ?? [])[1];

// ---- the page's code in node ----
const code = gunzipSync(Buffer.from(/id="wasm"[^>]*>([^<]*)</.exec(page)[1], 'base64'));
const { instance: { exports: dem } } = await WebAssembly.instantiate(code,
  { wasi_snapshot_preview1: new Proxy({}, { get: () => () => 52 }) });
dem._initialize?.();
const NAMES = ['drum', 'hopper', 'pile'];
for (const [scene, steps, ...sliders] of [
  [0, 3000, 1000, 0.5, 0.5, 10, 1.4], [0, 5000, 400, 1, 0.1, 30, 3], [1, 6000, 1000, 0.5, 0.5, 8, 1.4],
  [1, 3000, 2000, 0, 0.95, 14, 1], [2, 10000, 500, 0.5, 0.5, 3, 1.4], [2, 3000, 3000, 0.2, 0.3, 0.3, 2]]) {
  const bad = dem.lesson_begin(scene, ...sliders) || dem.lesson_step(steps);
  const digest = BigInt.asUintN(64, dem.lesson_hash()).toString(16).padStart(16, '0');
  check(!bad && digest === native([NAMES[scene], steps, ...sliders]),
    `${NAMES[scene]} ${steps} ${sliders.join(' ')}: ${digest}, in node and native`);
}

// ---- the page in a browser ----
// runs in the page: each scene for a while with 2,000 grains; then what it shows is looked at
async function probe() {
  const wait = ms => new Promise(done => setTimeout(done, ms)), $ = id => document.getElementById(id), said = [];
  const set = (id, value) => { $(id).value = value; $(id).dispatchEvent(new Event('input')); };
  await lesson.ready;
  for (const [i, tab] of [...document.querySelectorAll('[data-scene]')].entries()) {
    tab.click();
    set('grains', 2000);
    const first = lesson.frames;
    await wait(6000);
    lesson.go(false);
    await wait(100);
    const view = $('view'), s = lesson.set, many = lesson.dem.lesson_count();
    const grains = new Float32Array(lesson.dem.memory.buffer, lesson.dem.lesson_grains(), 5*many).slice();
    const { width, height } = view;
    const c = new OffscreenCanvas(width, height).getContext('2d', { willReadFrequently: true });
    c.drawImage(view, 0, 0);
    const pixels = c.getImageData(0, 0, width, height).data;
    const there = (x, y) => pixels[4*(Math.floor(x) + width*Math.floor(y)) + 3] > 0;
    let seen = 0;
    for (let k = 0; k < many; k++) {
      const [x, y] = lesson.place(grains[5*k], grains[5*k + 1]);
      seen += x < 0 || x >= width || y >= height || there(x, y);        // or outside the picture
    }
    const corner = there(2, 2);
    const words = [tab.textContent, lesson.dem.lesson_steps(), s.grains, s.friction, s.restitution, s.own, s.ratio];
    const told = { words, digest: lesson.digest(), frames: lesson.frames - first, perSecond: lesson.perSecond,
      ms: lesson.milliseconds, seen, many, corner, error: lesson.error, steps: lesson.steps };
    lesson.go(true);
    for (const value of [0.1, 0.95, 0.3]) { set('restitution', value); set('friction', 1 - value); await wait(200); }
    told.error ||= lesson.error;
    said.push(told);
  }
  await fetch('/said', { method: 'POST', body: JSON.stringify(said) });
}
const run = what => open_page(browser, page, what);
if (browser) {
  const { said, console: lines } =
    await run({ more: `<script>(${probe})()</script>`, flags: ['--remote-debugging-port=0'], wait: 0 });
  check(said !== null, 'the page answers');
  check(!lines.length, 'nothing on the console' + lines.map(line => '\n' + line).join(''));
  for (const told of said ?? []) {
    check(told.digest === native(told.words), `${told.words.join(' ')}: ${told.digest}, in the browser and native`);
    check(!told.error && told.frames > 20 && told.many > 0 && told.seen === told.many && !told.corner,
      `${told.words[0]}: ${told.seen} of ${told.many} grains seen; ${told.perSecond.toFixed(0)} frames per second, ` +
      `${told.ms.toFixed(1)} ms each with ${told.steps} steps${told.error}`);
  }
  for (const scene of pictures ? [0, 1, 2] : [])
    await run({ more: '<script>lesson.ready.then(() => ' +
      `document.querySelectorAll('[data-scene]')[${scene}].click())</script><img src="/slow" hidden>`,
      wait: 25000, flags: [`--screenshot=${pictures}/web_${NAMES[scene]}.png`] });
}
console.log(`${passed} passed, ${failed} failed`);
process.exit(failed ? 1 : 0);
