// What leaves the page, and what comes in: the exported file plays the removal and has downloads, films are
// never empty, G-code for every controller, the console, scripts that ask first.
import { readFileSync } from 'node:fs';
import { pathToFileURL } from 'node:url';
import type { Download, Page } from 'playwright-core';
import { afterEach, expect, test } from 'vitest';
import { drawn, open, type Opened, shows, showsInstant } from '../support/browser';
import { kerf, ViewServer } from '../support/command';
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

async function start(name: string, program: string, ...options: string[]): Promise<Page> {
  server = await ViewServer.start(folder.write(name, program), ...options);
  opened = await open(browser, server.address);
  await shows(opened.page, 1);
  return opened.page;
}

async function download(page: Page, act: () => Promise<unknown>): Promise<[Download, Buffer]> {
  if (!(await page.locator('#downloads').isVisible())) await page.click('#download-menu summary');
  const [file] = await Promise.all([page.waitForEvent('download'), act()]);
  return [file, readFileSync(await file.path())];
}

type V = [number, number, number];

/** What the triangles of a binary STL file enclose, mm3. */
function volumeOf(stl: Buffer): number {
  let sum = 0;
  for (let at = 84; at < stl.length; at += 50) {
    const corner = (k: number) => [0, 4, 8].map((i) => stl.readFloatLE(at + k + i)) as V;
    const [a, b, c] = [corner(12), corner(24), corner(36)];
    for (const [i, j, k] of [[0, 1, 2], [1, 2, 0], [2, 0, 1]] as const)
      sum += a[i] * (b[j] * c[k] - b[k] * c[j]);
  }
  return sum / 6;
}

test('the exported page plays the removal, and has a mesh and G-code', async () => {
  const part = folder.write('plate.nc', PLATE);
  kerf('view', part, '--resolution', '0.1', '--columns', '--export', `${folder.path}/part.html`);
  opened = await open(browser, pathToFileURL(`${folder.path}/part.html`).href, { offline: true });
  const { page, errors } = opened;
  await shows(page, 1);
  for (const layer of ['cuts', 'rapids', 'tool'])
    await page.locator(`[data-layer="${layer}"]`).evaluate((e: HTMLInputElement) => e.click());
  await page.keyboard.press('2');
  await drawn(page);
  const finished = await canvasPicture(page);
  await page.keyboard.press('Home');
  await page.waitForFunction(() => document.documentElement.dataset.instant !== 'end');
  await drawn(page);
  const untouched = await canvasPicture(page);
  expect(await differing(browser, finished, untouched)).toBeGreaterThan(0.01); // the slot is not there yet
  await page.keyboard.press('End');
  await showsInstant(page, 'end');
  expect(await differing(browser, finished, await canvasPicture(page))).toBeLessThan(0.001);

  const [, stl] = await download(page, () => page.click('#downloads >> text="Mesh (STL)"'));
  expect(stl.length).toBe(84 + 50 * stl.readUInt32LE(80));
  // The volume of the mesh is that of the plate less the slot.
  const slot = 30 * 3.175 + Math.PI * 1.5875 ** 2; // mm2, 1 mm deep
  expect(Math.abs(volumeOf(stl) - (40 * 30 * 6 - slot))).toBeLessThan(0.03 * slot);
  const [file, gcode] = await download(page, () => page.selectOption('#downloads select', 'grbl'));
  expect(file.suggestedFilename()).toBe('plate.nc');
  expect(gcode.toString()).toMatch(/X35/);
  expect(errors).toEqual([]);
});

test('a film at the highest speed has at least 2 s', async () => {
  const page = await start('plate.nc', PLATE);
  await page.selectOption('#speed', '1024');
  const before = Date.now();
  const [, film] = await download(page, () => page.click('#downloads >> text="Film (WebM)"'));
  expect(Date.now() - before).toBeGreaterThan(2000);
  expect(film.subarray(0, 4).toString('hex')).toBe('1a45dfa3');
  expect(film.length).toBeGreaterThan(2000);
});

test('the program for every target of kerf post, own posts and languages of machines too', async () => {
  folder.write('mill.toml', 'name = "mill"\nbase = "grbl"\nfile_ending = ".tap"\n');
  const page = await start('plate.nc', PLATE);
  const offered = await page.locator('#downloads select option').allTextContents();
  const listed = kerf('post', '--list');
  for (const name of ['grbl', 'linuxcnc', 'fanuc', 'mach3', 'shopbot', 'rml', 'svg']) {
    expect(offered).toContain(name);
    expect(listed).toContain(name);
  }
  const [, gcode] = await download(page, () => page.selectOption('#downloads select', 'linuxcnc'));
  expect(gcode.toString()).toContain(', linuxcnc)');
  const [bot, opensbp] = await download(page, () => page.selectOption('#downloads select', 'shopbot'));
  expect(bot.suggestedFilename()).toBe('plate.sbp');
  expect(opensbp.toString()).toMatch(/^M3,/m);
  const [own] = await download(page, () => page.selectOption('#downloads select', 'mill.toml'));
  expect(own.suggestedFilename()).toBe('plate.tap');
});

const SCRIPT = `import kerf
print('depth', 2)
path = kerf.Toolpath()
path.tool(102)
path.spindle(16000)
path.rapid((5, 5, 5))
path.cut((5, 5, -2), feed=100)
path.cut((25, 5, -2), feed=400)
path.rapid((25, 5, 5))
kerf.simulate(path, kerf.Stock.block((30, 10, 6)))
`;

test('a script of the folder asks before it runs; what it prints is in the console', async () => {
  folder.write('part.py', SCRIPT);
  const page = await start('plate.nc', PLATE);
  expect(await page.locator('#tab-console').isVisible()).toBe(false);
  await page.keyboard.press('o');
  await page.click('#open-names >> text="part.py"');
  expect(await text(page, '#open-names')).toContain('It runs with all your rights');
  expect(await text(page, '#name')).toBe('plate.nc');
  await page.click('#open-names >> text="Run part.py"');
  await page.waitForFunction(() => document.getElementById('name')!.textContent === 'part.py');
  await page.click('#tab-console');
  expect(await text(page, '#console-text')).toBe('depth 2\n');
});

test('messages of gcmc lead from the console to their lines', async () => {
  const page = await start(
    'part.gcmc',
    'feedrate(100mm);\ngoto([0mm, 0mm, 5mm]);\nmessage("depth ", 2mm);\nmove([9mm, 0mm, -2mm]);\n',
  );
  await page.click('#tab-console');
  expect(await text(page, '#console-text')).toMatch(/part\.gcmc:3:\d+: Runtime message\(\): depth 2mm\n$/);
  await page.click('#console-text button');
  expect(await page.locator('.row.current').innerText()).toContain('message("depth ", 2mm);');
});

test('a plain DXF drawing shows its outlines', async () => {
  const rows: (string | number)[] = [
    ...[0, 'SECTION', 2, 'HEADER', 9, '$INSUNITS', 70, 4, 0, 'ENDSEC'],
    ...[0, 'SECTION', 2, 'ENTITIES'],
  ];
  for (const [x, y, u, v] of [[0, 0, 30, 0], [30, 0, 30, 20], [30, 20, 0, 0]])
    rows.push(0, 'LINE', 8, 0, 10, x!, 20, y!, 11, u!, 21, v!);
  rows.push(0, 'ENDSEC', 0, 'EOF');
  const page = await start('plain.dxf', `${rows.join('\n')}\n`);
  expect(await text(page, '#state')).toBe('Up to date');
  expect(await page.locator('.labels .size').allInnerTexts()).toEqual(['30.000 mm', '20.000 mm']);
});
