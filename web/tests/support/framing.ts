// A page with the viewer in a frame: what it sends, and what it hears.
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import type { Frame, Page } from 'playwright-core';

const MANUAL = join(process.env.KERF_SOURCE_DIR ?? '../..', 'docs/manual/viewer-embedding.md');

/** The example of the manual: a whole page with the viewer in a frame. */
export function examplePage(): string {
  const found = /```html\n(<!doctype html>[^]*?)```/.exec(readFileSync(MANUAL, 'utf8'));
  if (!found) throw new Error('the manual has no example of a page with a frame');
  return found[1]!;
}

/** A page with a frame of this address that keeps what it hears. */
export function framingPage(address: string, attributes = ''): string {
  return `<!doctype html><title>Around</title>
<iframe id="part" src="${address}" width="900" height="600" ${attributes}></iframe>
<script>
window.heard = [];
addEventListener('message', (m) => heard.push({ ...m.data, from: m.origin }));
</script>`;
}

export type Heard = Record<string, unknown>;

export const heard = (page: Page) => page.evaluate(() => (window as unknown as { heard: Heard[] }).heard);

/** The first message that has these members, once it is there. */
export async function hears(page: Page, members: Heard): Promise<Heard> {
  const found = await page.waitForFunction(
    (wanted) =>
      (window as unknown as { heard: Heard[] }).heard.find((one) =>
        Object.entries(wanted).every(([name, value]) => one[name] === value),
      ),
    members,
  );
  return (await found.jsonValue())!;
}

let last = 0;

/** Sends a message to the frame; its answer. */
export async function ask(page: Page, action: Heard): Promise<Heard> {
  const id = ++last;
  await page.evaluate(
    (message) => {
      const frame = document.getElementById('part') as HTMLIFrameElement;
      frame.contentWindow!.postMessage(message, '*');
    },
    { kerf: 1, id, ...action },
  );
  return hears(page, { id });
}

export const viewer = (page: Page): Frame => page.frames()[1]!;
