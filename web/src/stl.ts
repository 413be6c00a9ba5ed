// The finished part as binary STL, for pages without a server.
import type { Tile } from './decode';

const HEADER = 84;
const TRIANGLE = 50;

export function stlOf(tiles: readonly Tile[]): ArrayBuffer {
  const count = tiles.reduce((sum, tile) => sum + tile.step.length, 0);
  const bytes = new ArrayBuffer(HEADER + TRIANGLE * count);
  const view = new DataView(bytes);
  view.setUint32(HEADER - 4, count, true);
  let at = HEADER;
  for (const { positions, index } of tiles)
    for (let t = 0; t < index.length; t += 3, at += TRIANGLE) {
      const corner = (k: number) => [0, 1, 2].map((i) => positions[3 * index[t + k]! + i]!);
      const [a, b, c] = [corner(0), corner(1), corner(2)] as [number[], number[], number[]];
      const u = b.map((v, i) => v - a[i]!);
      const w = c.map((v, i) => v - a[i]!);
      const n = [0, 1, 2].map((i) => u[(i + 1) % 3]! * w[(i + 2) % 3]! - u[(i + 2) % 3]! * w[(i + 1) % 3]!);
      const length = Math.hypot(...n) || 1;
      const numbers = [...n.map((v) => v / length), ...a, ...b, ...c];
      for (const [i, v] of numbers.entries()) view.setFloat32(at + 4 * i, v, true);
    }
  return bytes;
}
