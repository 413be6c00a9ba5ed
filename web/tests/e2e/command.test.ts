// The real `kerf view` with its page in a real browser: opening every kind of input, following edits,
// playing, picking, sections, downloads and the exported file.
import { mkdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import type { Page } from 'playwright-core';
import { afterEach, expect, test } from 'vitest';
import { drawn, open, type Opened, shows, showsInstant } from '../support/browser';
import { EXAMPLES, kerf, ViewServer } from '../support/command';
import { browser, folder, useBrowserAndFolder } from '../support/fixture';
import { canvasPicture, differing, fixSize } from '../support/golden';
import { clickAt, pixelAt, readOut, text } from '../support/gestures';
import { PLATE } from '../support/plate';

let server: ViewServer | null = null;
let opened: Opened | null = null;

useBrowserAndFolder();
afterEach(async () => {
  await opened?.page.context().close();
  opened = null;
  expect(await server?.end()).toBe(server ? 0 : undefined);
  server = null;
  folder.remove();
});

async function start(file: string, ...options: string[]): Promise<Page> {
  server = await ViewServer.start(file, ...options);
  opened = await open(browser, server.address);
  await shows(opened.page, 1);
  return opened.page;
}

function noErrors(): void {
  expect(opened!.errors).toEqual([]);
}

test('the demo: times, standard views, section, states on the way', async () => {
  const file = folder.copy(join(EXAMPLES, 'demo.nc'), 'demo.nc');
  const page = await start(file);
  expect(await text(page, '#name')).toBe('demo.nc');
  const info = JSON.parse(kerf('info', file, '--json')) as { time_s: { total: number } };
  const total = info.time_s.total;
  expect(await text(page, '#clock')).toBe(
    `${Math.floor(total / 60)}:${(total % 60).toFixed(1).padStart(4, '0')} / ` +
      `${Math.floor(Math.round(total) / 60)}:${String(Math.round(total) % 60).padStart(2, '0')}`,
  );
  await page.click('#tab-report');
  expect(await text(page, '#report')).toContain('T102');
  await page.click('#tab-source');

  // The block is 110 x 80 x 14 mm: what is at the centre of a view follows from its direction.
  const box = (await page.locator('#canvas').boundingBox())!;
  const centre = async (key: string) => {
    await page.keyboard.press(key);
    await drawn(page);
    return readOut(page, box.width / 2, box.height / 2);
  };
  const top = await centre('2');
  expect([top[0], top[1]].map((v) => Math.round(v! / 2) * 2)).toEqual([56, 40]);
  const front = await centre('3');
  expect(front[1]).toBeLessThan(1);
  const right = await centre('4');
  expect(right[0]).toBeGreaterThan(109);
  const bottom = await centre('7');
  expect(bottom[2]).toBe(-14);

  await page.keyboard.press('1');
  await page.locator('#tab-source').focus();
  const finished = await canvasPicture(page);
  await page.keyboard.press('x');
  expect(await text(page, '#section-text')).toBe('55.000 mm');
  expect(await differing(browser, finished, await canvasPicture(page))).toBeGreaterThan(0.05);
  await page.locator('#section-toggle').click();
  await page.locator('#tab-source').focus();

  await page.keyboard.press('Home');
  const instant = () => page.locator('html').getAttribute('data-instant');
  await page.waitForFunction(() => /^\d+$/.test(document.documentElement.dataset.instant ?? ''));
  const first = await instant();
  const untouched = await canvasPicture(page);
  expect(await differing(browser, finished, untouched)).toBeGreaterThan(0.05);
  await page.locator('#time').evaluate((e: HTMLInputElement) => {
    e.value = String(Number(e.max) / 2);
    e.dispatchEvent(new Event('input'));
  });
  await page.waitForFunction((f) => document.documentElement.dataset.instant !== f, first);
  const halfway = await canvasPicture(page);
  expect(await differing(browser, untouched, halfway)).toBeGreaterThan(0.02);
  expect(await differing(browser, finished, halfway)).toBeGreaterThan(0.02);
  await page.keyboard.press('End');
  await showsInstant(page, 'end');
  expect(await differing(browser, finished, await canvasPicture(page))).toBeLessThan(0.001);
  noErrors();
});

test('follows saves; an error greys the part and leads to its line, until it is repaired', async () => {
  const file = folder.write('plate.nc', PLATE);
  const page = await start(file);
  await page.keyboard.press('2');
  const first = await canvasPicture(page);
  folder.write('plate.nc', PLATE.replace('Y10', 'Y20'));
  await shows(page, 2);
  const moved = await canvasPicture(page);
  expect(await differing(browser, first, moved)).toBeGreaterThan(0.005);

  folder.write('plate.nc', PLATE.replace('Y10', 'Y20').replace('G1 X35 F400', 'G1 X35 F400 ['));
  await page.waitForSelector('#stage.outdated');
  expect(await text(page, '#state')).toMatch(/^\d+ errors?$/);
  const problems = await text(page, '#problems');
  expect(problems).toContain('The part shown is the one before these errors.');
  await page.click('#problems button:has-text("plate.nc:8")');
  expect(await page.locator('.row.error').getAttribute('data-line')).toBe('8');
  await page.keyboard.press('Escape');

  folder.write('plate.nc', PLATE);
  await page.waitForSelector('#stage:not(.outdated)');
  await shows(page, 3);
  expect(await page.locator('.row.error').count()).toBe(0);
  expect(await differing(browser, first, await canvasPicture(page))).toBe(0);
  noErrors();
});

test('picks both ways: from a surface to its line, from a line to its motions', async () => {
  const page = await start(folder.write('plate.nc', PLATE));
  await page.click('#show-menu summary');
  await page.uncheck('[data-layer="cuts"]');
  await page.uncheck('[data-layer="rapids"]');
  await clickAt(page, 20, 10);
  expect(await text(page, '#state')).toMatch(/plate.nc:8$/);
  expect(await page.locator('.row.active').getAttribute('data-line')).toBe('8');
  const before = await canvasPicture(page);
  await page.click('.row[data-line="7"]');
  expect(await text(page, '#state')).toBe('Line 7: 1 motion');
  expect(await differing(browser, before, await canvasPicture(page))).toBeGreaterThan(0);
  noErrors();
});

test('edges become exact when the file rests, and are those of the columns again after a save', async () => {
  const page = await start(folder.write('plate.nc', PLATE), '--exact', '--resolution', '0.7');
  await page.waitForFunction(() => document.documentElement.dataset.exact === '1');
  // The slot is 3.175 mm wide around Y10: its wall is exact although columns are 0.7 mm apart.
  const floorAt = async (y: number) => (await readOut(page, ...(await pixelAt(page, 20, y))))[2]!;
  expect(await floorAt(10 + 1.5875 - 0.06)).toBeCloseTo(-1, 2);
  expect(await floorAt(10 + 1.5875 + 0.06)).toBeCloseTo(0, 2);
  await clickAt(page, 20, 11);
  expect(await text(page, '#state')).toMatch(/plate.nc:8$/);
  folder.write('plate.nc', PLATE.replace('Y10', 'Y20'));
  await shows(page, 2);
  expect(await floorAt(20)).toBeCloseTo(-1, 2);
  expect(await floorAt(10)).toBeCloseTo(0, 2);
  noErrors();
});

test('an included file is followed, and errors in it lead to it', async () => {
  folder.write('depth.gcmc', 'DEPTH = -1mm;\n');
  const file = folder.write(
    'slot.gcmc',
    'include("depth.gcmc");\ngoto([-, -, 5mm]);\ngoto([5mm, 5mm]);\nfeedrate(300mm);\n' +
      'move([-, -, DEPTH]);\nmove([25mm, 5mm]);\ngoto([-, -, 5mm]);\n',
  );
  const page = await start(file, '--tool', 'square d=3', '--stock', '30x10x6');
  await page.keyboard.press('2');
  await drawn(page);
  const first = await canvasPicture(page);
  folder.write('depth.gcmc', 'DEPTH = -3mm;\n');
  await shows(page, 2);
  expect(await page.locator('#file option').allInnerTexts()).toHaveLength(2);
  folder.write('depth.gcmc', 'DEPTH = ;\n');
  await page.waitForSelector('#stage.outdated');
  expect(await text(page, '#problems')).toMatch(/depth\.gcmc:1/);
  folder.write('depth.gcmc', 'DEPTH = -1mm;\n');
  await page.waitForSelector('#stage:not(.outdated)');
  await shows(page, 3);
  expect(await differing(browser, first, await canvasPicture(page))).toBe(0);
  noErrors();
});

const OUTLINE = JSON.stringify({
  unit: 'mm',
  outlines: [
    {
      name: 'plate',
      closed: true,
      first: { at: [0, 0] },
      segments: [{ to: [40, 0] }, { to: [40, 20], via: [50, 10] }, { to: [0, 20] }],
    },
  ],
});
const SCRIPT = `import kerf
path = kerf.Toolpath()
path.tool(102)
path.spindle(16000)
path.rapid((5, 5, 5))
path.cut((5, 5, -2), feed=100)
path.cut((25, 5, -2), feed=400)
path.rapid((25, 5, 5))
kerf.simulate(path, kerf.Stock.block((30, 10, 6)))
`;
const ART =
  '<svg xmlns="http://www.w3.org/2000/svg" width="40mm" height="20mm" viewBox="0 0 40 20">' +
  '<rect x="5" y="5" width="30" height="10"/></svg>';
const kinds: [string, string, string, number, number][] = [
  // file, its text or the file to copy, kind, least number of motions and of tiles
  ['part.nc', PLATE, 'milling', 4, 1],
  ['plate.gcmc', join(EXAMPLES, 'plate.gcmc'), 'milling', 40, 1],
  ['9001.1P.dxf', join(EXAMPLES, 'path', '9001.1P.dxf'), 'milling', 5, 1],
  ['text.toml', join(EXAMPLES, 'text.toml'), 'milling', 50, 1],
  ['script.py', SCRIPT, 'milling', 4, 1],
  ['outline.json', OUTLINE, 'drawing', 5, 0],
  ['art.svg', ART, 'drawing', 5, 0],
  [
    'print.gcode',
    'M82\nG28\nG1 X10 Y10 Z0.2 F3000\nG1 X30 Y10 E1 F1200\nG1 X30 Y30 E2\nG1 X10 Y30 E3\n',
    'print',
    4,
    1,
  ],
];

test.each(kinds)('opens %s', async (name, source, kind, motions, tiles) => {
  const file =
    source.startsWith('/') || source.startsWith('..')
      ? folder.copy(source, name)
      : folder.write(name, source);
  const page = await start(file);
  expect(await text(page, '#name')).toBe(name);
  const model = (await (await server!.get('model')).json()) as {
    kind: string;
    motions: number;
    tiles: { count: number };
    errors: unknown[];
  };
  expect(model.errors).toEqual([]);
  expect(model.kind).toBe(kind);
  expect(model.motions).toBeGreaterThanOrEqual(motions);
  expect(model.tiles.count).toBeGreaterThanOrEqual(tiles);
  // Without its layers the picture is another one: something of the file was drawn.
  const all = await canvasPicture(page);
  await page.click('#show-menu summary');
  for (const layer of ['part', 'cuts', 'rapids']) await page.uncheck(`[data-layer="${layer}"]`);
  await page.keyboard.press('Escape');
  expect(await differing(browser, all, await canvasPicture(page))).toBeGreaterThan(0.0005);
  noErrors();
});

test('downloads, a mesh of them opened again, and the exported page from disk', async () => {
  const page = await start(folder.write('plate.nc', PLATE));
  const download = async (name: string): Promise<Buffer> => {
    await page.click('#download-menu summary');
    const [file] = await Promise.all([
      page.waitForEvent('download'),
      page.click(`#downloads >> text="${name}"`),
    ]);
    await page.keyboard.press('Escape');
    return readFileSync(await file.path());
  };
  const stl = await download('Mesh (STL)');
  expect(stl.length).toBe(84 + 50 * stl.readUInt32LE(80));
  expect((await download('Mesh (3MF, colours)')).subarray(0, 2).toString()).toBe('PK');
  expect((await download('Mesh (GLB, colours)')).subarray(0, 4).toString()).toBe('glTF');
  expect((await download('Picture (PNG)')).subarray(1, 4).toString()).toBe('PNG');
  await page.click('#download-menu summary');
  const [gcode] = await Promise.all([
    page.waitForEvent('download'),
    page.selectOption('#downloads select', 'grbl'),
  ]);
  await page.keyboard.press('Escape');
  const posted = readFileSync(await gcode.path()).toString();
  expect(posted).toMatch(/X35/);
  const exported = await download('Page (HTML)');
  noErrors();
  await page.context().close();
  expect(await server!.end()).toBe(0);

  opened = await open(browser, pathToFileURL(folder.write('part.html', exported)).href, { offline: true });
  await shows(opened.page, 1);
  await fixSize(opened.page);
  await opened.page.click('#show-menu summary');
  for (const layer of ['cuts', 'rapids']) await opened.page.uncheck(`[data-layer="${layer}"]`);
  await clickAt(opened.page, 20, 10);
  expect(await text(opened.page, '#state')).toMatch(/plate.nc:8$/);
  noErrors();
  await opened.page.context().close();

  const again = await start(folder.write('part.stl', stl));
  expect((await readOut(again, ...(await pixelAt(again, 20, 20))))[2]).toBeCloseTo(0, 3);
  expect((await readOut(again, ...(await pixelAt(again, 20, 10))))[2]).toBeCloseTo(-1, 3);
  noErrors();
});

const OTHER = PLATE.replace('Y10', 'Y22');
const shown = (page: Page, name: string) =>
  page.waitForFunction((n) => document.getElementById('name')!.textContent === n, name);

test('opens other files: of the folder, by the address, by choice, dropped', async () => {
  folder.write('other.nc', OTHER);
  folder.write('notes.md', 'not a program');
  const page = await start(folder.write('plate.nc', PLATE));
  await page.keyboard.press('o');
  await page.waitForSelector('#open-names li');
  expect(await page.locator('#open-names li').allInnerTexts()).toEqual(['other.nc', 'plate.nc']);
  await page.click('#open-names >> text="other.nc"');
  await shown(page, 'other.nc');
  folder.write('other.nc', OTHER.replace('Z-1', 'Z-2')); // which is followed now
  await shows(page, 3);

  await page.goto(`${server!.address}&src=plate.nc`);
  await shown(page, 'plate.nc');
  await page.goto(`${server!.address}&src=${encodeURIComponent('../../etc/hostname')}`);
  await shown(page, 'plate.nc');

  await page.click('#open');
  await page.setInputFiles('#open-file', {
    name: 'chosen.nc',
    mimeType: 'text/plain',
    buffer: Buffer.from(OTHER),
  });
  await shown(page, 'chosen.nc');
  const drop = (name: string, body: string) =>
    page.evaluate(
      ([fileName, content]) => {
        const data = new DataTransfer();
        data.items.add(new File([content!], fileName!));
        document.dispatchEvent(
          new DragEvent('drop', { dataTransfer: data, bubbles: true, cancelable: true }),
        );
      },
      [name, body],
    );
  await drop('dropped.nc', PLATE);
  await shown(page, 'dropped.nc');
  await drop('part.exe', 'MZ');
  await page.waitForFunction(() =>
    document.getElementById('state')!.textContent!.includes('cannot be viewed'),
  );
  expect(await text(page, '#name')).toBe('dropped.nc');
  // The two refusals are answers 404 and 400, which the browser notes.
  expect(opened!.errors.filter((e) => !/status of 40[04]/.test(e))).toEqual([]);
});

test('colours what is left of a target and what is gouged', async () => {
  const plate = folder.write('plate.nc', PLATE);
  const target = join(folder.path, 'target.stl');
  kerf('simulate', plate, '-o', target);
  const page = await start(folder.write('deep.nc', PLATE.replace('Z-1', 'Z-1.5')), '--target', target);
  await page.keyboard.press('2');
  const byTool = await canvasPicture(page);
  await page.selectOption('#colour', 'target');
  expect(await differing(browser, byTool, await canvasPicture(page))).toBeGreaterThan(0.2);
  const [px, py] = await pixelAt(page, 20, 10);
  await readOut(page, px, py);
  expect(await text(page, '#readout')).toMatch(/gouged 0\.(49|50)\d mm/);
  await readOut(page, ...(await pixelAt(page, 20, 25)));
  expect(await text(page, '#readout')).not.toMatch(/gouged|left/);
  await page.click('#tab-report');
  expect(await text(page, '#report')).toMatch(/Deepest gouge\s+0\.(49|50)\d mm/);
  noErrors();
});

const MACHINE = `name = "Bench router"
controller = "grbl"
rate = [3000, 3000, 1000]
acceleration = [200, 200, 50]
travel_x = [-300, 0]
travel_y = [-200, 0]
travel_z = [-80, 0]
work_zero = [-200, -150, -60]
`;

test('shows fixtures, and the machine by its travel', async () => {
  const machine = folder.write('machine.toml', MACHINE);
  const page = await start(
    folder.write('plate.nc', PLATE),
    '--machine',
    machine,
    '--fixture',
    '-10,5,-6 to -2,25,4',
  );
  const all = await canvasPicture(page);
  await page.click('#show-menu summary');
  await page.uncheck('[data-layer="machine"]');
  const withoutMachine = await canvasPicture(page);
  expect(await differing(browser, all, withoutMachine)).toBeGreaterThan(0.001);
  await page.uncheck('[data-layer="fixtures"]');
  expect(await differing(browser, withoutMachine, await canvasPicture(page))).toBeGreaterThan(0.005);
  noErrors();
});

test('prints a setup sheet and records a film', async () => {
  const page = await start(folder.write('plate.nc', PLATE));
  await page.evaluate(() => (window.print = () => (document.documentElement.dataset.printed = 'yes')));
  await page.click('#download-menu summary');
  await page.click('#downloads >> text="Setup sheet (print)"');
  await page.waitForSelector('html[data-printed]');
  await page.emulateMedia({ media: 'print' });
  const sheet = await text(page, '#sheet');
  expect(sheet).toContain('40.000 × 30.000 × 6.000 mm');
  expect(sheet).toMatch(/T102\s+square 3.175 mm/);
  expect(sheet).toContain('-1.000');
  expect(await page.locator('#player').isVisible()).toBe(false);
  expect(await page.locator('#sheet img').evaluate((e: HTMLImageElement) => e.naturalWidth)).toBeGreaterThan(
    100,
  );
  await page.emulateMedia({ media: 'screen' });

  await page.selectOption('#speed', '8');
  if (!(await page.locator('#downloads').isVisible())) await page.click('#download-menu summary');
  const [film] = await Promise.all([
    page.waitForEvent('download'),
    page.click('#downloads >> text="Film (WebM)"'),
  ]);
  expect(film.suggestedFilename()).toBe('plate.nc.webm');
  const bytes = readFileSync(await film.path());
  expect(bytes.subarray(0, 4).toString('hex')).toBe('1a45dfa3');
  expect(bytes.length).toBeGreaterThan(2000);
  noErrors();
});

/** Stacked squares of beads, as a slicer writes them. */
function print(): string {
  const lines = ['M82', 'G28', 'G1 Z0.2 F3000'];
  let filament = 0;
  for (let layer = 1; layer <= 12; ++layer) {
    lines.push(`G1 X10 Y10 Z${(0.2 * layer).toFixed(1)} F3000`);
    for (const [x, y] of [
      [30, 10],
      [30, 24],
      [10, 24],
      [10, 10.4],
    ] as const)
      lines.push(`G1 X${x} Y${y} E${(filament += 0.7).toFixed(2)} F${900 + 60 * layer}`);
  }
  return `${lines.join('\n')}\n`;
}

/** Pictures of the manual: docs/manual/pictures/NAME.png are copies of shots/NAME.png. */
async function shot(page: Page, name: string): Promise<void> {
  await drawn(page);
  mkdirSync('shots', { recursive: true });
  await page.screenshot({ path: join('shots', `${name}.png`) });
}

test('pictures of the manual: the demo, a hazard, a print by its flow', async () => {
  const page = await start(join(EXAMPLES, 'demo.nc'), '--resolution', '0.3');
  await page.setViewportSize({ width: 1280, height: 760 });
  await page.locator('#time').evaluate((e: HTMLInputElement) => {
    e.value = String(Number(e.max) * 0.6);
    e.dispatchEvent(new Event('input'));
  });
  await page.waitForFunction(() => /^\d+$/.test(document.documentElement.dataset.instant ?? ''));
  await page.keyboard.press('1');
  await shot(page, 'viewer_playing');
  await page.context().close();
  await server!.end();

  const collision = PLATE.replace('G0 Z5\nM2', 'G0 X20 Y25\nG0 Z5\nM2');
  const hazard = await start(folder.write('collision.nc', collision));
  await hazard.click('#tab-problems');
  expect(await text(hazard, '#problems')).toMatch(/rapid in stock/i);
  await hazard.click('#problems .list button >> nth=0');
  await shot(hazard, 'viewer_hazard');
  await hazard.context().close();
  await server!.end();

  const printed = await start(folder.write('print.gcode', print()), '--resolution', '0.1');
  await printed.selectOption('#colour', 'flow');
  await printed.click('#tab-report');
  await shot(printed, 'viewer_print');
  noErrors();
});
