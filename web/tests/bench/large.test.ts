// A large program in the page, for bench/view_save.py: the time from a save to the picture and the memory of
// the page. KERF_BENCH_LARGE is a folder with before.nc and after.nc, KERF_BENCH_OPTIONS the options of
// `kerf view` as JSON; the figures go to KERF_BENCH_OUT.
import { copyFileSync, readFileSync, renameSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import type { Page } from 'playwright-core';
import { expect, test } from 'vitest';
import { open, shows, startBrowser } from '../support/browser';
import { ViewServer } from '../support/command';

const folder = process.env.KERF_BENCH_LARGE;
const SAVES = 6;
const MB = 1e6;

const now = () => performance.timeOrigin + performance.now();
const median = (values: number[]) => [...values].sort((a, b) => a - b)[values.length >> 1]!;

/** MB of scripts, of the document and of arrays, without unused ones. */
async function memory(page: Page): Promise<{ heap: number; arrays: number }> {
  const devtools = await page.context().newCDPSession(page);
  for (let k = 0; k < 3; ++k) await devtools.send('HeapProfiler.collectGarbage');
  const found = (await devtools.send('Runtime.getHeapUsage')) as unknown as Record<string, number>;
  await devtools.detach();
  return {
    heap: (found.usedSize! + (found.embedderHeapUsedSize ?? 0)) / MB,
    arrays: (found.backingStorageSize ?? 0) / MB,
  };
}

test.skipIf(!folder)(
  'a large program: saves, and memory',
  async () => {
    const file = join(folder!, 'shown.nc');
    copyFileSync(join(folder!, 'before.nc'), file);
    const options = JSON.parse(process.env.KERF_BENCH_OPTIONS ?? '[]') as string[];
    const server = await ViewServer.start(file, ...options);
    const state = async () => (await (await server.get('model')).json()) as { revision: number };
    while ((await state()).revision === 0) await new Promise((done) => setTimeout(done, 100));
    const browser = await startBrowser();
    const begin = now();
    const { page, errors } = await open(browser, server.address);
    page.setDefaultTimeout(300_000);
    await shows(page, 1);
    const opening = now() - begin;
    const first = await memory(page);
    const times: number[] = [];
    for (let k = 0; k < SAVES; ++k) {
      const next = join(folder!, 'next.nc');
      copyFileSync(join(folder!, k % 2 === 0 ? 'after.nc' : 'before.nc'), next);
      const start = now();
      renameSync(next, file);
      await shows(page, k + 2);
      times.push(now() - start);
    }
    const last = await memory(page);
    expect(errors).toEqual([]);
    writeFileSync(
      process.env.KERF_BENCH_OUT!,
      JSON.stringify({
        'opening ms': opening,
        'save to picture ms': median(times),
        'lines of the program': readFileSync(file, 'latin1').split('\n').length - 1,
        'page heap MB': last.heap,
        'page arrays MB': last.arrays,
        'page arrays MB after opening': first.arrays,
      }),
    );
    await browser.close();
    await server.end();
  },
  900_000,
);
