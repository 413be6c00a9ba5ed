// One browser for the tests of a file, and a new folder for each of them.
import type { Browser } from 'playwright-core';
import { afterAll, beforeAll, beforeEach } from 'vitest';
import { startBrowser } from './browser';
import { Folder } from './command';

export let browser: Browser;
/** Each file removes it after a test, once its server has ended. */
export let folder: Folder;

export function useBrowserAndFolder(): void {
  beforeAll(async () => {
    browser = await startBrowser();
  });
  afterAll(async () => {
    await browser?.close();
  });
  beforeEach(() => {
    folder = new Folder();
  });
}
