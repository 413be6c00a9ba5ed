// Where a ray meets the triangles of a surface.
import * as THREE from 'three';
import type { Surface } from '../decode';

export interface RayHit {
  distance: number;
  triangle: number;
  point: THREE.Vector3;
  facesAway: boolean;
}

/** All hits from either side, the nearest first. */
export function rayHits({ positions, index, step }: Surface, ray: THREE.Ray): RayHit[] {
  const hits: RayHit[] = [];
  const corners = [new THREE.Vector3(), new THREE.Vector3(), new THREE.Vector3()] as const;
  const normal = new THREE.Vector3();
  const point = new THREE.Vector3();
  for (let t = 0; t < step.length; ++t) {
    const [a, b, c] = corners;
    a.fromArray(positions, 3 * index[3 * t]!);
    b.fromArray(positions, 3 * index[3 * t + 1]!);
    c.fromArray(positions, 3 * index[3 * t + 2]!);
    if (!ray.intersectTriangle(a, b, c, false, point)) continue;
    THREE.Triangle.getNormal(a, b, c, normal);
    hits.push({
      distance: point.distanceTo(ray.origin),
      triangle: t,
      point: point.clone(),
      facesAway: normal.dot(ray.direction) > 0,
    });
  }
  return hits.sort((x, y) => x.distance - y.distance);
}
