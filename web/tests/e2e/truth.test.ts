// The page shows no old part as the present one: over restarts of the server, while a slow program is read,
// and after a first load with errors.
import { createServer } from 'node:net';
import type { AddressInfo } from 'node:net';
import type { Page } from 'playwright-core';
import { afterEach, expect, test } from 'vitest';
import { drawn, open, type Opened, shows } from '../support/browser';
import { ViewServer } from '../support/command';
import { browser, folder, useBrowserAndFolder } from '../support/fixture';
import { text } from '../support/gestures';
import { canvasPicture, differing } from '../support/golden';
import { PLATE } from '../support/plate';

let server: ViewServer | null = null;
let opened: Opened | null = null;

useBrowserAndFolder();
afterEach(async () => {
  await opened?.page.context().close();
  opened = null;
  await server?.end();
  server = null;
  folder.remove();
});

async function freePort(): Promise<string> {
  const probe = createServer();
  await new Promise<void>((done) => probe.listen(0, '127.0.0.1', done));
  const { port } = probe.address() as AddressInfo;
  await new Promise((done) => probe.close(done));
  return String(port);
}

const TOKEN = 'a-secret-of-this-test';
const state = (page: Page) => text(page, '#state');

/** A print of a square, its layers 0.2 mm thick. */
function print(layers: number): string {
  const lines = ['M82', 'G28'];
  for (let k = 1, e = 0; k <= layers; ++k) {
    lines.push(`G1 X10 Y10 Z${(0.2 * k).toFixed(1)} F3000`);
    for (const [x, y] of [[30, 10], [30, 30], [10, 30], [10, 10.5]])
      lines.push(`G1 X${x} Y${y} E${(e += 1).toFixed(1)} F1200`);
  }
  return `${lines.join('\n')}\n`;
}

const bar = (z: number) =>
  `T102 M6\nM3 S10000\nG0 X10 Y0 Z15 A0\nG1 Z${z} F100\nG1 X30 A360 F400\nG0 Z15\nM2\n`;
const long = (y: number) =>
  PLATE.replace(
    'G1 X35 F400',
    Array.from({ length: 20_000 }, (_, i) => `G1 X${5 + (i % 300) / 10} Y${y} F400`).join('\n'),
  );

const restarts: [string, string, string, string, string[]][] = [
  ['milling', 'part.nc', PLATE, PLATE.replace('Y10', 'Y22'), []],
  ['milling with exact edges', 'part.nc', PLATE, PLATE.replace('Y10', 'Y22'), ['--exact']],
  ['a bar', 'part.nc', bar(8), bar(4), ['--rotary', 'd=20 length=40']],
  ['a print', 'part.gcode', print(3), print(20), []],
  ['a long program', 'part.nc', long(10), long(22), []],
];

test.each(restarts)('a restart of the server under an open page: %s', async (...row) => {
  const [, name, before, after, options] = row;
  const port = await freePort();
  const file = folder.write(name, before);
  const same = ['--port', port, '--token', TOKEN, ...options];
  server = await ViewServer.start(file, ...same);
  opened = await open(browser, server.address);
  await shows(opened.page, 1);
  await opened.page.evaluate(() => (document.documentElement.dataset.before = 'yes'));
  expect(await server.end()).toBe(0);
  await opened.page.waitForSelector('#stage.lost');
  folder.write(name, after);
  server = await ViewServer.start(file, ...same);
  await opened.page.waitForSelector('html:not([data-before])[data-revision="1"]');
  const fresh = await open(browser, server.address);
  await shows(fresh.page, 1);
  if (options.includes('--exact'))
    for (const { page } of [opened, fresh]) await page.waitForSelector('html[data-exact="1"]');
  // The page remembers the view of the program.
  for (const { page } of [opened, fresh]) {
    await page.keyboard.press('1');
    await drawn(page);
  }
  expect(await differing(browser, await canvasPicture(opened.page), await canvasPicture(fresh.page))).toBe(0);
  expect(await state(opened.page)).toBe(await state(fresh.page));
  await fresh.page.context().close();
});

const script = (seconds: number, z: number) => `import time
import kerf
time.sleep(${seconds})
path = kerf.Toolpath()
path.tool(102)
path.spindle(16000)
path.rapid((5, 5, 5))
path.cut((5, 5, ${z}), feed=100)
path.cut((25, 5, ${z}), feed=400)
path.rapid((25, 5, 5))
kerf.simulate(path, kerf.Stock.block((30, 10, 6)))
`;

test('while a script computes the page says so at once, greys the old part and can stop it', async () => {
  const file = folder.write('part.py', script(0, -2));
  server = await ViewServer.start(file);
  opened = await open(browser, server.address);
  const { page } = opened;
  await shows(page, 1);
  await page.evaluate(() => {
    new MutationObserver(() => (document.documentElement.dataset.changed ??= String(Date.now()))).observe(
      document.getElementById('state')!,
      { childList: true, characterData: true, subtree: true },
    );
  });
  const saved = Date.now();
  folder.write('part.py', script(60, -4));
  await page.waitForFunction(() => document.getElementById('state')!.textContent === 'reading…');
  const noticed = Number(await page.locator('html').getAttribute('data-changed'));
  expect(noticed - saved).toBeLessThan(300);
  await page.waitForSelector('#stage.working');
  // A page that is opened now knows it as well.
  const second = await open(browser, server.address);
  await second.page.waitForSelector('#stage.working');
  expect(await state(second.page)).toBe('reading…');
  await second.page.context().close();
  await page.click('#stop');
  await page.waitForSelector('#stage.outdated:not(.working)');
  expect(await text(page, '#problems')).toContain('stopped');

  folder.write('part.py', script(0, -4));
  await shows(page, 2);
  expect(await state(page)).toBe('Up to date');
  expect(await page.locator('#stage').getAttribute('class')).not.toMatch(/working|outdated/);
});

test('a first load with an error shows the source, its line and the message', async () => {
  const file = folder.write('part.nc', PLATE.replace('G1 X35 F400', 'G1 X35 F400 ['));
  server = await ViewServer.start(file);
  opened = await open(browser, server.address);
  const { page } = opened;
  await page.waitForSelector('.row.error');
  expect(await page.locator('.row.error').getAttribute('data-line')).toBe('8');
  expect(await text(page, '#name')).toBe('part.nc');
  expect(await text(page, '#message')).toContain('part.nc:8');
  folder.write('part.nc', PLATE);
  await shows(page, 1);
  expect(await page.locator('#message').isVisible()).toBe(false);
  expect(await state(page)).toBe('Up to date');
});
