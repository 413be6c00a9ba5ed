// The page in a real browser, with a model that these tests control (tests/support/sample.ts).
import { mkdtempSync, readFileSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import type { Browser, BrowserContextOptions, Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, beforeEach, expect, test } from 'vitest';
import { drawn, open, type Opened, shows, showsInstant, startBrowser } from '../support/browser';
import { canvasPicture, differing, fixSize, matchesGolden } from '../support/golden';
import { exportedPage, MockServer } from '../support/mock_server';
import { clickAt, readOut, text } from '../support/gestures';
import { HOSTILE } from '../support/sample';

let browser: Browser;
let server: MockServer;
let address: string;
let opened: Opened | null = null;

beforeAll(async () => {
  browser = await startBrowser();
});
afterAll(async () => {
  await browser?.close();
});
beforeEach(async () => {
  server = new MockServer();
  address = await server.start();
});
afterEach(async () => {
  await opened?.page.context().close();
  opened = null;
  await server.close();
});

async function start(options: BrowserContextOptions = {}): Promise<Page> {
  opened = await open(browser, address, options);
  await shows(opened.page, server.options.revision ?? 1);
  if (!options.viewport) await fitted(opened.page);
  return opened.page;
}

/** The first view in a picture of fixed size. */
async function fitted(page: Page): Promise<void> {
  await fixSize(page);
  await page.keyboard.press('1');
  await drawn(page);
}

function noErrors(): void {
  expect(opened!.errors).toEqual([]);
}

test('opens: part, source, report, hostile texts as text', async () => {
  const page = await start();
  expect(await text(page, '#name')).toBe('sample.nc');
  expect(await text(page, '#state')).toBe('1 hazard');
  expect(await page.title()).toBe('sample.nc - Kerf');
  expect(await page.locator('#source-list .row').count()).toBe(10);
  await page.click('#tab-problems');
  expect(await text(page, '#problems')).toContain(HOSTILE);
  await page.click('#tab-report');
  const report = await text(page, '#report');
  expect(report).toContain(HOSTILE);
  expect(report).toContain('0:20');
  expect(report).toMatch(/Cuts in Z\s+-4.000 to 0.000 mm|Cuts in Z\s+-4.000 to 5.000 mm/);
  expect(await page.locator('img, body script:not([nonce])').count()).toBe(0);
  await matchesGolden(browser, page, 'open');
  expect(new Set(server.requests)).toEqual(new Set(['/', '/events', '/model', '/mesh', '/path']));
  noErrors();
});

test('live reload shows the new part and keeps the view', async () => {
  const page = await start();
  await page.keyboard.press('3');
  await page.locator('#canvas').focus();
  for (const key of ['ArrowLeft', ...Array<string>(8).fill('ArrowUp'), '+']) await page.keyboard.press(key);
  await page.locator('#tab-source').focus();
  const before = await canvasPicture(page);
  server.change({ depth: 7 });
  await shows(page, 2);
  const after = await canvasPicture(page);
  const changed = await differing(browser, before, after);
  expect(changed).toBeGreaterThan(0.005);
  expect(changed).toBeLessThan(0.4); // the outline of the block is where it was
  server.change({ depth: 4 });
  await shows(page, 3);
  expect(await differing(browser, before, await canvasPicture(page))).toBe(0);
  noErrors();
});

test('only errors are counted, underlined and named first, not the notes before them', async () => {
  const page = await start();
  server.fail([
    { severity: 'note', message: 'a tool from a comment', origin: { file: 'sample.nc', line: 2 } },
    { severity: 'error', message: 'unknown word', origin: { file: 'sample.nc', line: 5, column: 4 } },
    { severity: 'warning', message: 'no feed', origin: { file: 'sample.nc', line: 6 } },
  ]);
  await page.waitForSelector('#stage.outdated');
  expect(await text(page, '#state')).toBe('1 error');
  const parts = await page.locator('#problems').innerText();
  const headings = ['Errors', 'unknown word', 'Warnings and notes', 'a tool from a comment', 'no feed'];
  const found = headings.map((part) => parts.indexOf(part));
  expect(found).toEqual([...found].sort((a, b) => a - b));
  expect(Math.min(...found)).toBeGreaterThanOrEqual(0);
  await page.click('#tab-source');
  expect(await page.locator('#source-list .row.error').count()).toBe(1);
  noErrors();
});

test('an error greys the last good part, its line is a link; its repair shows the part again', async () => {
  const page = await start();
  const good = await canvasPicture(page);
  server.fail([
    {
      severity: 'error',
      message: `unknown word ${HOSTILE}`,
      hint: 'Remove it.',
      origin: { file: 'sample.nc', line: 5, column: 4 },
    },
  ]);
  await page.waitForSelector('#stage.outdated');
  expect(await text(page, '#state')).toBe('1 error');
  expect(await text(page, '#problems')).toContain(`unknown word ${HOSTILE}`);
  await matchesGolden(browser, page, 'error');
  await page.click('text=sample.nc:5:4');
  expect(await page.locator('.row.active').getAttribute('data-line')).toBe('5');
  expect(await page.locator('.row.error').getAttribute('data-line')).toBe('5');
  await page.keyboard.press('Escape');
  server.change({});
  await shows(page, 2);
  expect(await page.locator('#stage.outdated').count()).toBe(0);
  expect(await text(page, '#state')).toBe('1 hazard');
  expect(await differing(browser, good, await canvasPicture(page))).toBe(0);
  noErrors();
});

test('scrubbing shows the part, lines and tool of the instant', async () => {
  const page = await start();
  await page.locator('#time').focus();
  await page.locator('#time').evaluate((e: HTMLInputElement) => {
    e.value = '7';
    e.dispatchEvent(new Event('input'));
  });
  await showsInstant(page, 4);
  expect(await text(page, '#clock')).toBe('0:07.0 / 0:20');
  expect(await text(page, '#motion')).toBe('T1 · cut · line 5 · 800 mm/min');
  expect(await page.locator('.row.running').getAttribute('data-line')).toBe('5');
  await matchesGolden(browser, page, 'scrubbed');
  await page.locator('#tab-source').focus();
  const times = [];
  for (const key of ['.', '.', ',', 'Home', 'End']) {
    await page.keyboard.press(key);
    times.push((await text(page, '#clock')).split(' ')[0]);
  }
  expect(times).toEqual(['0:10.0', '0:11.0', '0:10.0', '0:00.0', '0:20.0']);
  expect(server.requests).toContain('/at');
  noErrors();
});

test('plays and stops at the end', async () => {
  const page = await start();
  await page.selectOption('#speed', '1');
  await page.locator('#canvas').focus();
  await page.keyboard.press(' ');
  expect(await page.locator('#play').getAttribute('aria-label')).toBe('Pause');
  await page.waitForFunction(() => /^0:0[1-9]/.test(document.getElementById('clock')!.textContent!));
  await page.keyboard.press(' ');
  const seconds = Number((await text(page, '#clock')).match(/^0:(\S+)/)![1]);
  expect(seconds).toBeGreaterThanOrEqual(1);
  expect(await page.locator('#play').getAttribute('aria-label')).toBe('Play');
  await page.selectOption('#speed', '1024');
  await page.locator('#canvas').focus();
  await page.keyboard.press(' ');
  await page.waitForFunction(() => document.getElementById('clock')!.textContent!.startsWith('0:20.0'));
  noErrors();
});

test('clicks on surfaces and lines show source lines, a click on a source line its motions', async () => {
  const page = await start();
  await page.click('#show-menu summary');
  await page.uncheck('[data-layer="cuts"]');
  await page.uncheck('[data-layer="rapids"]');
  await clickAt(page, 30, 29.5);
  expect(await text(page, '#state')).toBe('sample.nc:6, called by sample.nc:7');
  expect(
    await page.locator('.row.active').evaluateAll((rows) => rows.map((r) => (r as HTMLElement).dataset.line)),
  ).toEqual(['6', '7']);
  expect(await text(page, '#calls')).toContain('called by sample.nc:7');
  await clickAt(page, 30, 11.5);
  expect(await text(page, '#state')).toBe('sample.nc:5');
  await clickAt(page, 30, 20); // the stock's own top
  expect(await page.locator('.row.active').count()).toBe(0);
  await page.click('#show-menu summary');
  await page.check('[data-layer="rapids"]');
  await clickAt(page, 56.9, 28);
  expect(await text(page, '#state')).toBe('sample.nc:8');
  await page.click('.row[data-line="6"]');
  expect(await text(page, '#state')).toBe('Line 6: 2 motions');
  await page.keyboard.press('ArrowUp');
  await page.keyboard.press('Enter');
  expect(await text(page, '#state')).toBe('Line 5: 1 motion');
  await page.keyboard.press('Home');
  await page.keyboard.press('Enter');
  expect(await text(page, '#state')).toBe('Line 1: no motion');
  await page.click('.row[data-line="7"]');
  await page.keyboard.press('1');
  await matchesGolden(browser, page, 'selected');
  noErrors();
});

test('section plane, position and depth, distance, inches', async () => {
  const page = await start();
  await page.keyboard.press('2');
  await drawn(page);
  const box = (await page.locator('#canvas').boundingBox())!;
  const [x, y, z, depth] = await readOut(page, box.width / 2, box.height / 2);
  expect(x).toBeCloseTo(30, 0);
  expect(y).toBeCloseTo(20, 0);
  expect([z, depth]).toEqual([0, 0]);
  await page.keyboard.press('m');
  await clickAt(page, 20, 10);
  await clickAt(page, 50, 20);
  const measured = (await text(page, '#measured-text'))
    .match(/Distance (\S+) mm\s+X (\S+)\s+Y (\S+)\s+Z (\S+)/)!
    .slice(1)
    .map(Number);
  expect(measured[1]).toBeCloseTo(30, 0);
  expect(measured[2]).toBeCloseTo(10, 0);
  expect(measured[3]).toBe(4);
  expect(measured[0]).toBeCloseTo(Math.hypot(measured[1]!, measured[2]!, measured[3]!), 2);
  await page.keyboard.press('u');
  expect(await text(page, '#measured-text')).toMatch(/^Distance 1\.2\d+ in/);
  await page.keyboard.press('u');
  await page.keyboard.press('m');
  await page.keyboard.press('1');
  await page.keyboard.press('x');
  await page.selectOption('#section-axis', '0');
  expect(await text(page, '#section-text')).toBe('30.000 mm');
  await matchesGolden(browser, page, 'section');
  await page.locator('#section-at').focus();
  await page.keyboard.press('ArrowRight');
  expect(await text(page, '#section-text')).toBe('30.300 mm');
  noErrors();
});

test('settings and the view are remembered over reloads', async () => {
  const page = await start();
  await page.keyboard.press('4');
  await page.keyboard.press('l');
  await page.keyboard.press('u');
  await page.selectOption('#colour', 'depth');
  const before = await canvasPicture(page);
  await page.reload();
  await shows(page, 1);
  await fixSize(page);
  expect(await text(page, '#units')).toBe('inch');
  expect(await page.locator('#colour').inputValue()).toBe('depth');
  expect(await page.locator('html').getAttribute('data-theme')).toBe('dark');
  expect(await differing(browser, before, await canvasPicture(page))).toBeLessThan(0.001);
  await page.keyboard.press('1');
  await matchesGolden(browser, page, 'dark');
  noErrors();
});

test('an exported page opened from disk', async () => {
  const file = join(mkdtempSync(join(tmpdir(), 'kerf-')), 'part.html');
  writeFileSync(file, exportedPage());
  opened = await open(browser, pathToFileURL(file).href, { offline: true });
  const { page } = opened;
  await shows(page, 1);
  expect(await text(page, '#name')).toBe('sample.nc');
  expect(await page.locator('#downloads button').count()).toBe(3); // setup sheet, film and the mesh
  expect(await page.locator('#open').isVisible()).toBe(false);
  await fitted(page);
  await matchesGolden(browser, page, 'exported');
  await clickAt(page, 30, 29.5);
  expect(await text(page, '#state')).toMatch(/^sample.nc:6/);
  await page.keyboard.press('Home');
  expect(await text(page, '#clock')).toBe('0:00.0 / 0:20');
  noErrors();
});

test('a damaged export, a damaged answer and a lost server are reported', async () => {
  const folder = mkdtempSync(join(tmpdir(), 'kerf-'));
  const file = join(folder, 'damaged.html');
  writeFileSync(file, exportedPage().replace(/(id="kerf-mesh"[^>]*>)[^<]{40}/, '$1'));
  opened = await open(browser, pathToFileURL(file).href, { offline: true });
  await opened.page.waitForSelector('#message:visible');
  await opened.page.context().close();

  server.mesh = new Uint8Array([75, 77, 83, 72, 1, 0, 0, 0]).buffer;
  opened = await open(browser, address);
  await opened.page.waitForSelector('#message:visible');
  expect(await text(opened.page, '#message')).toBe('The mesh ends after 8 bytes; more are expected');
  server.mesh = null;
  server.change({});
  await shows(opened.page, 2);
  expect(await opened.page.locator('#message').isVisible()).toBe(false);
  await server.close();
  await opened.page.waitForFunction(
    () => document.getElementById('state')!.textContent === 'Not connected to kerf view',
  );
});

test('a clear message without WebGL', async () => {
  const context = await browser.newContext();
  const page = await context.newPage();
  await page.addInitScript(() => {
    HTMLCanvasElement.prototype.getContext = (() => null) as typeof HTMLCanvasElement.prototype.getContext;
  });
  await page.goto(address);
  await page.waitForSelector('#message:visible');
  expect(await text(page, '#message')).toContain('WebGL');
  await context.close();
});

test('on a phone everything is inside the window', async () => {
  const page = await start({
    viewport: { width: 390, height: 800 },
    hasTouch: true,
    isMobile: true,
    deviceScaleFactor: 1,
  });
  for (const id of ['canvas', 'source-list', 'time', 'play', 'colour']) {
    const box = (await page.locator(`#${id}`).boundingBox())!;
    expect(box.height, id).toBeGreaterThan(10);
    expect(box.y + box.height, id).toBeLessThanOrEqual(800);
  }
  expect(await page.evaluate(() => document.documentElement.scrollWidth)).toBeLessThanOrEqual(390);
  await fixSize(page, 390, 359);
  await page.keyboard.press('1');
  await matchesGolden(browser, page, 'phone');
  noErrors();
});

test.each(['light', 'dark'] as const)('accessibility, %s', async (colorScheme) => {
  const page = await start({ colorScheme });
  const axe = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');
  const check = async () => {
    const found = await page.evaluate(async () => {
      const { violations } = await (
        globalThis as unknown as {
          axe: {
            run(): Promise<{
              violations: {
                id: string;
                impact: string;
                nodes: { html: string }[];
              }[];
            }>;
          };
        }
      ).axe.run();
      return violations
        .filter((v) => v.impact === 'serious' || v.impact === 'critical')
        .map((v) => `${v.id}: ${v.nodes.map((n) => n.html).join(' ')}`);
    });
    expect(found).toEqual([]);
  };
  await page.evaluate(axe); // by the debugger, so that the page's policy stays as it is
  await check();
  for (const tab of ['problems', 'report']) {
    await page.click(`#tab-${tab}`);
    await check();
  }
  await page.keyboard.press('x');
  await page.keyboard.press('?');
  await check();
  await page.keyboard.press('Escape');
  server.fail([{ severity: 'error', message: 'wrong', origin: { file: 'sample.nc', line: 5 } }]);
  await page.waitForSelector('#stage.outdated');
  await check();
});
