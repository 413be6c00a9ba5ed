// Random use of the real `kerf view` for KERF_SOAK_MINUTES (default 1): clicks, keys, scrubbing, sections
// and saves, some of them with errors. Nothing may be reported in the page's console, and the memory of the
// server may not grow.
import { readFileSync } from 'node:fs';
import { expect, test } from 'vitest';
import { open, shows, startBrowser } from '../support/browser';
import { Folder, ViewServer } from '../support/command';

const MINUTES = Number(process.env.KERF_SOAK_MINUTES ?? 1);
const KEYS = [
  '1',
  '2',
  '3',
  '4',
  'f',
  '+',
  '-',
  ' ',
  ',',
  '.',
  'Home',
  'End',
  'x',
  'm',
  'p',
  'u',
  'l',
  'Escape',
];
// Of the server's memory in the second half of the time, at most: a ratio, and MB for parts of different
// sizes.
const GROWTH = 1.25;
const SLACK = 20;

/** The same numbers in every run: between 0 and 1. */
function generator(seed: number): () => number {
  let state = seed;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
}

/** Resident memory of a process in MB. */
function memory(pid: number): number {
  const found = /VmRSS:\s+(\d+) kB/.exec(readFileSync(`/proc/${pid}/status`, 'utf8'));
  return Number(found?.[1] ?? NaN) / 1000;
}

test(
  `random use for ${MINUTES} minutes`,
  async () => {
    const chance = generator(19);
    const pick = <T>(list: readonly T[]): T => list[Math.floor(chance() * list.length)]!;
    const point = () => `X${(40 * chance()).toFixed(2)} Y${(30 * chance()).toFixed(2)}`;
    const lines = Array.from({ length: 60 }, () => `G1 ${point()}`);
    const program = (wrong: boolean) =>
      [
        '(stockMin:0.00mm, 0.00mm, -6.00mm)',
        '(stockMax:40.00mm, 30.00mm, 0.00mm)',
        'G21 G90\nT102 M6\nM3 S9000\nG0 X5 Y5 Z5\nG1 Z-1 F300',
        ...lines,
        wrong ? 'G1 X[' : 'G0 Z5',
        'M2\n',
      ].join('\n');
    const folder = new Folder();
    const file = folder.write('part.nc', program(false));
    const server = await ViewServer.start(file, '--exact');
    const browser = await startBrowser();
    const { page, errors } = await open(browser, server.address);
    await shows(page, 1);
    const box = (await page.locator('#canvas').boundingBox())!;
    const at = () => [box.x + chance() * box.width, box.y + chance() * box.height] as const;
    const actions: (() => Promise<unknown>)[] = [
      () => page.mouse.click(...at()),
      () => page.mouse.move(...at()),
      async () => {
        await page.mouse.move(...at());
        await page.mouse.down();
        await page.mouse.move(...at(), { steps: 3 });
        await page.mouse.up();
      },
      () => page.mouse.wheel(0, 200 * (chance() - 0.5)),
      () => page.keyboard.press(pick(KEYS)),
      () => page.selectOption('#colour', pick(['tool', 'operation', 'depth', 'step', 'speed', 'layer'])),
      () => page.click(`#tab-${pick(['source', 'problems', 'report'])}`),
      () =>
        page.locator('#time').evaluate((e: HTMLInputElement, part) => {
          e.value = String(Number(e.max) * part);
          e.dispatchEvent(new Event('input'));
        }, chance()),
      async () => {
        lines[Math.floor(chance() * lines.length)] = `G1 ${point()} Z-${(3 * chance()).toFixed(2)}`;
        folder.write('part.nc', program(chance() < 0.2));
      },
    ];
    const start = performance.now();
    const end = start + 60_000 * MINUTES;
    let early = 0;
    let count = 0;
    for (; performance.now() < end; ++count) {
      await pick(actions)();
      if (early === 0 && performance.now() > start + (end - start) / 2) early = memory(server.pid);
    }
    folder.write('part.nc', program(false));
    await page.waitForSelector('#stage:not(.outdated)');
    const late = memory(server.pid);
    console.log(`${count} actions; the server had ${early.toFixed(0)} MB, then ${late.toFixed(0)} MB`);
    expect(errors).toEqual([]);
    expect(late).toBeLessThan(GROWTH * early + SLACK);
    await browser.close();
    expect(await server.end()).toBe(0);
    folder.remove();
  },
  60_000 * MINUTES + 120_000,
);
