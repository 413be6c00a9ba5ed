// Compares pictures with those in tests/golden. The software renderer gives the same pixels on every
// machine with the same browser; the tolerance is for other versions of it. KERF_GOLDEN=FOLDER writes them
// instead, to that folder.
import { existsSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import type { Browser, Page } from 'playwright-core';
import { drawn } from './browser';

const PIXEL_TOLERANCE = 48; // of 255, in any channel
const DIFFERING_FRACTION = 0.006;
const SHOTS = 'shots';

// One page for all comparisons of a browser: a new one takes longer than a comparison.
const comparers = new WeakMap<Browser, Promise<Page>>();

async function comparer(browser: Browser): Promise<Page> {
  const page = comparers.get(browser) ?? browser.newContext().then((context) => context.newPage());
  comparers.set(browser, page);
  return page;
}

/** The fraction of pixels that differ; 1 if the sizes do. */
export async function differing(browser: Browser, a: Buffer, b: Buffer): Promise<number> {
  const page = await comparer(browser);
  return page.evaluate(
    async ([first, second, tolerance]) => {
      const pixels = async (base64: string) => {
        const image = new Image();
        image.src = `data:image/png;base64,${base64}`;
        await image.decode();
        const canvas = new OffscreenCanvas(image.width, image.height);
        const context2d = canvas.getContext('2d')!;
        context2d.drawImage(image, 0, 0);
        return context2d.getImageData(0, 0, image.width, image.height);
      };
      const [x, y] = [await pixels(first), await pixels(second)];
      if (x.width !== y.width || x.height !== y.height) return 1;
      let count = 0;
      for (let i = 0; i < x.data.length; i += 4) {
        const d = Math.max(...[0, 1, 2].map((k) => Math.abs(x.data[i + k]! - y.data[i + k]!)));
        if (d > tolerance) ++count;
      }
      return count / (x.width * x.height);
    },
    [a.toString('base64'), b.toString('base64'), PIXEL_TOLERANCE] as const,
  );
}

/**
 * Gives the picture a size that does not depend on the fonts of the machine, for comparisons with stored
 * pictures.
 */
export async function fixSize(page: Page, width = 770, height = 589): Promise<void> {
  await page.evaluate(
    ([w, h]) => {
      const main = document.querySelector('main')!;
      const isWide = getComputedStyle(main).gridTemplateColumns.includes(' ');
      if (isWide) main.style.gridTemplateColumns = `${w}px minmax(0, 1fr)`;
      main.style.gridTemplateRows = `${h}px minmax(0, 1fr)`;
    },
    [width, height] as const,
  );
  await drawn(page);
}

/** The drawn part alone, at rest, without the texts above it: their font is that of the system. */
export async function canvasPicture(page: Page): Promise<Buffer> {
  await drawn(page);
  await page.waitForSelector('#canvas[data-detail="full"]');
  const show = (visibility: string) =>
    page.evaluate((value) => {
      for (const each of document.querySelectorAll<HTMLElement>('.float, .labels, #message'))
        each.style.visibility = value;
    }, visibility);
  await show('hidden');
  const picture = await page.locator('#canvas').screenshot();
  await show('');
  return picture;
}

/**
 * Fails if the picture of the part is not the one in tests/golden/NAME.png. The whole page is kept in
 * shots/.
 */
export async function matchesGolden(browser: Browser, page: Page, name: string): Promise<void> {
  const picture = await canvasPicture(page);
  mkdirSync(SHOTS, { recursive: true });
  await page.screenshot({ path: join(SHOTS, `${name}.png`) });
  const update = process.env.KERF_GOLDEN;
  if (update) {
    mkdirSync(update, { recursive: true });
    writeFileSync(join(update, `${name}.png`), picture);
    return;
  }
  const path = join('tests/golden', `${name}.png`);
  if (!existsSync(path)) throw new Error(`${path} is missing; KERF_GOLDEN=FOLDER writes it`);
  const fraction = await differing(browser, picture, readFileSync(path));
  if (fraction > DIFFERING_FRACTION) {
    writeFileSync(join(SHOTS, `${name}.found.png`), picture);
    throw new Error(
      `${(100 * fraction).toFixed(2)} % of the pixels of ${name} differ; see shots/${name}.found.png`,
    );
  }
}
