// Coarser surfaces and lines, for pictures that are drawn without a graphics processor.
import type { Surface } from '../decode';

const NONE = 0xffffffff;
const SIDES = [0, 1] as const; // x and y: tiles are cut apart along planes across them

/** A table of cells of space, each with a value. */
class Cells {
  readonly value: Uint32Array;
  private readonly keys: Int32Array;
  private readonly mask: number;

  /** `count`: of different cells at most. */
  constructor(count: number) {
    let size = 16;
    while (size < 2 * count) size *= 2;
    this.mask = size - 1;
    this.keys = new Int32Array(4 * size);
    this.value = new Uint32Array(size).fill(NONE);
  }

  /** Where the value of a cell is; it is NONE for a new cell, and has to be set then. */
  slot(x: number, y: number, z: number, kind: number): number {
    const { keys, value, mask } = this;
    const mixed =
      Math.imul(x, 0x9e3779b1) ^
      Math.imul(y, 0x85ebca77) ^
      Math.imul(z, 0xc2b2ae3d) ^
      Math.imul(kind, 0x27d4eb2f);
    for (let at = (mixed ^ (mixed >>> 15)) & mask; ; at = (at + 1) & mask) {
      const k = 4 * at;
      if (value[at] === NONE) {
        keys[k] = x;
        keys[k + 1] = y;
        keys[k + 2] = z;
        keys[k + 3] = kind;
        return at;
      }
      if (keys[k] === x && keys[k + 1] === y && keys[k + 2] === z && keys[k + 3] === kind) return at;
    }
  }
}

/**
 * The surface with the vertices of each cell of space joined at their mean position. Vertices on the sides of
 * the box around it are joined among themselves, so that neighbouring tiles stay together.
 */
export function coarser(surface: Surface, cell: number): Surface {
  const { positions, index, step } = surface;
  const joined = joinVertices(positions, cell);
  const kept: number[] = [];
  const keptSteps: number[] = [];
  for (let t = 0; t < step.length; ++t) {
    const a = joined.of[index[3 * t]!]!;
    const b = joined.of[index[3 * t + 1]!]!;
    const c = joined.of[index[3 * t + 2]!]!;
    if (a === b || b === c || c === a) continue;
    kept.push(a, b, c);
    keptSteps.push(step[t]!);
  }
  return {
    positions: joined.positions,
    index: Uint32Array.from(kept),
    step: Uint32Array.from(keptSteps),
  };
}

function joinVertices(positions: Float32Array, cell: number): { of: Uint32Array; positions: Float32Array } {
  const vertices = positions.length / 3;
  const cells = new Cells(vertices);
  const of = new Uint32Array(vertices);
  const sums = new Float64Array(positions.length);
  const counts = new Uint32Array(vertices);
  const low = SIDES.map((k) => extreme(positions, k, Math.min));
  const high = SIDES.map((k) => extreme(positions, k, Math.max));
  let count = 0;
  for (let v = 0; v < vertices; ++v) {
    const x = positions[3 * v]!;
    const y = positions[3 * v + 1]!;
    const z = positions[3 * v + 2]!;
    const side =
      (x === low[0] ? 1 : 0) | (x === high[0] ? 2 : 0) | (y === low[1] ? 4 : 0) | (y === high[1] ? 8 : 0);
    const slot = cells.slot(Math.floor(x / cell), Math.floor(y / cell), Math.floor(z / cell), side);
    if (cells.value[slot] === NONE) cells.value[slot] = count++;
    const to = cells.value[slot]!;
    of[v] = to;
    sums[3 * to] = sums[3 * to]! + x;
    sums[3 * to + 1] = sums[3 * to + 1]! + y;
    sums[3 * to + 2] = sums[3 * to + 2]! + z;
    counts[to] = counts[to]! + 1;
  }
  const mean = new Float32Array(3 * count);
  for (let i = 0; i < mean.length; ++i) mean[i] = sums[i]! / counts[Math.floor(i / 3)]!;
  return { of, positions: mean };
}

function extreme(positions: Float32Array, axis: number, choose: (a: number, b: number) => number): number {
  let found = positions[axis] ?? 0;
  for (let i = axis; i < positions.length; i += 3) found = choose(found, positions[i]!);
  return found;
}

/**
 * Pairs of points that show about the same as `pairs`: consecutive segments become one of at least the length
 * of a cell, and one that ends in a cell where an earlier one ended is left out, unless that was the one
 * before. The pairs stay in order.
 */
export function coarserLines(points: Float32Array, pairs: Uint32Array, cell: number): Uint32Array {
  const cells = new Cells(pairs.length / 2);
  const kept: number[] = [];
  for (let i = 0; i < pairs.length;) {
    const first = pairs[i]!;
    let last = pairs[i + 1]!;
    i += 2;
    while (distance(points, first, last) < cell && i < pairs.length && isNext(points, last, pairs[i]!)) {
      last = pairs[i + 1]!;
      i += 2;
    }
    const along = (k: number) => Math.floor(points[3 * last + k]! / cell);
    const slot = cells.slot(along(0), along(1), along(2), 0);
    const before = cells.value[slot]!;
    if (before !== NONE && before !== kept.length) continue;
    kept.push(first, last);
    cells.value[slot] = kept.length;
  }
  return Uint32Array.from(kept);
}

function distance(points: Float32Array, a: number, b: number): number {
  return Math.hypot(
    points[3 * a]! - points[3 * b]!,
    points[3 * a + 1]! - points[3 * b + 1]!,
    points[3 * a + 2]! - points[3 * b + 2]!,
  );
}

/** Whether a segment that starts at point `b` continues one that ends at point `a`. */
function isNext(points: Float32Array, a: number, b: number): boolean {
  return a === b || distance(points, a, b) === 0;
}
