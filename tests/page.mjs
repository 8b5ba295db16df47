// open_page(BROWSER, PAGE, { more, flags, wait, hash, size }): opens a page in a headless Chromium and answers what it posts to
// /said, and what it wrote to its console. more: HTML behind the page, as a script that posts, or the picture /slow, which
// holds a screenshot back for `wait` ms.
import { mkdtempSync, rmSync } from 'fs';
import { createServer } from 'http';
import { spawn } from 'child_process';
import { tmpdir } from 'os';

export function open_page(browser, page, what) {
  return new Promise(done => {
    const home = mkdtempSync(tmpdir() + '/web-');
    let said = null, log = '', child;
    const server = createServer((asked, answer) => {
      if (asked.url === '/slow') return void setTimeout(() => answer.end(), what.wait);     // holds the load event back
      if (asked.url !== '/said') return void answer.end(asked.url === '/' ? page + (what.more ?? '') : '');
      let body = '';
      asked.on('data', part => { body += part; });
      asked.on('end', () => { answer.end(); said = JSON.parse(body); child.kill(); });
    });
    server.listen(0, '127.0.0.1', () => {
      child = spawn(browser, ['--headless', '--no-sandbox', '--user-data-dir=' + home, `--window-size=${what.size ?? '1200,760'}`,
        '--disable-quic', '--disable-background-networking', '--enable-logging=stderr', ...what.flags,
        `http://127.0.0.1:${server.address().port}/${what.hash ?? ''}`]);
      child.stderr.on('data', part => { log += part; });
      const late = setTimeout(() => child.kill(), 120000);
      child.on('close', () => {
        clearTimeout(late);
        server.close(); server.closeAllConnections?.();
        rmSync(home, { recursive: true, force: true });
        done({ said, console: log.split('\n').filter(line => /CONSOLE/.test(line) && !/favicon/.test(line)) });
      });
    });
  });
}
