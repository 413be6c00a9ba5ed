// What has changed between two states of a part: the difference of their material on square columns. All
// intervals of a column are compared, so that undercuts count as well as what is seen from above.
import type { TargetAnswer, Tile } from './decode';
import type { Vec3 } from './protocol';

const MAX_COLUMNS = 2_000_000;
export const SMALLEST = 0.002; // mm; less is no change
const ON_EDGE = 1e-6; // of a triangle, in its barycentric coordinates

/** Changed spans of a column that are kept: the longest ones, as the shader examines all of them. */
export const MAX_SPANS = 4;

export interface Change {
  /** Of each column the longest changed span: above 0 removed less than before, below 0 more. */
  map: TargetAnswer;
  /**
   * `spans` layers of pairs of heights, mm, one pair for each column: from the first to the second material
   * is gone; where the first is the higher one, it is there again. Two equal heights: no span.
   */
  heights: Float32Array;
  spans: number;
  /** mm: the longest span. */
  highest: number;
  /** mm3 that are removed more, and less, than before. */
  more: number;
  less: number;
}

type Tiles = ReadonlyMap<number, Tile>;

/** `cell`: mm between the columns of the part. */
export function changeBetween(
  before: Tiles,
  after: Tiles,
  [low, high]: readonly [Vec3, Vec3],
  cell: number,
): Change {
  const area = (high[0] - low[0]) * (high[1] - low[1]);
  const pitch = Math.max(cell, Math.sqrt(area / MAX_COLUMNS), 1e-6);
  const nx = Math.max(Math.ceil((high[0] - low[0]) / pitch - 1e-6), 1);
  const ny = Math.max(Math.ceil((high[1] - low[1]) / pitch - 1e-6), 1);
  const map: TargetAnswer = {
    revision: 0,
    nx,
    ny,
    x: low[0],
    y: low[1],
    pitch,
    depth: new Float32Array(nx * ny),
  };
  const changed = [...new Set([...before.keys(), ...after.keys()])].filter(
    (id) => before.get(id) !== after.get(id),
  );
  const old = materialOf(changed, before, map);
  const now = materialOf(changed, after, map);
  return compared(old, now, map);
}

/** The ends of the material on each column: those of column k are first[k] to first[k + 1] - 1. */
interface Material {
  first: Uint32Array;
  z: Float32Array;
  /** 1 where the surface faces up, so that material ends there. */
  up: Uint8Array;
}

function materialOf(ids: readonly number[], tiles: Tiles, map: TargetAnswer): Material {
  const shown = ids.map((id) => tiles.get(id)).filter((tile) => tile !== undefined);
  const first = new Uint32Array(map.nx * map.ny + 1);
  for (const tile of shown) crossings(tile, map, (k) => ++first[k + 1]!);
  for (let k = 1; k < first.length; ++k) first[k]! += first[k - 1]!;
  const next = first.slice(0, -1);
  const count = first[first.length - 1]!;
  const out: Material = { first, z: new Float32Array(count), up: new Uint8Array(count) };
  for (const tile of shown)
    crossings(tile, map, (k, z, up) => {
      const at = next[k]!++;
      out.z[at] = z;
      out.up[at] = up ? 1 : 0;
    });
  return out;
}

/** Calls `visit` where the line through the centre of a column meets a triangle. */
function crossings(
  { positions, index, step }: Tile,
  map: TargetAnswer,
  visit: (column: number, z: number, up: boolean) => void,
): void {
  const { nx, ny, x, y, pitch } = map;
  // In columns: the centre of column i is at i.
  const u = (p: number) => (positions[p]! - x) / pitch - 0.5;
  const v = (p: number) => (positions[p + 1]! - y) / pitch - 0.5;
  for (let t = 0; t < step.length; ++t) {
    const [a, b, c] = [3 * index[3 * t]!, 3 * index[3 * t + 1]!, 3 * index[3 * t + 2]!] as const;
    const [au, av, bu, bv, cu, cv] = [u(a), v(a), u(b), v(b), u(c), v(c)] as const;
    const area = (bu - au) * (cv - av) - (bv - av) * (cu - au);
    if (!(Math.abs(area) > 1e-9)) continue; // walls
    const lastRow = Math.min(Math.floor(Math.max(av, bv, cv)), ny - 1);
    const lastColumn = Math.min(Math.floor(Math.max(au, bu, cu)), nx - 1);
    for (let j = Math.max(Math.ceil(Math.min(av, bv, cv)), 0); j <= lastRow; ++j) {
      for (let i = Math.max(Math.ceil(Math.min(au, bu, cu)), 0); i <= lastColumn; ++i) {
        const wb = ((i - au) * (cv - av) - (j - av) * (cu - au)) / area;
        const wc = ((bu - au) * (j - av) - (bv - av) * (i - au)) / area;
        if (wb < -ON_EDGE || wc < -ON_EDGE || wb + wc > 1 + ON_EDGE) continue;
        const z = positions[a + 2]! * (1 - wb - wc) + positions[b + 2]! * wb + positions[c + 2]! * wc;
        visit(j * nx + i, z, area > 0);
      }
    }
  }
}

/**
 * The intervals of a column as pairs of heights, lowest first. A line through an edge meets two triangles at
 * the same height: of surfaces that face the same way one after the other the outermost counts.
 */
function intervalsOf({ first, z, up }: Material, column: number): number[] {
  const ends: { z: number; up: number }[] = [];
  for (let k = first[column]!; k < first[column + 1]!; ++k) ends.push({ z: z[k]!, up: up[k]! });
  ends.sort((p, q) => p.z - q.z || p.up - q.up);
  const out: number[] = [];
  for (const end of ends) {
    const isInside = out.length % 2 === 1;
    if (!end.up && !isInside) out.push(end.z);
    else if (end.up && isInside) out.push(end.z);
    else if (end.up && out.length > 0) out[out.length - 1] = end.z;
  }
  if (out.length % 2 === 1) out.pop();
  return out;
}

/** Whether there is material at a height. */
function holds(intervals: readonly number[], z: number): boolean {
  for (let k = 0; k + 1 < intervals.length; k += 2)
    if (z > intervals[k]! && z < intervals[k + 1]!) return true;
  return false;
}

/** What one of two lists has and the other has not: [from, to], or [to, from] where `now` has it. */
function spansBetween(old: readonly number[], now: readonly number[]): [number, number][] {
  const at = [...old, ...now].sort((p, q) => p - q);
  const spans: [number, number][] = [];
  for (let k = 0; k + 1 < at.length; ++k) {
    const [low, high] = [at[k]!, at[k + 1]!];
    if (high === low) continue;
    const was = holds(old, 0.5 * (low + high));
    const is = holds(now, 0.5 * (low + high));
    if (was === is) continue;
    const last = spans[spans.length - 1];
    if (was && last && last[0] < last[1] && last[1] === low) last[1] = high;
    else if (is && last && last[0] > last[1] && last[0] === low) last[0] = high;
    else spans.push(was ? [low, high] : [high, low]);
  }
  const length = ([p, q]: readonly [number, number]) => Math.abs(q - p);
  return spans.filter((span) => length(span) >= SMALLEST).sort((p, q) => length(q) - length(p));
}

function compared(old: Material, now: Material, map: TargetAnswer): Change {
  const found: { column: number; spans: [number, number][] }[] = [];
  const change: Change = { map, heights: new Float32Array(), spans: 0, highest: 0, more: 0, less: 0 };
  const { depth, pitch } = map;
  for (let column = 0; column < depth.length; ++column) {
    const has = (m: Material) => m.first[column]! < m.first[column + 1]!;
    if (!has(old) && !has(now)) continue;
    const spans = spansBetween(intervalsOf(old, column), intervalsOf(now, column));
    if (spans.length === 0) continue;
    for (const [from, to] of spans) {
      if (from < to) change.more += (to - from) * pitch * pitch;
      else change.less += (from - to) * pitch * pitch;
    }
    const [from, to] = spans[0]!;
    depth[column] = from - to;
    change.highest = Math.max(change.highest, Math.abs(from - to));
    change.spans = Math.max(change.spans, Math.min(spans.length, MAX_SPANS));
    found.push({ column, spans });
  }
  change.heights = new Float32Array(2 * change.spans * depth.length);
  for (const { column, spans } of found)
    spans
      .slice(0, change.spans)
      .forEach((span, k) => change.heights.set(span, 2 * (k * depth.length + column)));
  return change;
}

/**
 * How much has changed at a point of the surface, mm, as in `Change.map`; 0 where the surface is as before.
 * `outward`: the normal.
 *
 * Where more is removed the surface bounds a span on its outside, where less is removed one on its inside.
 * Beside a wall the column next to it counts.
 */
export function changeAt(change: Change, point: Vec3, outward: Vec3): number {
  const { map, spans } = change;
  let found = 0;
  for (const side of [1, -1]) {
    const i = Math.floor((point[0] + side * BESIDE * map.pitch * outward[0] - map.x) / map.pitch);
    const j = Math.floor((point[1] + side * BESIDE * map.pitch * outward[1] - map.y) / map.pitch);
    if (i < 0 || j < 0 || i >= map.nx || j >= map.ny) continue;
    const near = nearness(outward, map.pitch);
    const z = point[2] + side * outward[2] * near;
    for (let k = 0; k < spans; ++k) {
      const at = 2 * ((k * map.ny + j) * map.nx + i);
      const [from, to] = [change.heights[at]!, change.heights[at + 1]!];
      const d = from - to;
      if (d * side >= 0 || Math.abs(d) <= Math.abs(found)) continue;
      if (z >= Math.min(from, to) - near && z <= Math.max(from, to) + near) found = d;
    }
  }
  return found;
}

/** The same for a point of which the normal is not known: the largest change of the surfaces there. */
export function changeNear(change: Change, [x, y, z]: Vec3): number {
  const sloped: Vec3[] = [
    [1, 0, 1],
    [1, 0, -1],
  ]; // as near in height as the columns of any slope may be
  const walls: Vec3[] = [
    [1, 0, 0],
    [-1, 0, 0],
    [0, 1, 0],
    [0, -1, 0],
  ];
  const level: Vec3[] = [
    [0, 0, 1],
    [0, 0, -1],
  ];
  for (const normals of [level, walls, sloped]) {
    const found = normals.map((outward) => changeAt(change, [x, y, z], outward));
    const largest = found.reduce((p, q) => (Math.abs(q) > Math.abs(p) ? q : p), 0);
    if (largest !== 0) return largest;
  }
  return 0;
}

/** Of the pitch: how far in front of a wall the column is that made it. */
export const BESIDE = 0.75;

/** mm within which a surface is at the end of a span: on a slope the end of the column is beside it. */
export function nearness(outward: Vec3, pitch: number): number {
  const slope = Math.hypot(outward[0], outward[1]) / Math.max(Math.abs(outward[2]), 1e-6);
  return SMALLEST + pitch * (slope < STEEP ? 1.5 * slope : AT_WALLS);
}

/** Steeper surfaces are walls. */
export const STEEP = 2;
export const AT_WALLS = 0.25; // of the pitch
