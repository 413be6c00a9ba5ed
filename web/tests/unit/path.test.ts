// Reading the toolpath: right answers field by field, damaged ones refused, and unchanged blocks taken from
// the path before.
import { describe, expect, test } from 'vitest';
import { DecodeError } from '../../src/decode';
import { decodePath, MissingBlock, type Path } from '../../src/path';
import { encodePath, type RawMotion } from '../support/encode';

const MOTIONS: RawMotion[] = [
  { step: 1, tool: 3, origin: 0, seconds: 0.5, kind: 0, points: [0, 0, 1, 2, 0, 1] },
  { step: 4, origin: 1, seconds: 2, feed: 300, points: [] },
  { step: 5, tool: 70_000, origin: 1, feed: 300, points: [2, 0, 1, 3, 0, 1, 3, 1, 1] },
  { step: 6, seconds: 0, kind: 4, points: [9, 9, 9, 8, 8, 8] },
];
const ORIGINS = [
  { file: 1, line: 5 },
  { file: 0, line: 9, caller: 0 },
];

/** What the motions are, whatever the blocks. */
function plain(path: Path) {
  return Array.from({ length: path.motions }, (_, m) => ({
    step: path.step[m],
    tool: path.tool[m],
    kind: path.kind[m],
    seconds: path.seconds[m],
    feed: path.feed[m],
    flow: path.flow?.[m] ?? 0,
    power: path.power?.[m] ?? 0,
    bead: path.bead?.[m] ?? 0,
    chain: path.chain(m),
    points: [...path.points.subarray(3 * path.firstPoint(m), 3 * path.endPoint[m]!)],
  }));
}

test.each([1, 2, 4])('fields of motions and origins in blocks of %d', (block) => {
  const bytes = encodePath(9, MOTIONS, ORIGINS, { block, flow: [0, 2.5, 0, 0], bead: [0, 0, 0, 7] });
  const path = decodePath(bytes);
  expect(path.revision).toBe(9);
  expect(path.power).toBeNull();
  const called = [
    { file: 0, line: 9 },
    { file: 1, line: 5 },
  ];
  const none = { flow: 0, power: 0, bead: 0 };
  expect(plain(path)).toEqual([
    {
      ...none, step: 1, tool: 3, kind: 0, seconds: 0.5, feed: 0,
      chain: called.slice(1), points: [0, 0, 1, 2, 0, 1],
    },
    { ...none, step: 4, tool: -1, kind: 1, seconds: 2, feed: 300, chain: called, points: [], flow: 2.5 },
    {
      ...none, step: 5, tool: 70_000, kind: 1, seconds: 1, feed: 300,
      chain: called, points: [2, 0, 1, 3, 0, 1, 3, 1, 1],
    },
    {
      ...none, step: 6, tool: -1, kind: 4, seconds: 0, feed: 0,
      chain: [], points: [9, 9, 9, 8, 8, 8], bead: 7,
    },
  ]);
  expect([...path.motionsOf({ file: 0, line: 9 })]).toEqual([1, 2]);
  expect([...path.motionsOf({ file: 1, line: 5 })]).toEqual([0, 1, 2]);
});

test('motions of a drawing, whose origins have no line, lead to no line', () => {
  const path = decodePath(encodePath(1, MOTIONS, [{ file: 0, line: 0 }, { file: 0, line: 0 }]));
  expect([0, 1, 2, 3].map((m) => path.chain(m))).toEqual([[], [], [], []]);
});

test('the point between two motions is there once, and each point has one motion', () => {
  const path = decodePath(encodePath(1, MOTIONS, ORIGINS));
  expect(path.points.length).toBe(3 * 6);
  expect(Array.from({ length: 6 }, (_, p) => path.motionOfPoint(p))).toEqual([0, 0, 2, 2, 3, 3]);
});

describe('damaged answers', () => {
  test('every shortened answer is refused', () => {
    const whole = encodePath(1, MOTIONS, ORIGINS, { block: 2 });
    for (let size = 0; size < whole.byteLength; ++size)
      expect(() => decodePath(whole.slice(0, size)), `${size} bytes`).toThrow(DecodeError);
  });

  test('wrong references and orders', () => {
    const wrong =
      (motions: RawMotion[], origins = ORIGINS) =>
      () =>
        decodePath(encodePath(1, motions, origins, { block: 1 }));
    expect(wrong([{ ...MOTIONS[0]!, origin: 7 }])).toThrow(/unknown origin/);
    expect(wrong([MOTIONS[1]!, MOTIONS[0]!])).toThrow(/not in order/);
    expect(wrong([{ ...MOTIONS[0]!, seconds: NaN }])).toThrow(/valid time/);
    expect(wrong([{ ...MOTIONS[0]!, seconds: -1 }])).toThrow(/valid time/);
    expect(wrong(MOTIONS, [ORIGINS[0]!, { file: 0, line: 1, caller: 1 }])).toThrow(/unknown caller/);
    expect(wrong([{ ...MOTIONS[0]!, points: [0, 0, Infinity] }])).toThrow(/not finite/);
  });

  test('counts of the table', () => {
    for (const at of [12, 16, 20, 24, 36, 40, 48, 56]) {
      const bytes = encodePath(1, MOTIONS, ORIGINS, { block: 2 });
      const view = new DataView(bytes);
      view.setUint32(at, view.getUint32(at, true) + 1, true);
      expect(() => decodePath(bytes), `at ${at}`).toThrow(DecodeError);
    }
  });
});

describe('blocks of the path before', () => {
  test('are taken with their new steps, lines and points', () => {
    const before = decodePath(encodePath(1, MOTIONS, ORIGINS, { block: 2 }));
    const moved = MOTIONS.map((m) => ({ ...m, step: m.step + 3 }));
    const lower = ORIGINS.map((o) => ({ ...o, line: o.line + 10 }));
    const options = { block: 2, id: 0 };
    const all: RawMotion[] = [
      { step: 0, points: [] },
      { step: 2, points: [5, 5, 5, 6, 6, 6] },
      ...moved,
    ];
    // Blocks 1 and 2 of before are those after the new first one.
    const after = decodePath(encodePath(2, all, lower, { ...options, has: [1, 2] }), before);
    expect(plain(after)).toEqual(plain(decodePath(encodePath(2, all, lower, options))));
  });

  test('that the page does not have', () => {
    const bytes = encodePath(2, MOTIONS, ORIGINS, { block: 2, has: [1] });
    expect(() => decodePath(bytes)).toThrow(MissingBlock);
    const other = decodePath(encodePath(1, MOTIONS, ORIGINS, { block: 1, id: 7 }));
    expect(() => decodePath(bytes, other)).toThrow(MissingBlock);
    const longer = decodePath(encodePath(1, MOTIONS, ORIGINS));
    expect(() => decodePath(bytes, longer)).toThrow(DecodeError);
  });

  test('of beads, where other blocks have none', () => {
    const flow = [0, 2.5, 0, 0];
    const power = [0, 0, 0, 300];
    const bead = [0, 0, 3, 0];
    const before = decodePath(encodePath(1, MOTIONS, ORIGINS, { block: 1, flow, power, bead }));
    const kept = encodePath(2, MOTIONS.slice(2), ORIGINS, { block: 1, id: 3, has: [3, 4] });
    const after = decodePath(kept, before);
    expect(after.flow).toBeNull();
    expect([...after.power!]).toEqual([0, 300]);
    expect([...after.bead!]).toEqual([3, 0]);
  });
});
