// What the comparison of two parts finds: blocks with slots along X, given by their material over strips of
// Y. The expected depths and volumes are those of the slots as they are drawn.
import { describe, expect, it } from 'vitest';
import { type Change, changeAt, changeBetween, changeNear } from '../../src/change';
import type { Tile } from '../../src/decode';
import type { Vec3 } from '../../src/protocol';

const CELL = 0.25; // mm
const BOUNDS: [Vec3, Vec3] = [
  [0, 0, -10],
  [20, 20, 0],
];
const UP: Vec3 = [0, 0, 1];
const DOWN: Vec3 = [0, 0, -1];
const TO_BACK: Vec3 = [0, 1, 0]; // of a wall: outward along +Y

type Interval = [number, number];
interface Strip {
  to: number; // Y, mm
  material: Interval[];
}

/** The upper and lower faces of strips of material; walls are not needed for the comparison. */
function tileOf(strips: Strip[], id = 0, [x0, x1] = [0, 20]): Tile {
  const positions: number[] = [];
  const index: number[] = [];
  let from = 0;
  for (const { to, material } of strips) {
    for (const [low, high] of material)
      for (const [z, up] of [[low, false], [high, true]] as const) {
        const n = positions.length / 3;
        positions.push(x0!, from, z, x1!, from, z, x1!, to, z, x0!, to, z);
        const corners = up ? [0, 1, 2, 0, 2, 3] : [0, 2, 1, 0, 3, 2];
        index.push(...corners.map((corner) => n + corner));
      }
    from = to;
  }
  return {
    id,
    level: 0,
    positions: new Float32Array(positions),
    index: new Uint32Array(index),
    step: new Uint32Array(index.length / 3),
  };
}

/** A block with a keyhole slot: a neck of 4 mm above a head, both symmetric about Y10. */
function keyhole({ width = 10, floor = -6, roof = -4, bottom = -10, pocket = 0 } = {}): Tile {
  const [low, high] = [10 - width / 2, 10 + width / 2];
  const head: Interval[] = [
    [bottom, floor],
    [roof, 0],
  ];
  return tileOf([
    { to: 2, material: [[bottom, pocket]] },
    { to: low, material: [[bottom, 0]] },
    { to: 8, material: head },
    { to: 12, material: [[bottom, floor]] },
    { to: high, material: head },
    { to: 20, material: [[bottom, 0]] },
  ]);
}

function change(before: Tile, after: Tile): Change {
  return changeBetween(new Map([[0, before]]), new Map([[0, after]]), BOUNDS, CELL);
}

/** As seen on a face, at X10. */
const on = (made: Change, y: number, z: number, outward: Vec3) => changeAt(made, [10, y, z], outward);

describe('the change of a keyhole slot', () => {
  it('is nothing where the tile was made again with the same slot', () => {
    const made = change(keyhole(), keyhole());
    expect([made.highest, made.more, made.less]).toEqual([0, 0, 0]);
    expect(on(made, 6, -4, DOWN)).toBe(0);
    expect(on(made, 6, -6, UP)).toBe(0);
  });

  it('of its depth is on the whole floor, also below the roofs', () => {
    const made = change(keyhole(), keyhole({ floor: -7 }));
    expect(made.more).toBeCloseTo(10 * 20 * 1, 3);
    expect(made.less).toBe(0);
    for (const y of [6, 10, 14]) expect(on(made, y, -7, UP)).toBeCloseTo(-1, 5);
    expect(on(made, 6, -4, DOWN)).toBe(0); // the roof is as before
    expect(on(made, 5, -6.5, TO_BACK)).toBeCloseTo(-1, 5); // the wall has become higher
    expect(on(made, 5, -5, TO_BACK)).toBe(0);
    expect(on(made, 4, 0, UP)).toBe(0);
    // As read at a point of the picture, of which the normal is not known.
    expect(changeNear(made, [10, 6, -7])).toBeCloseTo(-1, 5);
    expect(changeNear(made, [10, 6, -4])).toBe(0);
  });

  it('of its width is on the walls, the roofs and the floor beyond the old walls', () => {
    const made = change(keyhole(), keyhole({ width: 12 }));
    expect(made.more).toBeCloseTo(2 * 1 * 20 * 2, 3);
    expect(made.highest).toBeCloseTo(2, 5);
    expect(on(made, 4, -5, TO_BACK)).toBeCloseTo(-2, 5);
    expect(on(made, 4.5, -4, DOWN)).toBeCloseTo(-2, 5);
    expect(on(made, 4.5, -6, UP)).toBeCloseTo(-2, 5);
    expect(on(made, 6, -4, DOWN)).toBe(0);
    expect(on(made, 6, -6, UP)).toBe(0);
    expect(on(made, 8, -2, TO_BACK)).toBe(0); // the wall of the neck
    expect(on(made, 4.5, 0, UP)).toBe(0); // the top above
  });

  it('of its roof is on the roof and on the walls below it', () => {
    const made = change(keyhole(), keyhole({ roof: -3 }));
    expect(made.more).toBeCloseTo(2 * 3 * 20 * 1, 3);
    expect(on(made, 6, -3, DOWN)).toBeCloseTo(-1, 5);
    expect(on(made, 5, -3.5, TO_BACK)).toBeCloseTo(-1, 5);
    expect(on(made, 5, -5, TO_BACK)).toBe(0);
    expect(on(made, 6, -6, UP)).toBe(0);
  });

  it('counts material that is removed less on the surface that it has now', () => {
    const made = change(keyhole({ width: 12, floor: -7 }), keyhole());
    expect(made.more).toBe(0);
    expect(made.less).toBeCloseTo(10 * 20 * 1 + 2 * 1 * 20 * 3, 3);
    expect(on(made, 6, -6, UP)).toBeCloseTo(1, 5);
    expect(on(made, 5, -5, TO_BACK)).toBeCloseTo(3, 5);
    expect(on(made, 6, -4, DOWN)).toBe(0);
  });

  it('counts removed and restored material of one column apart', () => {
    const made = change(keyhole(), keyhole({ floor: -5.5, roof: -3 }));
    expect(made.more).toBeCloseTo(2 * 3 * 20 * 1, 3);
    expect(made.less).toBeCloseTo(10 * 20 * 0.5, 3);
    expect(on(made, 6, -3, DOWN)).toBeCloseTo(-1, 5);
    expect(on(made, 6, -5.5, UP)).toBeCloseTo(0.5, 5);
  });
});

describe('the change beside an unchanged undercut', () => {
  it('shows nothing on the undercut', () => {
    const made = change(keyhole(), keyhole({ pocket: -1 }));
    expect(made.more).toBeCloseTo(2 * 20 * 1, 3);
    expect(on(made, 1, -1, UP)).toBeCloseTo(-1, 5);
    for (const [z, outward] of [[-4, DOWN], [-6, UP], [0, UP]] as const)
      expect(on(made, 6, z, outward)).toBe(0);
  });

  it('of the lower side is seen there, not on the slot above', () => {
    const made = change(keyhole(), keyhole({ bottom: -9 }));
    expect(made.more).toBeCloseTo(20 * 20 * 1, 3);
    expect(on(made, 6, -9, DOWN)).toBeCloseTo(-1, 5);
    expect(on(made, 6, -6, UP)).toBe(0);
    expect(on(made, 6, -4, DOWN)).toBe(0);
  });
});

describe('a change seen from above', () => {
  const block = (material: Interval[]) => tileOf([{ to: 20, material }]);

  it('of a hole through the block has the depth of the block', () => {
    const half = tileOf([{ to: 10, material: [] }, { to: 20, material: [[-10, 0]] }]);
    const made = change(block([[-10, 0]]), half);
    expect(made.highest).toBeCloseTo(10, 5);
    expect(made.more).toBeCloseTo(10 * 20 * 10, 3);
    expect(on(made, 10, -5, [0, -1, 0])).toBeCloseTo(-10, 5);
  });

  it('on a slope is seen although the columns are beside the point', () => {
    const slope = (drop: number): Tile => {
      const tile = tileOf([{ to: 20, material: [[-10, 0]] }]);
      for (let v = 0; v < tile.positions.length / 3; ++v)
        if (tile.positions[3 * v + 2]! > -10)
          tile.positions[3 * v + 2] = -drop - tile.positions[3 * v + 1]! / 4;
      return tile;
    };
    const made = change(slope(0), slope(0.1));
    const outward: Vec3 = [0, 0.25 / Math.hypot(1, 0.25), 1 / Math.hypot(1, 0.25)];
    for (const y of [3, 3.06, 3.12, 3.2])
      expect(on(made, y, -0.1 - y / 4, outward)).toBeCloseTo(-0.1, 4);
    expect(changeAt(change(slope(0.1), slope(0.1)), [10, 3, -0.85], outward)).toBe(0);
  });

  it('is found in tiles that were added or removed', () => {
    const left = tileOf([{ to: 20, material: [[-10, 0]] }], 0, [0, 10]);
    const right = tileOf([{ to: 20, material: [[-10, 0]] }], 1, [10, 20]);
    const both = new Map([[0, left], [1, right]]);
    expect(changeBetween(both, new Map([[0, left]]), BOUNDS, CELL).more).toBeCloseTo(10 * 20 * 10, 3);
    expect(changeBetween(both, new Map(both), BOUNDS, CELL).highest).toBe(0);
  });
});
