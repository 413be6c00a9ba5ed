// Reading tiles and maps: right ones field by field, damaged ones refused.
import { deflateSync } from 'node:zlib';
import { describe, expect, test } from 'vitest';
import {
  DecodeError,
  decodeMesh,
  decodeTarget,
  FINAL,
  NO_STEP,
  renumber,
  unpack,
} from '../../src/decode';
import { encodeMesh, encodeTarget } from '../support/encode';

const TILE = {
  id: 7,
  level: 2,
  positions: [0, 0, 0, 1, 0, 0, 0, 1, 0.5],
  index: [0, 1, 2],
  step: [NO_STEP],
};
/** The bytes with one 32-bit field replaced. */
function patched(buffer: ArrayBuffer, at: number, value: number): ArrayBuffer {
  const copy = buffer.slice(0);
  new DataView(copy).setUint32(at, value, true);
  return copy;
}

describe('mesh', () => {
  test('fields of a tile', () => {
    const mesh = decodeMesh(encodeMesh(12, [TILE], 1, 40));
    expect(mesh).toMatchObject({ revision: 12, reset: true, atStep: 40 });
    const [tile] = mesh.tiles;
    expect(tile).toMatchObject({ id: 7, level: 2 });
    expect([...tile!.positions]).toEqual(TILE.positions);
    expect([...tile!.index]).toEqual([0, 1, 2]);
    expect([...tile!.step]).toEqual([NO_STEP]);
  });

  test('no tiles, and an empty tile', () => {
    expect(decodeMesh(encodeMesh(1, [])).tiles).toEqual([]);
    const mesh = decodeMesh(encodeMesh(1, [{ id: 3, positions: [], index: [], step: [] }]));
    expect(mesh.atStep).toBe(FINAL);
    expect(mesh.tiles[0]!.index.length).toBe(0);
  });

  test('every shortened answer is refused', () => {
    const whole = encodeMesh(1, [TILE]);
    for (let size = 0; size < whole.byteLength; ++size) {
      expect(() => decodeMesh(whole.slice(0, size)), `${size} bytes`).toThrow(DecodeError);
    }
  });

  test.each([
    ['magic', 0, 0x12345678],
    ['version', 4, 2],
    ['number of tiles', 20, 0xffffffff],
    ['number of tables', 24, 0xffffffff],
    ['number of vertices', 36, 0xffffffff],
    ['number of triangles', 40, 0x7fffffff],
    ['a vertex that is not there', 80, 3],
    ['a position that is not a number', 44, 0x7fc00000],
    ['an infinite position', 48, 0x7f800000],
  ])('%s', (_what, at, value) => {
    expect(() => decodeMesh(patched(encodeMesh(1, [TILE]), at, value))).toThrow(DecodeError);
  });

  test('new numbers of steps', () => {
    // Two lines removed before step 5, then one inserted before step 3.
    const mesh = decodeMesh(
      encodeMesh(3, [TILE], 0, FINAL, [
        [[5, -2]],
        [
          [3, 1],
          [9, 4],
        ],
      ]),
    );
    expect(mesh.renumberings.length).toBe(2);
    const step = Uint32Array.of(0, 2, 4, 5, 11, NO_STEP);
    for (const table of mesh.renumberings) renumber(step, table);
    expect([...step]).toEqual([0, 2, 5, 4, 13, NO_STEP]);
    expect(mesh.tiles[0]!.id).toBe(7);
    expect(() =>
      decodeMesh(
        encodeMesh(3, [], 0, FINAL, [
          [
            [5, 1],
            [5, 2],
          ],
        ]),
      ),
    ).toThrow(/not in order/);
  });

  test('further bytes at the end', () => {
    const whole = new Uint8Array(encodeMesh(1, [TILE]));
    expect(() => decodeMesh(new Uint8Array([...whole, 0, 0, 0, 0]).buffer)).toThrow(/unexpected bytes/);
  });
});

test('data blocks of an exported page', async () => {
  const text = 'Grüße, 3 × 4';
  const packed = Buffer.from(deflateSync(Buffer.from(text))).toString('base64');
  expect(new TextDecoder().decode(await unpack(`\n${packed}\n`))).toBe(text);
  await expect(unpack('AAAA')).rejects.toThrow();
});

describe('target', () => {
  test('the differences of all columns', () => {
    const found = decodeTarget(encodeTarget(4, 3, 2, -1, 5, 0.25, [0, 0.5, -0.25, 0, 0, 1]));
    expect(found).toMatchObject({ revision: 4, nx: 3, ny: 2, x: -1, y: 5, pitch: 0.25 });
    expect([...found.depth]).toEqual([0, 0.5, -0.25, 0, 0, 1]);
  });

  test.each([
    ['too few columns', encodeTarget(1, 3, 2, 0, 0, 1, [0, 0])],
    ['more columns than memory', encodeTarget(1, 0xffffffff, 0xffffffff, 0, 0, 1, [])],
    ['no pitch', encodeTarget(1, 1, 1, 0, 0, 0, [0])],
    ['not a number', encodeTarget(1, 1, 1, 0, 0, 1, [NaN])],
  ])('%s is refused', (_what, bytes) => {
    expect(() => decodeTarget(bytes)).toThrow(DecodeError);
  });
});
