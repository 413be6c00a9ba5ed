// What an edge of the part belongs to: the line or the circle that neighbouring sharp edges make together.
import type { Surface } from '../decode';
import type { Vec3 } from '../protocol';
import {
  type Circle,
  circleThrough,
  distance,
  dot,
  type Edge,
  minus,
  nearestOn,
  plus,
  scaled,
  sharpEdges,
  STRAIGHT,
} from './snap';

const GROWTH = 4; // of the space that is searched, until the ends of the edge are in it
const MAX_EDGES = 20_000; // in that space; finding more would delay the picture
const FEWEST = 6; // lines of a circle or an arc
const ROUND_MM = 0.02; // a circle's points are this near to it, or
const ROUND = 0.01; // this near as a part of its radius

export interface Feature {
  kind: 'line' | 'arc' | 'circle' | 'hole' | 'edge';
  /** mm along the edge. */
  length: number;
  /** Of arcs, circles and holes. */
  circle: Circle | null;
}

/** Edges in order, each continuing the one before. */
interface Chain {
  points: Vec3[];
  edges: Edge[];
  isClosed: boolean;
}

/**
 * The line or circle of which `at`, a point of an edge, is one. `near` gives the surfaces near a point;
 * `reach` mm are searched first, `largest` at last. Null: there is no edge, or too many of them.
 */
export function featureAt(
  near: (at: Vec3, reach: number) => Iterable<Surface>,
  at: Vec3,
  reach: number,
  largest: number,
): Feature | null {
  for (let room = reach; ; room *= GROWTH) {
    const edges = sharpEdges(near(at, room), at, room);
    if (edges.length > MAX_EDGES) return null;
    const chain = chainAt(edges, at);
    if (!chain) return null;
    // All edges that meet inside the space are known.
    const isInside = (p: Vec3) => p.every((v, i) => Math.abs(v - at[i]!) < room);
    const ends = [chain.points[0]!, chain.points[chain.points.length - 1]!];
    if (chain.isClosed || ends.every(isInside) || room > largest) return featureOf(chain);
  }
}

function chainAt(edges: readonly Edge[], at: Vec3): Chain | null {
  let nearest: Edge | null = null;
  let least = Infinity;
  const byEnd = new Map<string, Edge[]>();
  for (const edge of edges) {
    const away = distance(nearestOn(edge.a, edge.b, at), at);
    if (away < least) [nearest, least] = [edge, away];
    for (const end of edge.ends) byEnd.set(end, [...(byEnd.get(end) ?? []), edge]);
  }
  if (!nearest) return null;
  const on = follow(nearest, 1, byEnd);
  if (on.isClosed) return on;
  const back = follow(nearest, 0, byEnd);
  return {
    points: [...back.points.slice(1).reverse(), ...on.points.slice(1)],
    edges: [...back.edges.slice(1).reverse(), ...on.edges],
    isClosed: false,
  };
}

/** From an edge over its end `to` until a corner, or back to its start. */
function follow(first: Edge, to: 0 | 1, byEnd: ReadonlyMap<string, Edge[]>): Chain {
  const start: Vec3 = to === 1 ? first.a : first.b;
  const chain: Chain = { points: [start, to === 1 ? first.b : first.a], edges: [first], isClosed: false };
  let key = first.ends[to];
  for (let last = first; ; ) {
    const others = byEnd.get(key)!.filter((edge) => edge !== last);
    const next = others[0];
    const n = chain.points.length;
    if (others.length !== 1 || !next) return chain;
    const isForward = next.ends[0] === key;
    const end = isForward ? next.b : next.a;
    const here = chain.points[n - 1]!;
    if (cosine(minus(here, chain.points[n - 2]!), minus(end, here)) < STRAIGHT) return chain;
    if (next === first) return { ...chain, isClosed: true };
    chain.points.push(end);
    chain.edges.push(next);
    key = next.ends[isForward ? 1 : 0];
    last = next;
  }
}

function featureOf(chain: Chain): Feature {
  const { points, edges, isClosed } = chain;
  const length = points.slice(1).reduce((sum, p, i) => sum + distance(points[i]!, p), 0);
  const circle = edges.length >= FEWEST ? circleOf(chain) : null;
  if (circle && !isClosed) return { kind: 'arc', length, circle };
  if (circle) return { kind: isHole(chain, circle) ? 'hole' : 'circle', length, circle };
  const ends = distance(points[0]!, points[points.length - 1]!);
  return { kind: !isClosed && length - ends < ROUND_MM ? 'line' : 'edge', length, circle: null };
}

/** The circle on which all points lie; null: they do not. A closed one is the mean of several. */
function circleOf({ points, isClosed }: Chain): Circle | null {
  const all = isClosed ? points.slice(1) : points; // the last one is the first again
  const n = all.length;
  const third = Math.floor(n / 3);
  const triples = isClosed
    ? Array.from({ length: third }, (_, i) => [i, i + third, i + 2 * third])
    : [[0, n >> 1, n - 1]];
  const found = triples.map(([i, j, k]) => circleThrough(all[i!]!, all[j!]!, all[k!]!));
  const [first] = found;
  if (!first || found.includes(null)) return null;
  const mean = found.reduce((sum, c) => plus(sum, scaled(c!.centre, 1 / found.length)), [0, 0, 0] as Vec3);
  const radius = all.reduce((sum, p) => sum + distance(p, mean) / n, 0);
  const tolerance = Math.max(ROUND_MM, ROUND * radius);
  const isOn = (p: Vec3) =>
    Math.abs(distance(p, mean) - radius) <= tolerance &&
    Math.abs(dot(minus(p, mean), first.normal)) <= tolerance;
  return all.every(isOn) ? { centre: mean, radius, normal: first.normal } : null;
}

/** Whether the wall at the circle faces its centre. */
function isHole({ edges }: Chain, { centre, normal }: Circle): boolean {
  let sum = 0;
  for (const { a, b, normals } of edges) {
    const [p, q] = normals as [Vec3, Vec3];
    const wall = Math.abs(dot(p, normal)) < Math.abs(dot(q, normal)) ? p : q;
    sum += dot(wall, minus(scaled(plus(a, b), 0.5), centre));
  }
  return sum < 0;
}

function cosine(a: Vec3, b: Vec3): number {
  return dot(a, b) / Math.max(Math.hypot(...a) * Math.hypot(...b), 1e-12);
}
