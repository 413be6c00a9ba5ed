// What has changed between two states of a part: the difference of their heights on square columns, seen from
// above.
import type { TargetAnswer, Tile } from '../decode';
import type { Vec3 } from '../protocol';

const MAX_COLUMNS = 2_000_000;
const SMALLEST = 0.002; // mm; less is no change

export interface Change {
  /** Above 0 the part is higher than before, below 0 more is removed. */
  map: TargetAnswer;
  /** mm: the largest difference. */
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
  const old = heights(changed, before, map);
  const now = heights(changed, after, map);
  const change: Change = { map, highest: 0, more: 0, less: 0 };
  for (let k = 0; k < map.depth.length; ++k) {
    if (Number.isNaN(old[k]!) && Number.isNaN(now[k]!)) continue;
    // Where there is no surface the part is cut through, down to its underside.
    const d = (Number.isNaN(now[k]!) ? low[2] : now[k]!) - (Number.isNaN(old[k]!) ? low[2] : old[k]!);
    if (Math.abs(d) < SMALLEST) continue;
    map.depth[k] = d;
    change.highest = Math.max(change.highest, Math.abs(d));
    if (d < 0) change.more -= d * pitch * pitch;
    else change.less += d * pitch * pitch;
  }
  return change;
}

/** The highest surface at the centre of each column; NaN where there is none. */
function heights(ids: readonly number[], tiles: Tiles, map: TargetAnswer): Float32Array {
  const out = new Float32Array(map.nx * map.ny).fill(NaN);
  for (const id of ids) {
    const tile = tiles.get(id);
    if (tile) addHeights(tile, map, out);
  }
  return out;
}

function addHeights({ positions, index, step }: Tile, map: TargetAnswer, out: Float32Array): void {
  const { nx, ny, x, y, pitch } = map;
  for (let t = 0; t < step.length; ++t) {
    const [a, b, c] = [3 * index[3 * t]!, 3 * index[3 * t + 1]!, 3 * index[3 * t + 2]!] as const;
    // In columns: the centre of column i is at i.
    const u = (p: number) => (positions[p]! - x) / pitch - 0.5;
    const v = (p: number) => (positions[p + 1]! - y) / pitch - 0.5;
    const [au, av, bu, bv, cu, cv] = [u(a), v(a), u(b), v(b), u(c), v(c)] as const;
    const area = (bu - au) * (cv - av) - (bv - av) * (cu - au);
    if (!(area > 1e-9)) continue; // walls, and what faces down
    const lastRow = Math.min(Math.floor(Math.max(av, bv, cv)), ny - 1);
    const lastColumn = Math.min(Math.floor(Math.max(au, bu, cu)), nx - 1);
    for (let j = Math.max(Math.ceil(Math.min(av, bv, cv)), 0); j <= lastRow; ++j) {
      for (let i = Math.max(Math.ceil(Math.min(au, bu, cu)), 0); i <= lastColumn; ++i) {
        const wb = ((i - au) * (cv - av) - (j - av) * (cu - au)) / area;
        const wc = ((bu - au) * (j - av) - (bv - av) * (i - au)) / area;
        if (wb < -1e-6 || wc < -1e-6 || wb + wc > 1 + 1e-6) continue;
        const z = positions[a + 2]! * (1 - wb - wc) + positions[b + 2]! * wb + positions[c + 2]! * wc;
        const k = j * nx + i;
        if (!(out[k]! >= z)) out[k] = z;
      }
    }
  }
}
