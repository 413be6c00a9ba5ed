// The page without a server, from a server of static files, in a real browser: opening, editing, errors,
// stopping.
import type { Browser, Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, expect, test } from 'vitest';
import { drawn, open, type Opened, PATIENCE, shows, startBrowser } from '../support/browser';
import { canvasPicture, differing } from '../support/golden';
import { text } from '../support/gestures';
import { PLATE } from '../support/plate';
import { StaticServer } from '../support/static_server';

const SITE = process.env.KERF_SITE ?? '';
let browser: Browser;
let server: StaticServer;
let opened: Opened | null = null;

beforeAll(async () => {
  server = await StaticServer.start(SITE);
  browser = await startBrowser();
});
afterEach(async () => {
  await opened?.page.context().close();
  opened = null;
});
afterAll(async () => {
  await browser?.close();
  await server?.end();
});

async function start(): Promise<Page> {
  opened = await open(browser, `${server.address}?src=plate.gcmc`);
  await shows(opened.page, 1);
  return opened.page;
}

async function drop(page: Page, name: string, content: string): Promise<void> {
  const before = Number(await page.locator('html').getAttribute('data-revision'));
  await page.click('#open');
  await page.setInputFiles('#open-file', { name, mimeType: 'text/plain', buffer: Buffer.from(content) });
  await shows(page, before + 1);
}

test('a program of the page, then a file of the user, which is edited', async () => {
  const page = await start();
  expect(await text(page, '#name')).toBe('plate.gcmc');
  await drop(page, 'slot.nc', PLATE);
  expect(await text(page, '#name')).toBe('slot.nc');
  expect(await page.inputValue('#editor-text')).toBe(PLATE);
  await page.keyboard.press('2');
  const first = await canvasPicture(page);

  await page.fill('#editor-text', PLATE.replace('Y10', 'Y20'));
  await shows(page, 3);
  expect(await differing(browser, first, await canvasPicture(page))).toBeGreaterThan(0.005);

  await page.fill('#editor-text', PLATE.replace('G1 X35 F400', 'G1 X35 F400 ['));
  await page.waitForSelector('#stage.outdated');
  expect(await text(page, '#editor-state')).toMatch(/^slot\.nc:8/);
  await page.fill('#editor-text', PLATE);
  await page.waitForSelector('#stage:not(.outdated)');
  await shows(page, 4);
  expect(await page.locator('#editor-state').isVisible()).toBe(false);
  expect(await differing(browser, first, await canvasPicture(page))).toBe(0);
  expect(opened!.errors).toEqual([]);
});

test('typing is followed, and a file with an error as the first one can be repaired', async () => {
  const page = await start();
  await page.click('#open');
  const bad = PLATE.replace('M2', 'M2 [');
  const file = { name: 'bad.nc', mimeType: 'text/plain', buffer: Buffer.from(bad) };
  await page.setInputFiles('#open-file', file);
  await page.waitForSelector('#editor-state:not([hidden])');
  expect(await page.inputValue('#editor-text')).toBe(bad);
  await page.locator('#editor-text').press('Control+End');
  for (const key of ['ArrowLeft', 'Backspace']) await page.keyboard.press(key);
  await page.waitForFunction(() => document.title.startsWith('bad.nc'), null, { timeout: PATIENCE });
  expect(await text(page, '#name')).toBe('bad.nc');
  expect(opened!.errors).toEqual([]);
});

test('states on the way, and a download', async () => {
  const page = await start();
  await drop(page, 'slot.nc', PLATE);
  await page.keyboard.press('2');
  await drawn(page);
  const finished = await canvasPicture(page);
  await page.keyboard.press('Home');
  await page.waitForFunction(() => /^\d+$/.test(document.documentElement.dataset.instant ?? ''));
  await drawn(page);
  expect(await differing(browser, finished, await canvasPicture(page))).toBeGreaterThan(0.005);
  await page.click('#download-menu summary');
  const [file] = await Promise.all([
    page.waitForEvent('download'),
    page.selectOption('#downloads select', 'grbl'),
  ]);
  expect(file.suggestedFilename()).toBe('slot.nc');
  expect(opened!.errors).toEqual([]);
});

test('a program without end is stopped, and the page works on', async () => {
  const page = await start();
  await page.fill('#editor-text', 'while(1) { x = 1; }\n');
  await page.waitForTimeout(500);
  await page.evaluate(() => document.getElementById('stop')!.click());
  await page.waitForFunction(() => document.getElementById('state')!.textContent === 'stopped');
  // Revisions start over, so that the one of the part before comes again.
  await page.fill('#editor-text', 'goto([1mm, 1mm, 1mm]);\nfeedrate(100mm);\nmove([5mm, 1mm, -1mm]);\n');
  await page.waitForFunction(() => document.getElementById('state')!.textContent === 'Up to date');
  expect(await text(page, '#name')).toBe('plate.gcmc');
  expect(opened!.errors).toEqual([]);
});
