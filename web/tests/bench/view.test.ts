// The speed of `kerf view` in a real browser: from a save to the picture, from a move of the scrubber to the
// picture, from opening the address to the picture. Writes rows in the form of Google Benchmark to the file
// KERF_BENCH_OUT. On a machine that renders in software the time of drawing is part of each figure.
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { gzipSync } from 'node:zlib';
import type { Page } from 'playwright-core';
import { afterAll, beforeAll, expect, test } from 'vitest';
import { open, shows, startBrowser } from '../support/browser';
import { EXAMPLES, Folder, ViewServer } from '../support/command';

const RUNS = 20;
const MOVES = Number(process.env.KERF_BENCH_MOVES ?? 1_000_000);
const rows: { name: string; real_time: number; time_unit: string; [counter: string]: unknown }[] = [];
let browser: Awaited<ReturnType<typeof startBrowser>>;

beforeAll(async () => {
  browser = await startBrowser();
});
afterAll(async () => {
  await browser.close();
  if (process.env.KERF_BENCH_OUT)
    writeFileSync(process.env.KERF_BENCH_OUT, JSON.stringify({ benchmarks: rows }));
});

const now = () => performance.timeOrigin + performance.now();
const median = (values: number[]) => [...values].sort((a, b) => a - b)[values.length >> 1]!;

function note(name: string, times: number[], more: Record<string, unknown> = {}): void {
  const row = { name: `view/${name}`, real_time: median(times), time_unit: 'ms', ...more };
  rows.push(row);
  console.log(
    `${row.name}: median ${row.real_time.toFixed(1)} ms of ${times.length}, ` +
      `largest ${Math.max(...times).toFixed(1)} ms`,
  );
}

/** Notes in the page when a change of the root element's data has been drawn. */
async function watchFrames(page: Page): Promise<void> {
  await page.evaluate(() => {
    const root = document.documentElement;
    new MutationObserver(() => {
      const state = `${root.dataset.revision} ${root.dataset.instant}`;
      requestAnimationFrame(() =>
        requestAnimationFrame(() => {
          (window as unknown as { drawn: [string, number] }).drawn = [
            state,
            performance.timeOrigin + performance.now(),
          ];
        }),
      );
    }).observe(root, { attributes: true, attributeFilter: ['data-revision', 'data-instant'] });
  });
}

/** When the state was drawn, ms since the epoch. */
async function drawnAt(page: Page, state: string): Promise<number> {
  const handle = await page.waitForFunction((wanted) => {
    const drawn = (window as unknown as { drawn?: [string, number] }).drawn;
    return drawn && drawn[0].startsWith(wanted) ? drawn[1] : 0;
  }, state);
  return handle.jsonValue();
}

async function saves(file: string, versions: (k: number) => string, page: Page): Promise<number[]> {
  const times: number[] = [];
  for (let k = 0; k < RUNS; ++k) {
    const text = versions(k);
    const revision = Number(await page.evaluate(() => document.documentElement.dataset.revision)) + 1;
    const start = now();
    writeFileSync(file, text);
    times.push((await drawnAt(page, `${revision} `)) - start);
  }
  return times;
}

/** A relief of lines along X: rows of points 0.4 mm apart, depths from a wave. */
function relief(moves: number, change: number): string {
  const side = Math.ceil(Math.sqrt(moves));
  const step = 100 / side;
  const lines = [
    '(STOCK/BLOCK, 100, 100, 10, 0, 0, 10)',
    'G21 G90',
    'T101 M6',
    'M3 S16000',
    'G0 X0 Y0 Z2',
    'G1 Z0 F800',
  ];
  for (let j = 0; j < side; ++j) {
    for (let i = 0; i < side; ++i) {
      const x = (j % 2 ? side - 1 - i : i) * step;
      const z = -2 - Math.sin(x / 7) * Math.cos((j * step) / 9) - (j * side + i === change ? 1 : 0);
      lines.push(`G1 X${x.toFixed(3)} Y${(j * step).toFixed(3)} Z${z.toFixed(3)}`);
    }
  }
  lines.push('G0 Z5', 'M2', '');
  return lines.join('\n');
}

test('the demo: save to picture, and the size of the page', async () => {
  const folder = new Folder();
  const source = readFileSync(join(EXAMPLES, 'demo.nc'), 'utf8');
  const file = folder.write('demo.nc', source);
  const server = await ViewServer.start(file, '--resolution', '0.15');
  const { page } = await open(browser, server.address);
  await shows(page, 1);
  await watchFrames(page);
  const lines = source.split('\n');
  const edited = lines.findIndex((l) => /^G1 X.* Z-1\.9/.test(l));
  expect(edited).toBeGreaterThan(0);
  const versions = (k: number) =>
    lines
      .map((l, i) => (i === edited ? l.replace(/Z-[0-9.]+/, `Z-${(1.5 + 0.05 * k).toFixed(2)}`) : l))
      .join('\n');
  const html = Buffer.from(await (await server.get('')).arrayBuffer());
  note('save_to_picture/demo', await saves(file, versions, page), { page_kB: gzipSync(html).length / 1000 });
  await page.context().close();
  await server.end();
  folder.remove();
}, 300_000);

test('a relief: first picture, save to picture, scrubbing', async () => {
  const folder = new Folder();
  const file = folder.write('relief.nc', relief(MOVES, -1));
  const server = await ViewServer.start(file, '--resolution', '0.1');
  const state = async () => (await (await server.get('model')).json()) as { revision: number };
  while ((await state()).revision === 0) await new Promise((done) => setTimeout(done, 100));
  const start = now();
  const { page } = await open(browser, server.address);
  page.setDefaultTimeout(300_000);
  await shows(page, 1);
  note(`first_picture/relief_${MOVES}`, [now() - start]);
  await watchFrames(page);
  note(
    `save_to_picture/relief_${MOVES}`,
    await saves(file, (k) => relief(MOVES, (MOVES >> 1) + 50 * k), page),
  );

  const times: number[] = [];
  const steps = await page.evaluate(() => Number(document.querySelector<HTMLInputElement>('#time')!.max));
  for (let k = 1; k <= RUNS; ++k) {
    const begin = now();
    // Instants all over the job, each far from the one before.
    const time = steps * ((k * 0.381966) % 1);
    await page.locator('#time').evaluate((e: HTMLInputElement, t) => {
      (window as unknown as { drawn?: unknown }).drawn = undefined;
      e.value = String(t);
      e.dispatchEvent(new Event('input'));
    }, time);
    times.push((await drawnAt(page, '')) - begin);
  }
  note(`scrub/relief_${MOVES}`, times);
  await page.context().close();
  await server.end();
  folder.remove();
}, 900_000);
