// Parts of more triangles than the software renderer draws in a frame: coarser while the view moves, in full
// at rest, and the page answers meanwhile.
import type { Browser, Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, beforeEach, expect, test } from 'vitest';
import { drawn, open, type Opened, shows, startBrowser } from '../support/browser';
import { canvasPicture, differing, fixSize } from '../support/golden';
import { type LargePart, largePart } from '../support/large_part';
import { MockServer } from '../support/mock_server';

let browser: Browser;
let server: MockServer;
let address: string;
let part: LargePart;
const opened: Opened[] = [];

beforeAll(async () => {
  browser = await startBrowser();
  part = largePart(1, 90);
});
afterAll(async () => {
  await browser?.close();
});
beforeEach(async () => {
  server = new MockServer();
  server.mesh = part.mesh;
  server.changeModel = (model) => (model.pitch = part.pitch);
  address = await server.start();
});
afterEach(async () => {
  for (const { page, errors } of opened.splice(0)) {
    expect(errors).toEqual([]);
    await page.context().close();
  }
  await server.close();
});

/** `renderer`: the name by which the page knows it, instead of its own. */
async function start(renderer = ''): Promise<Page> {
  const one = await open(browser, 'about:blank');
  opened.push(one);
  const { page } = one;
  await page.addInitScript(watch, renderer);
  await page.goto(address);
  await shows(page, 1);
  await fixSize(page);
  return page;
}

interface Log {
  log: string[];
}

/** Keeps what the canvas says about its state, with the events and the frames between. */
function watch(renderer: string): void {
  const log: string[] = [];
  (window as unknown as Log).log = log;
  addEventListener('DOMContentLoaded', () => {
    const canvas = document.getElementById('canvas')!;
    const state = ({ detail, slices, triangles }: DOMStringMap) => `${detail} ${slices} ${triangles}`;
    const note = () => log.push(state(canvas.dataset));
    new MutationObserver(note).observe(canvas, { attributeFilter: ['data-detail', 'data-slices'] });
    canvas.addEventListener('pointermove', () => log.push('move'), { capture: true });
    const frame = () => {
      if (log[log.length - 1] !== 'frame') log.push('frame');
      requestAnimationFrame(frame);
    };
    frame();
  });
  if (!renderer) return;
  const own = WebGL2RenderingContext.prototype.getParameter;
  const UNMASKED_RENDERER = 0x9246;
  WebGL2RenderingContext.prototype.getParameter = function (name) {
    return name === UNMASKED_RENDERER ? renderer : (own.call(this, name) as unknown);
  };
}

const forget = (page: Page) => page.evaluate(() => ((window as unknown as Log).log.length = 0));
const logOf = (page: Page) => page.evaluate(() => [...(window as unknown as Log).log]);
const rests = (page: Page) => page.waitForSelector('#canvas[data-detail="full"]');
const triangles = async (page: Page) => Number(await page.getAttribute('#canvas', 'data-triangles'));

test('at rest the whole surface is drawn, in slices between which the page has its frames', async () => {
  const page = await start();
  await rests(page);
  await forget(page);
  await page.keyboard.press('1');
  await rests(page);
  expect(await triangles(page)).toBe(part.triangles);
  const log = await logOf(page);
  const moving = log.filter((entry) => entry.startsWith('moving'));
  expect(moving.length).toBeGreaterThan(0);
  expect(Number(moving[moving.length - 1]!.split(' ')[2])).toBeLessThan(part.triangles / 4);
  const slices = log.filter((entry) => entry.startsWith('slices'));
  expect(slices.length).toBeGreaterThan(part.triangles / 65_536);
  slices.forEach((entry, k) => {
    expect(entry).toMatch(new RegExp(`^slices ${k + 1} `));
    if (k > 0) expect(log[log.indexOf(entry) - 1]).toBe('frame');
  });
});

test('the picture at rest is the one that full detail gives at once', async () => {
  const [sliced, whole] = [await start(), await start('a graphics processor')];
  for (const key of ['1', '4', 'x']) {
    const pictures = [];
    for (const page of [sliced, whole]) {
      await page.keyboard.press(key);
      await drawn(page);
      await rests(page);
      expect(await triangles(page)).toBe(part.triangles);
      pictures.push(await canvasPicture(page));
    }
    expect(await differing(browser, pictures[0]!, pictures[1]!), key).toBe(0);
  }
  expect((await logOf(whole)).filter((entry) => entry.startsWith('slices'))).toEqual([]);
});

test('a drag stops the slices at once, before the picture is complete', async () => {
  const page = await start();
  await rests(page);
  const box = (await page.locator('#canvas').boundingBox())!;
  await page.mouse.move(box.x + 300, box.y + 300);
  await page.mouse.down();
  for (let turn = 0; turn < 3; ++turn) {
    await page.mouse.move(box.x + 320 + 40 * turn, box.y + 300, { steps: 2 });
    await page.waitForFunction(() => Number(document.getElementById('canvas')!.dataset.slices) >= 2);
    await forget(page);
    await page.mouse.move(box.x + 340 + 40 * turn, box.y + 300);
    await page.waitForFunction(() =>
      /move,(frame,)*(moving|slices)/.test(String((window as unknown as Log).log)),
    );
    const log = await logOf(page);
    const states = (entries: string[]) => entries.filter((entry) => entry.includes(' '));
    for (const entry of states(log.slice(0, log.indexOf('move')))) expect(entry).toMatch(/^slices /);
    const after = states(log.slice(log.indexOf('move')));
    expect(after[0]).toMatch(/^moving 0 /);
    expect(Number(after[0]!.split(' ')[2])).toBeLessThan(part.triangles / 4);
  }
  await page.mouse.up();
  await rests(page);
  expect(await triangles(page)).toBe(part.triangles);
});
