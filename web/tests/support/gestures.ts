// What people do with the page, in mm.
import type { Page } from 'playwright-core';
import { drawn } from './browser';

export const text = (page: Page, selector: string) => page.locator(selector).innerText();

/** X, Y, Z and depth that the page reads out at a pixel of the canvas, in mm; empty: nothing is there. */
export async function readOut(page: Page, x: number, y: number): Promise<number[]> {
  const box = (await page.locator('#canvas').boundingBox())!;
  await page.mouse.move(box.x + x, box.y + y);
  await drawn(page);
  const found = (await text(page, '#readout')).match(
    /X\s+(\S+)\s+Y\s+(\S+)\s+Z\s+(\S+)(?:\s+depth\s+(\S+))?/,
  );
  return found ? found.slice(1).map(Number) : [];
}

/** Turns to the top view, whose scale the read-out measures; the pixel of the canvas at x, y in mm. */
export async function pixelAt(page: Page, x: number, y: number): Promise<[number, number]> {
  await page.keyboard.press('2');
  await drawn(page);
  const box = (await page.locator('#canvas').boundingBox())!;
  const [cx, cy] = [box.width / 2, box.height / 2];
  const a = await readOut(page, cx - 50, cy);
  const b = await readOut(page, cx + 50, cy);
  const scale = 100 / (b[0]! - a[0]!);
  const centre = (a[0]! + b[0]!) / 2;
  return [cx + (x - centre) * scale, cy - (y - a[1]!) * scale];
}

/** Clicks the position x, y in mm in the top view. */
export async function clickAt(page: Page, x: number, y: number): Promise<void> {
  const [px, py] = await pixelAt(page, x, y);
  const box = (await page.locator('#canvas').boundingBox())!;
  await page.mouse.click(box.x + px, box.y + py);
  await drawn(page);
}
