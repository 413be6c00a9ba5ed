// What the picture says besides the part: axes, grid, sizes, the legend of every colouring, lines that do not
// cover the surface, layers of prints, power of beams, perspective.
import type { Page } from 'playwright-core';
import { afterEach, expect, test } from 'vitest';
import { drawn, open, type Opened, shows } from '../support/browser';
import { ViewServer } from '../support/command';
import { browser, folder, useBrowserAndFolder } from '../support/fixture';
import { clickAt, text } from '../support/gestures';
import { canvasPicture, differing } from '../support/golden';
import { PLATE } from '../support/plate';

let server: ViewServer | null = null;
let opened: Opened | null = null;

useBrowserAndFolder();
afterEach(async () => {
  if (opened) expect(opened.errors).toEqual([]);
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

const legend = (page: Page) => text(page, '#legend-list');
const texts = (page: Page, kind: string) => page.locator(`.labels .${kind}`).allInnerTexts();
const choices = (page: Page) =>
  page
    .locator('#colour option:not([hidden])')
    .evaluateAll((all) => all.map((e) => (e as HTMLOptionElement).value));

async function toTime(page: Page, part: number): Promise<void> {
  await page.locator('#time').evaluate((e: HTMLInputElement, f) => {
    e.value = String(Number(e.max) * f);
    e.dispatchEvent(new Event('input', { bubbles: true }));
  }, part);
  await drawn(page);
}

test('a bar is there at every time of its job, not its cuts alone', async () => {
  const bar = `T102 M6
S9000 M3
G0 Z20 A0
X10
G1 Z8 F300
A360 F2000
G0 Z20
`;
  const page = await start('bar.nc', bar, '--rotary', 'd=20 length=40');
  await toggle(page, 'tool');
  const end = await canvasPicture(page);
  await toTime(page, 0.5);
  // The path that is not yet run is less; without the bar more than a tenth of the picture differs.
  expect(await differing(browser, end, await canvasPicture(page))).toBeLessThan(0.03);
});

test('the position under the pointer is not that of another time', async () => {
  const page = await start('plate.nc', PLATE);
  const { x, y, width, height } = (await page.locator('#canvas').boundingBox())!;
  await page.mouse.move(x + width / 2, y + height / 2);
  await page.waitForFunction(() => document.getElementById('readout')!.textContent !== '');
  await page.keyboard.press('Home');
  expect(await text(page, '#readout')).toBe('');
});

const UNITS = [
  ['px', '26.458 mm'],
  ['pt', '35.278 mm'],
] as const;

test.each(UNITS)('a drawing without a unit is read in %s', async (unit, size) => {
  const art =
    '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 200 100">' +
    '<path d="M0 0h100v50h-100z"/></svg>';
  server = await ViewServer.start(folder.write('art.svg', art));
  opened = await open(browser, server.address);
  await opened.page.click(`#message button:text-is("${unit}")`);
  await opened.page.waitForFunction(() => Number(document.documentElement.dataset.revision) >= 1);
  await drawn(opened.page);
  expect(await texts(opened.page, 'size')).toContain(size);
});

test('work does not move the toolbar', async () => {
  const page = await start('plate.nc', PLATE);
  await page.setViewportSize({ width: 1400, height: 900 });
  const top = () => page.locator('.tools').evaluate((e) => e.getBoundingClientRect().top);
  const before = await top();
  await page.evaluate(() => {
    for (const id of ['progress', 'stop']) document.getElementById(id)!.hidden = false;
  });
  expect(await top()).toBe(before);
});

test('what lies over the picture of a phone is inside it, the layer in one line', async () => {
  const layers = [1, 2, 3].map((n) => `;LAYER:${n}\nG0 X10 Y10 Z${n / 5}\nG1 X30 Y10 E${n} F1200\n`);
  const page = await start('print.gcode', `;FLAVOR:Marlin\nM82\nG28\n${layers.join('')}`);
  await page.setViewportSize({ width: 390, height: 844 });
  const size = (id: string) =>
    page.locator(id).evaluate((e) => e.getBoundingClientRect().toJSON() as DOMRect);
  expect((await size('#layer-text')).height).toBeLessThan(25);
  await page.locator('#section-toggle').click();
  expect((await size('#section')).right).toBeLessThanOrEqual(390 - 8);
});

async function toggle(page: Page, layer: string): Promise<void> {
  await page.locator(`[data-layer="${layer}"]`).evaluate((e: HTMLInputElement) => e.click());
  await drawn(page);
}

test('axes, grid and sizes of the stock, in mm and inch', async () => {
  const page = await start('plate.nc', PLATE);
  expect(await texts(page, 'axis')).toEqual(['X', 'Y', 'Z']);
  expect(await texts(page, 'size')).toEqual(['40.000 mm', '30.000 mm', '6.000 mm']);
  expect(await texts(page, 'grid')).toContain('20');
  expect(await legend(page)).toContain('grid 5.000 mm');
  await page.keyboard.press('u');
  expect(await texts(page, 'size')).toEqual(['1.5748 in', '1.1811 in', '0.2362 in']);
  // The work zero is drawn where it is: at a corner of this stock, in the view from above.
  await page.keyboard.press('2');
  await drawn(page);
  const all = await canvasPicture(page);
  await toggle(page, 'grid');
  expect(await differing(browser, all, await canvasPicture(page))).toBeGreaterThan(0.002);
  expect(await page.locator('.labels .axis >> nth=0').isVisible()).toBe(false);
});

test('only colourings that apply are offered, and each has its legend', async () => {
  const page = await start('plate.nc', PLATE);
  expect(await choices(page)).toEqual(['tool', 'depth', 'step', 'speed']);
  expect(await legend(page)).toMatch(/stock, not cut\s*T102 square 3\.175 mm\s*cuts\s*rapids/);
  await page.selectOption('#colour', 'depth');
  expect(await legend(page)).toMatch(/Z\s*-6\.000 mm\s*0\.000 mm/);
  await page.selectOption('#colour', 'speed');
  expect(await legend(page)).toMatch(/feed\s*0\s*400 mm\/min/);
  await page.selectOption('#colour', 'step');
  expect(await legend(page)).toMatch(/first\s*last/);
});

test('a laser is coloured by its power', async () => {
  const lines = Array.from({ length: 10 }, (_, i) => `G1 X${i + 1} Y0 S${100 * (i + 1)} F3000`);
  const page = await start('laser.nc', `G21 G90\nM4 S0\nG0 X0 Y0\n${lines.join('\n')}\nM5\nM2\n`);
  expect(await choices(page)).toContain('power');
  const byTool = await canvasPicture(page);
  await page.selectOption('#colour', 'power');
  expect(await legend(page)).toMatch(/power of the beam\s*S0\s*S1000/);
  expect(await differing(browser, byTool, await canvasPicture(page))).toBeGreaterThan(0);
});

/** Rows 0.25 mm apart on a plate. */
function relief(): string {
  const rows = Array.from({ length: 121 }, (_, k) => `G1 X${k % 2 ? 0 : 40} Y${k / 4}`);
  return PLATE.replace('G1 X35 F400', `F400\n${rows.join('\n')}`);
}

test('a relief shows its surface: cuts fade where they are denser than pixels', async () => {
  const page = await start('relief.nc', relief());
  await page.setViewportSize({ width: 500, height: 420 });
  await page.keyboard.press('2');
  for (let k = 0; k < 3; ++k) await page.keyboard.press('-');
  await drawn(page);
  expect(await legend(page)).toContain('cuts: hidden, denser than pixels');
  const withCuts = await canvasPicture(page);
  await toggle(page, 'cuts');
  expect(await differing(browser, withCuts, await canvasPicture(page))).toBe(0);
  await toggle(page, 'cuts');
  for (let k = 0; k < 14; ++k) await page.keyboard.press('+');
  await drawn(page);
  expect(await legend(page)).toMatch(/cuts\s*rapids/);
  const near = await canvasPicture(page);
  await toggle(page, 'cuts');
  expect(await differing(browser, near, await canvasPicture(page))).toBeGreaterThan(0.02);
});

test('the slider of layers shows a print up to one', async () => {
  const lines = ['M82', 'G28'];
  for (let k = 1, e = 0; k <= 5; ++k) {
    lines.push(`G1 X10 Y10 Z${(0.4 * k).toFixed(1)} F3000`);
    for (const [x, y] of [[30, 10], [30, 30], [10, 30], [10, 10.5]])
      lines.push(`G1 X${x} Y${y} E${(e += 2).toFixed(1)} F1200`);
  }
  const page = await start('print.gcode', `${lines.join('\n')}\n`);
  expect(await choices(page)).toEqual(['tool', 'step', 'speed', 'flow', 'layer']);
  expect(await text(page, '#layer-text')).toBe('5 of 5');
  const whole = await canvasPicture(page);
  await page.locator('#layer').evaluate((e: HTMLInputElement) => {
    e.value = '2';
    e.dispatchEvent(new Event('input'));
  });
  await drawn(page);
  expect(await text(page, '#layer-text')).toBe('2 of 5');
  expect(await text(page, '#motion')).toContain('line 13'); // which moves up to the third layer
  expect(await differing(browser, whole, await canvasPicture(page))).toBeGreaterThan(0.01);
});

test('perspective, a path as wide as its tool, and a see-through part', async () => {
  const page = await start('plate.nc', PLATE);
  const parallel = await canvasPicture(page);
  await page.locator('#tab-source').focus();
  await page.keyboard.press('v');
  await drawn(page);
  const perspective = await canvasPicture(page);
  expect(await differing(browser, parallel, perspective)).toBeGreaterThan(0.02);
  for (const layer of ['clear', 'wide']) {
    await toggle(page, layer);
    expect(await differing(browser, perspective, await canvasPicture(page))).toBeGreaterThan(0.005);
    await toggle(page, layer);
  }
  // Straight above its centre the part is where the parallel view shows it.
  await page.keyboard.press('2');
  await drawn(page);
  await clickAt(page, 20, 10);
  expect(await text(page, '#state')).toMatch(/plate.nc:8$/);
});
