// The toolpath and the source that the page has after each of many saves, of which it was sent the changed
// blocks alone, are those of a page that is opened then.
import { writeFileSync } from 'node:fs';
import { afterAll, expect, test } from 'vitest';
import { decodePath, type Path } from '../../src/path';
import type { Model } from '../../src/protocol';
import { open, shows, startBrowser } from '../support/browser';
import { Folder, ViewServer } from '../support/command';

const EDITS = Number(process.env.KERF_VIEW_EDITS ?? 40);
const LINES = 12_000; // several blocks
const folder = new Folder();

/** The same numbers in every run. */
let state = 7;
function below(count: number): number {
  state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
  return Math.floor((state / 2 ** 32) * count);
}

function program(): string[] {
  const lines = ['G21 G90 G17', 'T102 M6', 'M3 S16000', 'G0 X0 Y0 Z5', 'G1 Z-1 F300'];
  while (lines.length < LINES) lines.push(motion());
  return [...lines, 'G0 Z5', 'M30', 'o100', 'G91', 'G1 X0.1', 'G1 Y0.2', 'G90', 'M99'];
}

function motion(): string {
  const x = (below(60_000) / 1000).toFixed(3);
  const y = (below(40_000) / 1000).toFixed(3);
  switch (below(12)) {
    case 0:
      return `G0 X${x} Y${y}`;
    case 1:
      return `G2 X${x} Y${y} R200`;
    case 2:
      return `G1 X${x} Y${y} F${100 + below(9) * 100}`;
    case 3:
      return `G4 P0.${1 + below(9)}`;
    default:
      return `G1 X${x} Y${y} Z-${(below(3000) / 1000).toFixed(3)}`;
  }
}

/** One change of the lines. */
function edit(lines: string[]): void {
  const at = 5 + below(LINES - 10);
  switch (below(8)) {
    case 0:
      return void lines.splice(at, 1);
    case 1:
      return void lines.splice(at, 1 + below(2000));
    case 2:
      return void lines.splice(at, 0, motion());
    case 3:
      return void lines.splice(at, 0, ...Array.from({ length: 1 + below(500) }, motion));
    case 4:
      return void lines.splice(at, 0, 'G0 Z5', `T${101 + below(2)} M6`, 'M3 S12000');
    case 5:
      return void (lines[0] = lines[0] === 'G21 G90 G17' ? 'G20 G90 G17' : 'G21 G90 G17');
    case 6:
      // Two changes far apart.
      lines[at] = motion();
      return void lines.splice(5 + below(100), 0, `(${'a comment'.repeat(below(5))})`);
    default:
      return void (lines[at] = motion());
  }
}

/** What the motions are, whatever the blocks: numbers for a quick comparison. */
function plain(path: Path): unknown {
  const chains = Array.from({ length: path.motions }, (_, m) => JSON.stringify(path.chain(m)));
  const start = Array.from({ length: path.motions }, (_, m) => [
    ...path.points.subarray(3 * path.firstPoint(m), 3 * path.firstPoint(m) + 3),
  ]);
  const end = Array.from({ length: path.motions }, (_, m) => [
    ...path.points.subarray(3 * path.endPoint[m]! - 3, 3 * path.endPoint[m]!),
  ]);
  const { step, tool, kind, seconds, feed, flow, power, bead } = path;
  const numbers = [step, tool, kind, seconds, feed, flow ?? [], power ?? [], bead ?? []].map((v) => [...v]);
  return { numbers, chains, start, end };
}

/** The model once its revision is above `after`. */
async function revision(of: ViewServer, after: number): Promise<Model> {
  for (;;) {
    const model = (await (await of.get('model')).json()) as Model;
    if (model.revision > after) return model;
    await new Promise((done) => setTimeout(done, 30));
  }
}

/** The text of the program, of which the blocks that the page has are not asked for again. */
async function textOf(of: ViewServer, model: Model, known: Map<number, string>): Promise<string> {
  let text = model.files[0]!.text ?? '';
  for (const [id] of model.files[0]!.blocks ?? []) {
    if (!known.has(id)) known.set(id, await (await of.get(`source?id=${id}`)).text());
    text += known.get(id)!;
  }
  return text;
}

const bytes = async (of: ViewServer, since: number) =>
  (await of.get(`path?since=${since}`)).arrayBuffer();

afterAll(() => folder.remove());

test('random edits', async () => {
  const lines = program();
  const file = folder.write('part.nc', lines.join('\n'));
  const server = await ViewServer.start(file, '--resolution', '2');
  let model = await revision(server, 0);
  let path = decodePath(await bytes(server, 0));
  const texts = new Map<number, string>();
  let sent = 0;
  let whole = 0;
  for (let k = 0; k < EDITS; ++k) {
    if (lines.length < LINES / 2) lines.splice(5, 0, ...Array.from({ length: LINES / 2 }, motion));
    edit(lines);
    writeFileSync(file, lines.join('\n'));
    model = await revision(server, model.revision);
    const changed = await bytes(server, path.revision);
    path = decodePath(changed, path);
    const all = await bytes(server, 0);
    sent += changed.byteLength;
    whole += all.byteLength;
    expect(path.motions).toBe(model.motions);
    expect(await textOf(server, model, texts)).toBe(lines.join('\n'));
    expect(plain(path), `edit ${k}`).toEqual(plain(decodePath(all)));
    if (k % 10 !== 9) continue;
    const other = await ViewServer.start(file, '--resolution', '2');
    await revision(other, 0);
    expect(plain(path), `edit ${k}`).toEqual(plain(decodePath(await bytes(other, 0))));
    await other.end();
  }
  await server.end();
  expect(sent).toBeLessThan(whole / 2);
}, 300_000);

test('a page shows the lines of a large program, also after an edit', async () => {
  const browser = await startBrowser();
  const lines = program();
  const file = folder.write('shown.nc', lines.join('\n'));
  const own = await ViewServer.start(file, '--resolution', '2');
  const { page, errors } = await open(browser, own.address);
  await shows(page, 1);
  await page.locator('#tab-source').click();
  const list = page.locator('#source-list');
  const row = (line: number) => page.locator(`#line-${line} .text`);
  await expect.poll(() => row(3).textContent()).toBe('M3 S16000');
  await list.evaluate((e) => (e.scrollTop = 7000 * 20));
  await expect.poll(() => row(7005).textContent()).toBe(lines[7004]);
  lines.splice(20, 0, '(one line more)');
  writeFileSync(file, lines.join('\n'));
  await shows(page, 2);
  await expect.poll(() => row(7005).textContent()).toBe(lines[7004]);
  // A click on a line shows its motions.
  await row(7005).click();
  await expect.poll(() => page.locator('#state').textContent()).toContain('Line 7005: ');
  expect(errors).toEqual([]);
  await browser.close();
  await own.end();
}, 120_000);

test('more lines than a browser can scroll', async () => {
  const browser = await startBrowser();
  const comments = Array.from({ length: 900_000 }, (_, k) => `(comment ${k})`);
  const lines = program().slice(0, 50).concat(comments, ['G0 Z5', 'M30']);
  const own = await ViewServer.start(folder.write('long.nc', lines.join('\n')), '--resolution', '2');
  const { page, errors } = await open(browser, own.address);
  await shows(page, 1);
  await page.locator('#tab-source').click();
  const list = page.locator('#source-list');
  const row = (line: number) => page.locator(`#line-${line} .text`);
  await list.evaluate((e) => (e.scrollTop = e.scrollHeight));
  const last = lines.length;
  await expect.poll(() => row(last).textContent()).toBe('M30');
  // The last line is at the lower edge, and a click on a line takes that line.
  const bottom = async () => (await row(last).boundingBox())!;
  const frame = (await list.boundingBox())!;
  expect(Math.abs((await bottom()).y + (await bottom()).height - frame.y - frame.height)).toBeLessThan(24);
  await row(last - 3).click();
  await expect.poll(() => page.locator('#state').textContent()).toContain(`Line ${last - 3}: `);
  await list.evaluate((e) => (e.scrollTop = e.scrollHeight / 2));
  // Until the list has scrolled its rows are those of the end.
  const shownLine = async () => Number(await list.locator('.row').nth(25).getAttribute('data-line'));
  await expect.poll(shownLine).toBeLessThan(460_000);
  const line = await shownLine();
  expect(line).toBeGreaterThan(440_000);
  await expect.poll(() => row(line).textContent()).toBe(lines[line - 1]);
  await list.focus();
  await page.keyboard.press('Home');
  await expect.poll(() => row(2).textContent()).toBe('T102 M6');
  await page.keyboard.press('End');
  await expect.poll(() => row(last).textContent()).toBe('M30');
  expect(errors).toEqual([]);
  await browser.close();
  await own.end();
}, 120_000);

test('an inserted line changes its block alone', async () => {
  const lines = program();
  const file = folder.write('other.nc', lines.join('\n'));
  const own = await ViewServer.start(file, '--resolution', '2');
  const { revision: first } = await revision(own, 0);
  const before = decodePath(await bytes(own, 0));
  lines.splice(6000, 0, 'G1 X30.5 Y20.25 Z-0.5');
  writeFileSync(file, lines.join('\n'));
  await revision(own, first);
  const after = decodePath(await bytes(own, before.revision), before);
  await own.end();
  const known = new Set(before.blocks.map((b) => b.content.id));
  const changed = after.blocks.filter((b) => !known.has(b.content.id));
  expect(before.blocks.length).toBeGreaterThan(4);
  expect(changed.length).toBeGreaterThan(0);
  expect(changed.length).toBeLessThanOrEqual(2);
}, 60_000);
