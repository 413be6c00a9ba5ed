// The cuts as wide as their tools: a flat band for each segment, from above the area that the tool covers.
import * as THREE from 'three';
import { PATH_COLOURS } from '../colours';
import type { Program } from '../program';

const SIDES = 10; // of the round ends
const MAX_SEGMENTS = 100_000; // segments; further ones are not drawn
const CORNERS = SIDES + 2; // two half circles
const INDICES = 3 * (CORNERS - 2);

export class WidePath extends THREE.Mesh<THREE.BufferGeometry, THREE.MeshBasicMaterial> {
  private source: { program: Program; pairs: Uint32Array; motionOf: (point: number) => number } | null = null;
  private end = Infinity; // segments that are shown

  constructor() {
    const [r, g, b] = PATH_COLOURS.wide;
    const material = new THREE.MeshBasicMaterial({
      color: (r << 16) | (g << 8) | b,
      transparent: true,
      opacity: 0.4,
      depthWrite: false,
      polygonOffset: true, // it lies on the floor that it has cut
      polygonOffsetFactor: -1,
      polygonOffsetUnits: -4,
      side: THREE.DoubleSide,
    });
    super(new THREE.BufferGeometry(), material);
    this.visible = false;
    this.frustumCulled = false;
  }

  /** Pairs of points; the bands are made when they are shown. */
  set(program: Program, pairs: Uint32Array, motionOf: (point: number) => number): void {
    this.source = { program, pairs, motionOf };
    if (this.visible) this.make();
  }

  show(isShown: boolean): void {
    const isNew = isShown && !this.visible;
    this.visible = isShown;
    if (isNew) this.make();
  }

  limit(segments: number): void {
    this.end = segments;
    this.geometry.setDrawRange(0, INDICES * Math.min(segments, MAX_SEGMENTS));
  }

  private make(): void {
    if (!this.source) return;
    const { program, pairs, motionOf } = this.source;
    const { points, tool } = program.path;
    const radii = new Map(
      program.model.tools.map((t) => [
        t.number ?? -1,
        Math.max(0, ...t.profiles.filter((p) => p.part === 'flute').flatMap((p) => p.points.map(([r]) => r))),
      ]),
    );
    const count = Math.min(pairs.length / 2, MAX_SEGMENTS);
    const position = new Float32Array(3 * CORNERS * count);
    const index = new Uint32Array(INDICES * count);
    for (let s = 0; s < count; ++s) {
      const a = 3 * pairs[2 * s]!;
      const b = 3 * pairs[2 * s + 1]!;
      const radius = radii.get(tool[motionOf(pairs[2 * s + 1]!)]!) ?? 0;
      const along = Math.atan2(points[b + 1]! - points[a + 1]!, points[b]! - points[a]!);
      for (let k = 0; k < CORNERS; ++k) {
        const isEnd = k <= SIDES / 2; // the half circle around b, then the one around a
        const turn = along - Math.PI / 2 + ((k - (isEnd ? 0 : 1)) * Math.PI) / (SIDES / 2);
        const from = isEnd ? b : a;
        position[3 * (CORNERS * s + k)] = points[from]! + radius * Math.cos(turn);
        position[3 * (CORNERS * s + k) + 1] = points[from + 1]! + radius * Math.sin(turn);
        position[3 * (CORNERS * s + k) + 2] = points[from + 2]!;
      }
      for (let k = 0; k + 2 < CORNERS; ++k)
        index.set([CORNERS * s, CORNERS * s + k + 1, CORNERS * s + k + 2], INDICES * s + 3 * k);
    }
    this.geometry.dispose();
    this.geometry = new THREE.BufferGeometry();
    this.geometry.setAttribute('position', new THREE.BufferAttribute(position, 3));
    this.geometry.setIndex(new THREE.BufferAttribute(index, 1));
    this.limit(this.end);
  }
}
