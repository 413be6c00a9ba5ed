// Lines and circles of edges, on bodies whose sizes are known.
import { describe, expect, test } from 'vitest';
import type { Surface } from '../../src/decode';
import type { Vec3 } from '../../src/protocol';
import { featureAt } from '../../src/view3d/feature';

/** A prism over a polygon, from z 0 to `height`; `turned`: its faces look inwards, as those of a hole. */
function prism(base: readonly [number, number][], height: number, turned = false): Surface {
  const n = base.length;
  const positions = [0, height].flatMap((z) => base.flatMap(([x, y]) => [x, y, z]));
  const triangles: number[][] = [];
  for (let i = 0; i < n; ++i) {
    const j = (i + 1) % n;
    triangles.push([i, j, n + j], [i, n + j, n + i]);
    if (i > 1) triangles.push([0, i, i - 1], [n, n + i - 1, n + i]);
  }
  const index = triangles.flatMap((t) => (turned ? [...t].reverse() : t));
  return {
    positions: Float32Array.from(positions),
    index: Uint32Array.from(index),
    step: new Uint32Array(triangles.length),
  } as Surface;
}

const round = (lines: number, radius: number, part = 1): [number, number][] =>
  Array.from({ length: lines }, (_, i) => {
    const angle = (2 * Math.PI * part * i) / lines;
    return [5 + radius * Math.cos(angle), 7 + radius * Math.sin(angle)];
  });
const at = (surface: Surface, point: Vec3) => featureAt(() => [surface], point, 0.5, 100);

describe('features', () => {
  test('a straight edge has its whole length, seen from any point', () => {
    const box = prism([[0, 0], [40, 0], [40, 30], [0, 30]], 6);
    expect(at(box, [11, 0, 6])).toMatchObject({ kind: 'line', length: 40, circle: null });
    expect(at(box, [40, 29.9, 6])).toMatchObject({ kind: 'line', length: 30 });
    expect(at(box, [40, 30, 3])).toMatchObject({ kind: 'line', length: 6 });
    // Divided into several lines on the way.
    const divided = prism([[0, 30], [0, 0], [13, 0], [15, 0], [40, 0], [40, 30]], 6);
    expect(at(divided, [14, 0, 6])).toMatchObject({ kind: 'line', length: 40 });
  });

  test('a rim is a circle, or a hole where its wall faces the centre', () => {
    for (const [turned, kind] of [[false, 'circle'], [true, 'hole']] as const) {
      const found = at(prism(round(60, 6), 3, turned), [11, 7, 3])!;
      expect(found.kind).toBe(kind);
      expect(found.circle!.radius).toBeCloseTo(6, 5);
      found.circle!.centre.forEach((v, i) => expect(v).toBeCloseTo([5, 7, 3][i]!, 4));
    }
  });

  test('part of a circle is an arc, other curves are edges', () => {
    const arc = at(prism(round(60, 6, 0.6), 3), [5, 13, 3])!;
    expect(arc.kind).toBe('arc');
    expect(arc.circle!.radius).toBeCloseTo(6, 4);
    const oval = round(60, 6).map(([x, y]): [number, number] => [2 * x, y]);
    expect(at(prism(oval, 3), [22, 7, 3])).toMatchObject({ kind: 'edge', circle: null });
  });

  test('without an edge there is none', () => {
    expect(at(prism(round(60, 6), 3), [5, 7, 3])).toBeNull();
  });
});
