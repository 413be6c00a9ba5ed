// Random bytes and damaged answers: each is read or refused with a DecodeError, and nothing that was read
// points outside its arrays.
import { expect, test } from 'vitest';
import { DecodeError, decodeMesh, decodeTarget } from '../../src/decode';
import { decodePath } from '../../src/path';
import { encodeMesh, encodePath, encodeTarget } from '../support/encode';

/** The same numbers in every run. */
function generator(seed: number): () => number {
  let state = seed >>> 0;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state;
  };
}

const TILE = { id: 1, level: 0, positions: [0, 0, 0, 1, 0, 0, 0, 1, 0.5], index: [0, 1, 2], step: [3] };
const SAMPLES = [
  encodeMesh(3, [TILE, { ...TILE, id: 2 }], 1),
  encodeMesh(3, [], 0, 7, [
    [
      [2, 1],
      [9, -1],
    ],
  ]),
  encodePath(
    3,
    [
      { step: 1, origin: 0, points: [0, 0, 0, 1, 1, 1] },
      { step: 2, origin: 1, points: [] },
    ],
    [
      { file: 0, line: 1 },
      { file: 0, line: 2, caller: 0 },
    ],
    { flow: [0, 1.5], block: 1 },
  ),
  encodeTarget(3, 2, 2, 0, 0, 0.5, [0, 0.5, -0.5, 0]),
];

function damaged(sample: ArrayBuffer, next: () => number): ArrayBuffer {
  const bytes = new Uint8Array(sample.slice(0));
  for (let changes = 1 + (next() % 4); changes > 0; --changes) {
    const at = next() % bytes.length;
    // Whole fields are set to edge values as often as single bytes.
    const edges = [0, 1, 0xff, 0x7f, 0x80, next() & 0xff];
    const value = edges[next() % edges.length]!;
    const length = next() % 2 === 0 ? 1 : 4;
    bytes.fill(value, at & ~(length - 1), Math.min((at & ~(length - 1)) + length, bytes.length));
  }
  const end = next() % 3 === 0 ? next() % (bytes.length + 1) : bytes.length;
  return bytes.buffer.slice(0, end);
}

function readMesh(buffer: ArrayBuffer): void {
  const mesh = decodeMesh(buffer);
  for (const tile of mesh.tiles) {
    expect(tile.step.length * 3).toBe(tile.index.length);
    for (const i of tile.index) expect(i * 3 + 2).toBeLessThan(tile.positions.length);
  }
}

function readTarget(buffer: ArrayBuffer): void {
  const found = decodeTarget(buffer);
  expect(found.depth.length).toBe(found.nx * found.ny);
}

function readPath(buffer: ArrayBuffer): void {
  const path = decodePath(buffer);
  expect(path.flow?.length ?? path.motions).toBe(path.motions);
  for (let m = 0; m < path.motions; ++m) {
    expect(3 * path.endPoint[m]!).toBeLessThanOrEqual(path.points.length);
    expect(path.firstPoint(m)).toBeGreaterThanOrEqual(0);
    expect(path.chain(m).length).toBeLessThanOrEqual(4);
  }
}

test.each([
  ['mesh', readMesh, [0, 1]],
  ['toolpath', readPath, [2]],
  ['comparison', readTarget, [3]],
])('%s: 20,000 damaged answers are read or refused', (_name, decode, samples) => {
  const next = generator(20);
  let refused = 0;
  for (let k = 0; k < 20_000; ++k) {
    const sample = SAMPLES[samples[k % samples.length]!]!;
    try {
      decode(damaged(sample, next));
    } catch (error) {
      expect(error).toBeInstanceOf(DecodeError);
      ++refused;
    }
  }
  expect(refused).toBeGreaterThan(5_000);
  expect(refused).toBeLessThan(20_000);
});
