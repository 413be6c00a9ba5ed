// The page without a server in a frame: programs are loaded by messages of the page around it.
import type { Browser } from 'playwright-core';
import { afterAll, beforeAll, expect, test } from 'vitest';
import { open, startBrowser } from '../support/browser';
import { ask, framingPage, hears, viewer } from '../support/framing';
import { PLATE } from '../support/plate';
import { StaticServer } from '../support/static_server';

let browser: Browser;
let server: StaticServer;

beforeAll(async () => {
  server = await StaticServer.start(process.env.KERF_SITE ?? '', {
    'around.html': framingPage('index.html?src=plate.gcmc'),
    'favicon.ico': '',
  });
  browser = await startBrowser();
});
afterAll(async () => {
  await browser?.close();
  await server?.end();
});

test('a program is loaded, its errors and findings are heard, and it is repaired', async () => {
  const { page, errors } = await open(browser, `${server.address}around.html`);
  const first = await hears(page, { event: 'ready' });
  expect(first).toMatchObject({ name: 'plate.gcmc' });
  expect(first.actions).toContain('load');
  const load = (text: string) => ask(page, { do: 'load', name: 'slot.nc', text });

  expect(await load(PLATE.replace('G0 Z5\nM2', 'G0 X20 Y25\nG0 Z5\nM2'))).toMatchObject({ ok: true });
  const loaded = await hears(page, { event: 'ready', name: 'slot.nc' });
  expect(loaded).toMatchObject({ findings: 1, files: ['slot.nc'] });
  const { finding } = (await hears(page, { event: 'finding' })) as { finding: object };
  expect(finding).toMatchObject({ kind: 'rapid_in_stock', origin: { file: 'slot.nc', line: 9 } });
  expect(await ask(page, { do: 'line', line: 8 })).toMatchObject({ ok: true });
  expect(await hears(page, { event: 'line', line: 8 })).toMatchObject({ file: 'slot.nc' });

  expect(await load(PLATE.replace('G1 X35 F400', 'G1 X35 F400 ['))).toMatchObject({ ok: true });
  const { diagnostics } = (await hears(page, { event: 'errors' })) as { diagnostics: object[] };
  expect(diagnostics[0]).toMatchObject({ severity: 'error', origin: { file: 'slot.nc', line: 8 } });
  await load(PLATE);
  expect(await hears(page, { event: 'ready', name: 'slot.nc', findings: 0 })).toBeTruthy();
  expect(await viewer(page).locator('#editor-text').inputValue()).toBe(PLATE);
  expect(await load('')).toMatchObject({ ok: false, expected: 'text: the text of the program' });
  expect(errors).toEqual([]);
  await page.context().close();
});
