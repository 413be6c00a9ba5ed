// Fixtures: blocks as bodies, others by the outline of their bounds.
import * as THREE from 'three';
import type { Fixture } from '../protocol';

const COLOUR = 0x7d6fa8;

export class FixtureBodies {
  readonly group = new THREE.Group();
  private shown = '';

  set(fixtures: readonly Fixture[]): void {
    const all = JSON.stringify(fixtures);
    if (all === this.shown) return;
    this.shown = all;
    for (const child of [...this.group.children]) {
      (child as THREE.Mesh).geometry.dispose();
      this.group.remove(child);
    }
    for (const fixture of fixtures) this.group.add(bodyOf(fixture));
  }
}

function bodyOf({ block: [low, high], shape }: Fixture): THREE.Object3D {
  const size = high.map((v, i) => v - low[i]!) as [number, number, number];
  const box = new THREE.BoxGeometry(...size);
  const body =
    shape === 'block'
      ? new THREE.Mesh(
          box,
          new THREE.MeshLambertMaterial({
            color: COLOUR,
            transparent: true,
            opacity: 0.75,
            depthWrite: false,
          }),
        )
      : new THREE.LineSegments(new THREE.EdgesGeometry(box), new THREE.LineBasicMaterial({ color: COLOUR }));
  body.position.set(...(low.map((v, i) => v + size[i]! / 2) as [number, number, number]));
  return body;
}
