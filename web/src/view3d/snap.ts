// Exact positions near a point of a surface: corners and edges of its mesh, and circles through points.
// An edge is where two neighbouring triangles meet at an angle.
import type { Surface } from '../decode';
import type { Vec3 } from '../protocol';

const SHARP = Math.cos((20 * Math.PI) / 180); // of the normals of two triangles
export const STRAIGHT = Math.cos((20 * Math.PI) / 180); // of two edges that continue each other
const GRAIN = 1e-4; // mm: corners of triangles that are closer are the same
const SMALLEST = 1e-9;

export interface Snapped {
  point: Vec3;
  what: 'corner' | 'edge';
}

export interface Edge {
  a: Vec3;
  b: Vec3;
  /** Keys of its ends. */
  ends: [string, string];
  normals: Vec3[];
}

/**
 * The nearest corner within `reach` mm of a point, else the nearest point of an edge; null: there is neither.
 */
export function snap(surfaces: Iterable<Surface>, at: Vec3, reach: number): Snapped | null {
  const edges = sharpEdges(surfaces, at, reach);
  let best: { point: Vec3; away: number } | null = null;
  for (const corner of corners(edges)) {
    const away = distance(corner, at);
    if (away <= reach && !(best && best.away <= away)) best = { point: corner, away };
  }
  if (best) return { point: best.point, what: 'corner' };
  for (const { a, b } of edges) {
    const point = nearestOn(a, b, at);
    const away = distance(point, at);
    if (away <= reach && !(best && best.away <= away)) best = { point, away };
  }
  return best ? { point: best.point, what: 'edge' } : null;
}

export interface Circle {
  centre: Vec3;
  radius: number;
  /** Of its plane, length 1. */
  normal: Vec3;
}

/** The circle through three points; null: they lie on a line. */
export function circleThrough(a: Vec3, b: Vec3, c: Vec3): Circle | null {
  const u = minus(b, a);
  const v = minus(c, a);
  const n = cross(u, v);
  const nn = dot(n, n);
  // The height of the triangle over its longest side, against that side.
  if (nn <= (1e-4 * Math.max(dot(u, u), dot(v, v))) ** 2 || nn === 0) return null;
  const to = scaled(
    plus(scaled(cross(v, n), dot(u, u)), scaled(cross(n, u), dot(v, v))),
    1 / (2 * nn),
  );
  return { centre: plus(a, to), radius: Math.hypot(...to), normal: scaled(n, 1 / Math.sqrt(nn)) };
}

/** The edges of the triangles near a point. */
export function sharpEdges(surfaces: Iterable<Surface>, at: Vec3, reach: number): Edge[] {
  const all = new Map<string, Edge>();
  for (const surface of surfaces) addNear(surface, at, reach, all);
  return [...all.values()].filter(
    ({ normals }) => normals.length === 2 && dot(normals[0]!, normals[1]!) < SHARP,
  );
}

function addNear({ positions, index, step }: Surface, at: Vec3, reach: number, all: Map<string, Edge>): void {
  const read = (i: number): Vec3 => [positions[3 * i]!, positions[3 * i + 1]!, positions[3 * i + 2]!];
  for (let t = 0; t < step.length; ++t) {
    const corners = [index[3 * t]!, index[3 * t + 1]!, index[3 * t + 2]!] as const;
    let isNear = true;
    for (let axis = 0; axis < 3 && isNear; ++axis) {
      const [p, q, r] = corners.map((i) => positions[3 * i + axis]! - at[axis]!) as Vec3;
      isNear = Math.min(p, q, r) <= reach && Math.max(p, q, r) >= -reach;
    }
    if (!isNear) continue;
    const [a, b, c] = corners.map(read) as [Vec3, Vec3, Vec3];
    const n = cross(minus(b, a), minus(c, a));
    const size = Math.hypot(...n);
    if (size < SMALLEST) continue;
    const normal = scaled(n, 1 / size);
    for (const [p, q] of [[a, b], [b, c], [c, a]] as const) {
      const ends: [string, string] = [keyOf(p), keyOf(q)];
      if (ends[0] === ends[1]) continue;
      const key = ends[0] < ends[1] ? ends.join() : `${ends[1]},${ends[0]}`;
      const known = all.get(key);
      if (known) known.normals.push(normal);
      else all.set(key, { a: p, b: q, ends, normals: [normal] });
    }
  }
}

/** The ends of edges that no other edge continues. */
function corners(edges: readonly Edge[]): Vec3[] {
  const at = new Map<string, { point: Vec3; away: Vec3[] }>();
  for (const { a, b, ends } of edges) {
    for (const [key, point, other] of [[ends[0], a, b], [ends[1], b, a]] as const) {
      const joint = at.get(key) ?? { point, away: [] };
      const d = minus(other, point);
      joint.away.push(scaled(d, 1 / Math.max(Math.hypot(...d), SMALLEST)));
      at.set(key, joint);
    }
  }
  const isCorner = (away: Vec3[]) =>
    away.length > 2 || (away.length === 2 && -dot(away[0]!, away[1]!) < STRAIGHT);
  return [...at.values()].filter(({ away }) => isCorner(away)).map(({ point }) => point);
}

function keyOf(p: Vec3): string {
  return p.map((v) => Math.round(v / GRAIN)).join();
}

export function nearestOn(a: Vec3, b: Vec3, p: Vec3): Vec3 {
  const d = minus(b, a);
  const squared = dot(d, d);
  const t = squared > 0 ? Math.min(Math.max(dot(minus(p, a), d) / squared, 0), 1) : 0;
  return plus(a, scaled(d, t));
}

export function distance(a: Vec3, b: Vec3): number {
  return Math.hypot(...minus(a, b));
}
export function plus(a: Vec3, b: Vec3): Vec3 {
  return [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
}
export function minus(a: Vec3, b: Vec3): Vec3 {
  return [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
}
export function scaled(a: Vec3, by: number): Vec3 {
  return [a[0] * by, a[1] * by, a[2] * by];
}
export function dot(a: Vec3, b: Vec3): number {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
function cross(a: Vec3, b: Vec3): Vec3 {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}
