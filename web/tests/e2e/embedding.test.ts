// The viewer in a frame of another page, which steers it by messages: the exported page as in the manual's
// example, pages of other origins, the served page only where its user allows it.
import { pathToFileURL } from 'node:url';
import type { Page } from 'playwright-core';
import { afterEach, expect, test } from 'vitest';
import { open, type Opened } from '../support/browser';
import { kerf, ViewServer } from '../support/command';
import { browser, folder, useBrowserAndFolder } from '../support/fixture';
import { ask, examplePage, framingPage, heard, hears, viewer } from '../support/framing';
import { PLATE } from '../support/plate';
import { StaticServer } from '../support/static_server';

// A rapid through the material in line 9.
const COLLISION = PLATE.replace('G0 Z5\nM2', 'G0 X20 Y25\nG0 Z5\nM2');
const SANDBOX = 'sandbox="allow-scripts allow-downloads"';
const servers: { end(): Promise<unknown> }[] = [];
let opened: Opened | null = null;

useBrowserAndFolder();
afterEach(async () => {
  await opened?.page.context().close();
  opened = null;
  for (const server of servers.splice(0)) await server.end();
  folder.remove();
});

function exported(...options: string[]): void {
  const program = folder.write('plate.nc', COLLISION);
  const out = `${folder.path}/part.html`;
  kerf('view', program, '--resolution', '0.5', '--columns', '--export', out, ...options);
}

async function serve(pages: Record<string, string>): Promise<StaticServer> {
  const server = await StaticServer.start(folder.path, pages);
  servers.push(server);
  return server;
}

async function show(address: string): Promise<Page> {
  opened = await open(browser, address);
  return opened.page;
}

test('the example of the manual: an exported page is steered and heard', async () => {
  exported();
  const page = await show((await serve({ 'index.html': examplePage(), 'favicon.ico': '' })).address);
  const reported = async (test: (one: Record<string, unknown>) => boolean) => {
    for (;;) {
      const texts = await page.locator('#heard li').allInnerTexts();
      const found = texts.map((t) => JSON.parse(t) as Record<string, unknown>).find(test);
      if (found) return found;
      await page.waitForTimeout(50);
    }
  };
  const ready = await reported((one) => one.event === 'ready');
  expect(ready).toMatchObject({ kerf: 1, name: 'plate.nc', findings: 1 });
  expect(ready.colours).toEqual(['tool', 'depth', 'step', 'speed']);
  expect(ready.actions).not.toContain('load');
  const { finding } = (await reported((one) => one.event === 'finding')) as { finding: object };
  expect(finding).toMatchObject({ kind: 'rapid_in_stock', origin: { line: 9 } });

  await page.click('text="Line 8"');
  expect(await reported((one) => one.event === 'line')).toMatchObject({ line: 8 });
  expect(await viewer(page).locator('.row.current').innerText()).toContain('G1 X35 F400');
  await page.click('text="By depth"');
  await reported((one) => one.id === 2 && one.ok === true);
  expect(await viewer(page).locator('#colour').inputValue()).toBe('depth');
  await page.click('text="Play"');
  await reported((one) => one.event === 'line' && one.line === 7); // plunging
  await page.click('text="Stop"');
  await reported((one) => one.id === 4 && one.ok === true);
  expect(await viewer(page).locator('#play').getAttribute('aria-label')).toBe('Play');
  expect(opened!.errors).toEqual([]);
});

test('a wrong message gets an answer with what was expected', async () => {
  exported();
  const page = await show((await serve({ 'index.html': framingPage('part.html', SANDBOX) })).address);
  await hears(page, { event: 'ready' });
  const wrong: [Record<string, unknown>, RegExp, RegExp][] = [
    [{ kerf: 3, do: 'play' }, /kerf is not 1/, /\{kerf: 1, do:/],
    [{ do: 'dance' }, /names no action/, /"line" \| "colour"/],
    [{ do: 'line', line: 99 }, /plate.nc has no line 99/, /^line: 1 to 12$/],
    [{ do: 'line', line: 1, file: 'other.nc' }, /no such file/, /^file: one of .*plate.nc$/],
    [{ do: 'colour', colour: 'flow' }, /does not apply/, /^colour: one of tool, depth, step, speed$/],
    [{ do: 'load', name: 'a.nc', text: 'G0 X1' }, /shows one program/, /without a server/],
  ];
  for (const [message, error, expected] of wrong) {
    const answer = await ask(page, message);
    expect(answer.ok).toBe(false);
    expect(answer.error).toMatch(error);
    expect(answer.expected).toMatch(expected);
  }
  expect(await ask(page, { do: 'line', line: 8, file: 'plate.nc' })).toMatchObject({ ok: true });
  // Of a page that listens late.
  const before = (await heard(page)).length;
  await ask(page, { do: 'hello' });
  expect((await heard(page)).slice(before).map((one) => one.event)).toEqual(['ready', 'finding', undefined]);
});

test('a page of another origin hears nothing, unless it was allowed', async () => {
  exported();
  const files = await serve({});
  const around = await serve({ 'index.html': framingPage(`${files.address}part.html`) });
  const page = await show(around.address);
  await viewer(page).waitForSelector('html[data-revision]');
  const refused = await ask(page, { do: 'hello' });
  expect(refused).toMatchObject({ ok: false, error: 'messages of this origin are not taken' });
  expect((await ask(page, { do: 'play' })).ok).toBe(false);
  expect((await heard(page)).filter((one) => one.event)).toEqual([]);
  expect(JSON.stringify(await heard(page))).not.toContain('plate');

  exported('--frame-in', new URL(around.address).origin);
  await page.reload();
  const from = new URL(files.address).origin;
  expect(await hears(page, { event: 'ready' })).toMatchObject({ name: 'plate.nc', from });
  expect((await ask(page, { do: 'line', line: 8 })).ok).toBe(true);
});

test('messages of other windows than the one around are not taken', async () => {
  exported();
  const page = await show((await serve({ 'index.html': framingPage('part.html') })).address);
  await hears(page, { event: 'ready' });
  // From inside, as by a script of a browser extension.
  await viewer(page).evaluate(() => window.postMessage({ kerf: 1, id: 'own', do: 'line', line: 8 }, '*'));
  // From a second frame of the same origin.
  await page.evaluate(async () => {
    const other = document.createElement('iframe');
    document.body.append(other);
    const send = other.contentWindow!.document.createElement('script');
    send.textContent = "parent.frames[0].postMessage({ kerf: 1, id: 'other', do: 'line', line: 8 }, '*')";
    other.contentWindow!.document.body.append(send);
  });
  await ask(page, { do: 'hello' });
  const carriedOut = (await heard(page)).filter(
    ({ id, event }) => id === 'own' || id === 'other' || event === 'line',
  );
  expect(carriedOut).toEqual([]);
});

test('an exported file from disk in a page from disk', async () => {
  exported();
  const page = await show(pathToFileURL(folder.write('index.html', framingPage('part.html'))).href);
  await hears(page, { event: 'ready' });
  expect((await ask(page, { do: 'line', line: 8 })).ok).toBe(true);
  expect(await hears(page, { event: 'line' })).toMatchObject({ line: 8 });
});

test('the served page is framed only by an allowed page, which does not get its token', async () => {
  const pages: Record<string, string> = {};
  const around = await serve(pages);
  const { origin } = new URL(around.address);
  const program = folder.write('plate.nc', COLLISION);
  const closed = await ViewServer.start(program);
  servers.push(closed);
  pages['index.html'] = framingPage(closed.address);
  const page = await show(around.address);
  await page.waitForTimeout(1000);
  expect(await viewer(page).locator('#canvas').count()).toBe(0);
  expect(await heard(page)).toEqual([]);

  const framed = await ViewServer.start(program, '--frame-in', origin);
  servers.push(framed);
  pages['index.html'] = framingPage(framed.address);
  await page.reload();
  const ready = await hears(page, { event: 'ready' });
  expect(ready).toMatchObject({ name: 'plate.nc', from: new URL(framed.address).origin });
  expect((await ask(page, { do: 'line', line: 8 })).ok).toBe(true);
  // A save is an event, too; then one with an error.
  folder.write('plate.nc', PLATE);
  expect(await hears(page, { event: 'ready', findings: 0 })).toMatchObject({ revision: 2 });
  folder.write('plate.nc', PLATE.replace('M2', 'M2 ['));
  const { diagnostics } = (await hears(page, { event: 'errors' })) as { diagnostics: { severity: string }[] };
  expect(diagnostics[0]!.severity).toBe('error');
  const token = new URL(framed.address).searchParams.get('t')!;
  expect(JSON.stringify(await heard(page))).not.toContain(token);
  expect(await ask(page, { do: 'load', name: 'a.nc', text: 'G0 X1' })).toMatchObject({ ok: false });
});
