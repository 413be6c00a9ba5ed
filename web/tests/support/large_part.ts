// A part of many triangles: a block with fine waves on its top, in the form of /mesh.
const SIDES = 8; // tiles along each side
const HEIGHT = 10; // mm

export interface LargePart {
  mesh: ArrayBuffer;
  triangles: number;
  /** mm between the corners. */
  pitch: number;
}

function words(...values: number[]): Uint8Array {
  return new Uint8Array(Uint32Array.from(values).buffer);
}

/** `cells`: along X in each of the tiles; the part is 60 x 40 mm, its top below Z 0. */
export function largePart(revision: number, cells: number): LargePart {
  const [width, depth] = [60, 40];
  const parts = [new TextEncoder().encode('KMSH'), words(1, revision, 1, 0xffffffff, SIDES * SIDES, 0)];
  for (let id = 0; id < SIDES * SIDES; ++id) {
    const count = (cells + 1) ** 2;
    const positions = new Float32Array(3 * count);
    for (let v = 0; v < count; ++v) {
      const x = (width / SIDES) * ((id % SIDES) + (v % (cells + 1)) / cells);
      const y = (depth / SIDES) * (Math.floor(id / SIDES) + Math.floor(v / (cells + 1)) / cells);
      const wave = Math.sin(2.1 * x) * Math.cos(1.3 * y) + 0.3 * Math.sin(9 * x + 7 * y);
      positions.set([x, y, wave - HEIGHT / 2], 3 * v);
    }
    const index = new Uint32Array(6 * cells * cells);
    for (let c = 0; c < cells * cells; ++c) {
      const v = Math.floor(c / cells) * (cells + 1) + (c % cells);
      index.set([v, v + 1, v + cells + 2, v, v + cells + 2, v + cells + 1], 6 * c);
    }
    const steps = [3, 6, 0xffffffff];
    const step = new Uint32Array(2 * cells * cells).map((_, t) => steps[Math.floor(t / 40) % 3]!);
    parts.push(words(id, 0, count, step.length));
    for (const array of [positions, index, step]) parts.push(new Uint8Array(array.buffer));
  }
  return {
    mesh: new Uint8Array(Buffer.concat(parts)).buffer,
    triangles: SIDES * SIDES * 2 * cells * cells,
    pitch: width / SIDES / cells,
  };
}
