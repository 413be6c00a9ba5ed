// Starts Debian's Chromium without network access of its own, and collects what the page reports as errors.
import { existsSync } from 'node:fs';
import { type Browser, type BrowserContextOptions, chromium, type Page } from 'playwright-core';

export const CHROMIUM = process.env.KERF_CHROMIUM ?? '/usr/bin/chromium';

/** ms for what takes a fraction of a second on a machine without other work. */
export const PATIENCE = 40_000;

export async function startBrowser(): Promise<Browser> {
  if (!existsSync(CHROMIUM)) throw new Error(`${CHROMIUM} is missing: apt-get install chromium`);
  return chromium.launch({
    executablePath: CHROMIUM,
    args: [
      '--no-sandbox',
      '--disable-quic',
      '--no-first-run',
      '--disable-background-networking',
      '--disable-component-update',
      '--disable-sync',
      '--force-color-profile=srgb',
      '--font-render-hinting=none',
    ],
  });
}

export interface Opened {
  page: Page;
  errors: string[];
}

/**
 * A new page of 1100 x 720 with light colours, unless options differ; opens the address and waits for the
 * part.
 */
export async function open(
  browser: Browser,
  address: string,
  options: BrowserContextOptions = {},
): Promise<Opened> {
  const context = await browser.newContext({
    viewport: { width: 1100, height: 720 },
    colorScheme: 'light',
    reducedMotion: 'reduce',
    ...options,
  });
  const page = await context.newPage();
  page.setDefaultTimeout(PATIENCE);
  const errors: string[] = [];
  page.on('pageerror', (error) => errors.push(String(error)));
  page.on('console', (message) => {
    if (message.type() === 'error') errors.push(message.text());
  });
  await page.goto(address);
  return { page, errors };
}

/** Waits until the page shows this revision, or a later one, and has drawn it. */
export async function shows(page: Page, revision: number): Promise<void> {
  await page.waitForFunction((r) => Number(document.documentElement.dataset.revision) >= r, revision);
  await drawn(page);
}

/** Waits until the page shows the part after so many steps, or the finished one, and has drawn it. */
export async function showsInstant(page: Page, steps: number | 'end'): Promise<void> {
  await page.waitForFunction((s) => document.documentElement.dataset.instant === s, String(steps));
  await drawn(page);
}

/** Waits for two frames. */
export async function drawn(page: Page): Promise<void> {
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
}
