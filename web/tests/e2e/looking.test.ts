// What the picture is asked for: sections, exact sizes, types of lines, the burn of a laser, hazards
// one after the other, what the last save has changed, drawings without a unit.
import { readFileSync } from 'node:fs';
import type { Page } from 'playwright-core';
import { afterEach, expect, test } from 'vitest';
import { drawn, open, type Opened, shows } from '../support/browser';
import { kerf, ViewServer } from '../support/command';
import { browser, folder, useBrowserAndFolder } from '../support/fixture';
import { clickAt, pixelAt, readOut, text } from '../support/gestures';
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
const sizes = (page: Page) => page.locator('.labels .size').allInnerTexts();
const measured = (page: Page) => text(page, '#measured-text');
const number = (found: string, name: string) => Number(new RegExp(`${name} (\\S+)`).exec(found)![1]);

test('a section turns from axis to axis and keeps either side', async () => {
  const page = await start('plate.nc', PLATE);
  await page.keyboard.press('s'); // opens it, along X
  expect(await page.locator('#section-axis').inputValue()).toBe('0');
  await page.keyboard.press('s');
  expect(await page.locator('#section-axis').inputValue()).toBe('1');
  expect(await text(page, '#section-text')).toBe('15.000 mm');
  // From the front the near half is hidden: the centre of the picture is the face at Y15.
  await page.locator('#tab-source').focus();
  await page.keyboard.press('3');
  await drawn(page);
  const box = (await page.locator('#canvas').boundingBox())!;
  const yAtCentre = async () => (await readOut(page, box.width / 2, box.height / 2))[1];
  expect(await yAtCentre()).toBe(15);
  expect(await text(page, '#section-flip')).toContain('far side kept');
  // The other half: its front is the face of the stock at Y0, and from behind the cut is seen.
  await page.keyboard.press('r');
  await drawn(page);
  expect(await yAtCentre()).toBe(0);
  await page.keyboard.press('5');
  await drawn(page);
  expect(await yAtCentre()).toBe(15);
  await page.locator('#section-flip').click();
  await drawn(page);
  expect(await yAtCentre()).toBe(30);
});

test('sizes of the stock, and of a part that is smaller', async () => {
  // A face of the whole plate, 1 mm deep: 6 mm of stock become 5 mm.
  const rows = Array.from({ length: 17 }, (_, k) => `G1 Y${2 * k - 1}\nG1 X${k % 2 ? -5 : 45}`);
  const page = await start('face.nc', PLATE.replace(/G0 X5 Y10 Z5[^]*G0 Z5/, `G0 X-5 Y-1 Z5
G1 Z-1 F400\n${rows.join('\n')}\nG0 Z5`));
  expect(await sizes(page)).toEqual(['40.000 mm', '30.000 mm', '6.000 mm', 'part 40.000 mm', 'part 30.000 mm',
    'part 5.000 mm']);
  await page.keyboard.press('u');
  expect(await sizes(page)).toContain('part 0.1969 in');
  const button = page.locator('#sizes');
  expect(await button.getAttribute('aria-pressed')).toBe('true');
  await page.keyboard.press('d');
  expect(await button.getAttribute('aria-pressed')).toBe('false');
  expect(await page.locator('.labels .size >> nth=0').isVisible()).toBe(false);
  await button.click();
  expect(await page.locator('.labels .size >> nth=0').isVisible()).toBe(true);
});

// A bore of 12 mm around X20 Y15, by a mill of 3.175 mm.
const BORE = PLATE.replace(/G0 X5 Y10 Z5[^]*G0 Z5/, `G0 X24.4125 Y15 Z5
G1 Z-3 F100
G3 X24.4125 Y15 I-4.4125 J0 F400
G0 Z5`);

test('measuring snaps to corners, edges and centres of circles', async () => {
  const page = await start('bore.nc', BORE, '--exact');
  await page.waitForFunction(() => document.documentElement.dataset.exact === '1');
  await page.keyboard.press('m');
  await clickAt(page, 0.3, 29.7);
  expect(await measured(page)).toMatch(/^At a corner. Click the second point/);
  await clickAt(page, 39.7, 0.3);
  expect(await measured(page)).toMatch(
    /^Distance 50\.000 mm\s+X 40\.000\s+Y -30\.000\s+Z 0\.000\s+\(corner, corner\)/,
  );
  // Three points within some pixels of the rim give the circle itself.
  await page.keyboard.press('c');
  for (const turn of [0.3, 2.1, 4.4]) {
    await clickAt(page, 20 + 6.15 * Math.cos(turn), 15 + 6.15 * Math.sin(turn));
  }
  const circle = await measured(page);
  expect(circle).toContain('(edge, edge, edge)');
  expect(number(circle, 'Diameter')).toBeCloseTo(12, 1);
  expect(number(circle, 'X')).toBeCloseTo(20, 1);
  expect(number(circle, 'Y')).toBeCloseTo(15, 1);
  expect(number(circle, 'Z')).toBeCloseTo(0, 2);
  // From the centre to a corner of the plate.
  await page.selectOption('#measure-what', 'distance');
  await clickAt(page, 20, 15);
  await clickAt(page, 39.8, 0.2);
  const away = await measured(page);
  expect(away).toContain('(centre, corner)');
  expect(number(away, 'Distance')).toBeCloseTo(25, 1);
});

test('while measuring the pointer has a hint of what a click would snap to', async () => {
  const page = await start('bore.nc', BORE, '--exact');
  await page.waitForFunction(() => document.documentElement.dataset.exact === '1');
  const hint = page.locator('#measure-hint');
  /** The hint at a position of the plate; it comes once the pointer rests. */
  const hintAt = async (x: number, y: number, wanted: RegExp) => {
    const [px, py] = await pixelAt(page, x, y);
    const box = (await page.locator('#canvas').boundingBox())!;
    await page.mouse.move(box.x + px, box.y + py);
    await page.waitForFunction(
      ([form]) => {
        const shown = document.getElementById('measure-hint')!;
        return !shown.hidden && new RegExp(form!).test(shown.textContent!);
      },
      [wanted.source],
    );
    return (await hint.textContent())!;
  };
  const [x, y] = await pixelAt(page, 20, 0.3);
  await readOut(page, x, y);
  await page.waitForTimeout(300);
  expect(await hint.isVisible()).toBe(false); // measuring is off
  await page.keyboard.press('m');
  // The plate has 40 x 30 x 6 mm, the bore 12 mm around X20 Y15.
  await hintAt(20, 0.3, /^edge, 40\.000 mm long$/);
  await hintAt(39.7, 15, /^edge, 30\.000 mm long$/);
  await hintAt(39.7, 0.3, /^corner, X 40\.000  Y 0\.000  Z 0\.000$/);
  const hole = await hintAt(20 + 6.1 * Math.cos(2), 15 + 6.1 * Math.sin(2), /^hole/);
  expect(Number(/diameter (\S+) mm/.exec(hole)![1])).toBeCloseTo(12, 1);
  await hintAt(30, 25, /^point, X (30|29)\.\d+  Y (25|24)\.\d+  Z 0\.000$/);
  await page.keyboard.press('u');
  await hintAt(20 / 25.4, 0.3 / 25.4, /^edge, 1\.5748 in long$/);
  await page.keyboard.press('u');
  // It is where the pointer is, and a click measures from there.
  const canvas = (await page.locator('#canvas').boundingBox())!;
  const [px, py] = await pixelAt(page, 39.7, 0.3);
  await page.mouse.move(canvas.x + px, canvas.y + py);
  await page.waitForFunction(() =>
    document.getElementById('measure-hint')!.textContent!.startsWith('corner'),
  );
  const there = (await hint.boundingBox())!;
  const [x0, y0] = [canvas.x + px, canvas.y + py];
  expect(Math.max(there.x - x0, x0 - there.x - there.width)).toBeLessThan(20);
  expect(Math.max(there.y - y0, y0 - there.y - there.height)).toBeLessThan(20);
  await page.mouse.click(canvas.x + px, canvas.y + py);
  expect(await hint.isVisible()).toBe(false);
  expect(await measured(page)).toMatch(/^At a corner/);
  await page.keyboard.press('m');
  await page.mouse.move(canvas.x + px - 3, canvas.y + py);
  await page.waitForTimeout(300);
  expect(await hint.isVisible()).toBe(false);
});

test('hazards one after the other, by keys and buttons, at their times', async () => {
  const rapids = 'G0 Y20\nG0 Z5\nG0 X10\nG0 Z-0.5\nG0 Z5\nM2';
  const page = await start('plate.nc', PLATE.replace('G0 Z5\nM2', rapids));
  const clock = async () => (await text(page, '#clock')).split(' ')[0];
  await page.keyboard.press('n');
  expect(await text(page, '#state')).toBe('Hazard 1 of 2: rapid in stock');
  const first = await clock();
  expect(await page.locator('.row.current, .row.active').first().innerText()).toContain('G0 Y20');
  expect(await page.locator('.row.running').innerText()).toContain('G0 Y20');
  await page.keyboard.press('n');
  expect(await text(page, '#state')).toBe('Hazard 2 of 2: rapid in stock');
  expect(await clock()).not.toBe(first);
  await page.locator('#tab-problems').click();
  expect(await page.locator('#problems li[aria-current="true"]').innerText()).toContain('plate.nc:12');
  await page.getByRole('button', { name: 'Next' }).click(); // from the last to the first
  expect(await clock()).toBe(first);
  await page.keyboard.press('b');
  expect(await text(page, '#state')).toBe('Hazard 2 of 2: rapid in stock');
  // The legend names the colour of hazards where the surface has it.
  expect(await legend(page)).toContain('hazard');
  folder.write('plate.nc', PLATE.replace('G0 Z5\nM2', rapids).replace('Z-1 F100', 'Z-2 F100'));
  await shows(page, 2);
  await page.keyboard.press('e');
  await drawn(page);
  expect(await legend(page)).not.toContain('hazard');
});

/** A slot below the surface: a disc of 10 x 2 mm on a neck of 4 mm goes in along X from the side. */
const undercut = (z: number) => `T1 M6
G0 X-10 Y10 Z5
G0 Z${z}
G1 X15 F500
G1 X-10
G0 Z5
M2
`;

test('what the last save has changed in an undercut', async () => {
  const tool = 'T-slot diameter=10 thickness=2 neck_diameter=4 flute=12';
  const stock = '20x20x10 at lower-left top';
  const page = await start('slot.nc', undercut(-6), '--tool', tool, '--stock', stock, '--resolution', '0.1');
  folder.write('slot.nc', undercut(-6.5));
  await shows(page, 2);
  await page.keyboard.press('e');
  await drawn(page);
  const [, more] = /(\S+) mm³ removed more, up to 0\.500 mm/.exec(await legend(page))!;
  const [, less] = /(\S+) mm³ removed less, up to 0\.500 mm/.exec(await legend(page))!;
  // The floor of the disc, and its roof without the neck, are half a millimetre deeper.
  const disc = 15 * 10 + (Math.PI * 5 ** 2) / 2;
  const neck = 15 * 4 + (Math.PI * 2 ** 2) / 2;
  expect(Number(more)).toBeCloseTo(0.5 * disc, 0);
  expect(Number(less)).toBeCloseTo(0.5 * (disc - neck), 0);
  folder.write('slot.nc', `(a comment)\n${undercut(-6.5)}`);
  await shows(page, 3);
  expect(await legend(page)).toContain('no change of the part');
});

test('what the last save has changed: removed more, and removed less', async () => {
  const page = await start('plate.nc', PLATE);
  await page.keyboard.press('e');
  expect(await text(page, '#state')).toContain('Nothing has been saved');
  // The slot of 3.175 mm becomes 1 mm deeper, and ends 10 mm earlier.
  folder.write('plate.nc', PLATE.replace('G1 Z-1 F100', 'G1 Z-2 F100').replace('G1 X35', 'G1 X25'));
  await shows(page, 2);
  await page.keyboard.press('e');
  await drawn(page);
  const [, more] = /(\S+) mm³ removed more, up to 1\.000 mm/.exec(await legend(page))!;
  const [, less] = /(\S+) mm³ removed less, up to 1\.000 mm/.exec(await legend(page))!;
  // 1 mm deeper over 20 mm and the round ends; 10 mm shorter. The columns are 0.5 mm apart.
  expect(Number(more)).toBeGreaterThan(0.9 * (20 * 3.175 + Math.PI * 3.175 ** 2 / 4));
  expect(Number(more)).toBeLessThan(1.1 * (20 * 3.175 + Math.PI * 3.175 ** 2 / 4));
  expect(Number(less)).toBeGreaterThan(0.9 * 10 * 3.175);
  expect(Number(less)).toBeLessThan(1.1 * 10 * 3.175);
  const [x, y] = await pixelAt(page, 15, 10);
  await readOut(page, x, y);
  expect(await text(page, '#readout')).toContain('removed more: 1.000 mm');
  // A further save compares with the one before: a comment changes nothing.
  folder.write('plate.nc', `(a comment)\n${readFileSync(`${folder.path}/plate.nc`, 'utf8')}`);
  await shows(page, 3);
  expect(await legend(page)).toContain('no change of the part');
  await page.keyboard.press('e');
  expect(await page.locator('#colour').inputValue()).toBe('tool');
});

const SQUARE: [number, number][] = [[10, 30], [30, 30], [30, 10], [10, 10.5]];

test('lines of a print are coloured and filtered by their types', async () => {
  const lines = ['; generated by PrusaSlicer 2.6.0', 'M82', 'G28'];
  let e = 0;
  for (let k = 1; k <= 3; ++k) {
    lines.push(`;LAYER_CHANGE`, `G1 X10 Y10 Z${(0.4 * k).toFixed(1)} F3000`, ';TYPE:External perimeter');
    for (const [x, y] of SQUARE) lines.push(`G1 X${x} Y${y} E${(e += 2).toFixed(1)} F1200`);
    lines.push(';TYPE:Internal infill', 'G1 X12 Y12 F3000', `G1 X28 Y28 E${(e += 2).toFixed(1)} F1200`);
    lines.push(';TYPE:Support material', 'G1 X40 Y10 F3000', `G1 X40 Y30 E${(e += 2).toFixed(1)} F1200`);
  }
  const page = await start('print.gcode', `${lines.join('\n')}\n`);
  await page.selectOption('#colour', 'type');
  expect(await legend(page)).toMatch(/outer wall\s*infill\s*support\s*beads/);
  await page.keyboard.press('2');
  await drawn(page);
  const all = await canvasPicture(page);
  await page.getByLabel('support', { exact: true }).uncheck();
  await drawn(page);
  const without = await canvasPicture(page);
  expect(await differing(browser, all, without)).toBeGreaterThan(0.002);
  await page.getByLabel('support', { exact: true }).check();
  await drawn(page);
  expect(await differing(browser, all, await canvasPicture(page))).toBe(0);
});

const LASER = `G21 G90\nM4 S0\nG0 X0 Y0\nG1 X20 S500 F600\nG0 X0 Y5\nG1 X20 S1000 F600\nM5\nM2\n`;

test('the burn of a laser on its board, as kerf simulate computes it', async () => {
  const page = await start('laser.nc', LASER, '--spot', '1', '--max-power', '10');
  await page.selectOption('#colour', 'burn');
  await page.waitForFunction(() => document.documentElement.dataset.burn === '1');
  await drawn(page);
  expect(await legend(page)).toContain('beam 1.000 mm, 10 W at S1000');
  const file = `${folder.path}/laser.nc`;
  const burn = ['--show', 'burn', '--spot', '1', '--max-power', '10', '--json'];
  const figures = JSON.parse(kerf('simulate', file, '-o', `${folder.path}/b.png`, ...burn)) as {
    burn: Record<string, number>;
  };
  expect(await legend(page)).toContain(`${figures.burn.black_j_mm2!.toPrecision(3)} J/mm²`);
  // On the centre line of the stronger cut: 4 P / (pi d v) = 4 x 10 / (pi x 1 x 10) J/mm2.
  const box = (await page.locator('#canvas').boundingBox())!;
  await page.keyboard.press('2');
  await drawn(page);
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await drawn(page);
  expect(await text(page, '#readout')).toMatch(/^X 10\.\d+\s+Y 2\.\d+\s+0\.00 J\/mm²$/);
  let highest = 0;
  for (let dy = 0; dy < box.height / 2; dy += 4) {
    await page.mouse.move(box.x + box.width / 2, box.y + dy);
    await drawn(page);
    const found = /Y\s+\S+\s+(\S+) J/.exec(await text(page, '#readout'));
    highest = Math.max(highest, Number(found?.[1] ?? 0));
  }
  expect(highest).toBeGreaterThan(1.1);
  expect(highest).toBeLessThan(1.3);
});

test('a drawing without a unit asks for it', async () => {
  const line = (x: number) => `0\nLINE\n8\n0\n10\n0\n20\n0\n11\n${x}\n21\n5\n`;
  const drawing = `0\nSECTION\n2\nENTITIES\n${line(10)}${line(20)}0\nENDSEC\n0\nEOF\n`;
  server = await ViewServer.start(folder.write('plan.dxf', drawing));
  opened = await open(browser, server.address);
  const { page } = opened;
  await page.locator('#message button', { hasText: 'inch' }).click();
  await shows(page, 1);
  expect(await text(page, '#state')).toBe('Up to date');
  expect(await sizes(page)).toEqual(['508.000 mm', '127.000 mm']);
  const [unit] = await Promise.all([server.get('model')]);
  expect(((await unit.json()) as { errors: unknown[] }).errors).toEqual([]);
});
