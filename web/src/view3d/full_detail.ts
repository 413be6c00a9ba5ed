// The surface and the lines in their own detail, bit by bit: one buffer of fixed size, filled again for each
// slice, so that a part of millions of triangles needs no further memory.
import * as THREE from 'three';
import type { Palette } from '../colours';
import type { Surface } from '../decode';

const CAPACITY = 65_536; // triangles, or segments

/** Triangles that are to be drawn. */
export interface FullSurface {
  surfaces: readonly Surface[];
  palette: Palette;
  /** Whether triangles of a step are shown; null: all are. */
  shows: ((step: number) => boolean) | null;
}

/** Segments that are to be drawn: the first `count` / 2 pairs of points. */
export interface FullLines {
  lines: THREE.LineSegments;
  index: Uint32Array;
  count: number;
}

function buffer(array: Float32Array | Uint8Array | Uint32Array, size: number): THREE.BufferAttribute {
  const attribute = new THREE.BufferAttribute(array, size, array instanceof Uint8Array);
  attribute.setUsage(THREE.DynamicDrawUsage);
  return attribute;
}

function send(attribute: THREE.BufferAttribute, numbers: number): void {
  attribute.clearUpdateRanges();
  attribute.addUpdateRange(0, numbers);
  attribute.needsUpdate = true;
}

export class SurfaceSlices {
  readonly mesh: THREE.Mesh;
  private readonly position = buffer(new Float32Array(9 * CAPACITY), 3);
  private readonly colour = buffer(new Uint8Array(12 * CAPACITY), 4);
  private source: FullSurface | null = null;
  private surface = 0; // the next one, and its next triangle
  private triangle = 0;
  private filled = 0;

  constructor(material: THREE.Material) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', this.position);
    geometry.setAttribute('color', this.colour);
    this.mesh = new THREE.Mesh(geometry, material);
    this.mesh.frustumCulled = false;
    this.mesh.visible = false;
  }

  begin(source: FullSurface | null): void {
    this.source = source;
    this.surface = 0;
    this.triangle = 0;
  }

  /** Takes the next triangles, at most `count`, and returns how many; 0: there are no more. */
  fill(count: number): number {
    this.filled = 0;
    const wanted = Math.min(count, CAPACITY);
    const surfaces = this.source?.surfaces ?? [];
    while (this.filled < wanted && this.surface < surfaces.length) {
      const surface = surfaces[this.surface]!;
      const first = this.triangle;
      this.triangle = Math.min(first + wanted - this.filled, surface.step.length);
      this.add(surface, first, this.triangle);
      if (this.triangle < surface.step.length) continue;
      ++this.surface;
      this.triangle = 0;
    }
    send(this.position, 9 * this.filled);
    send(this.colour, 12 * this.filled);
    this.mesh.geometry.setDrawRange(0, 3 * this.filled);
    return this.filled;
  }

  private add(surface: Surface, first: number, end: number): void {
    const part = this.shown({
      positions: surface.positions,
      index: surface.index.subarray(3 * first, 3 * end),
      step: surface.step.subarray(first, end),
    });
    const { positions, index, step } = part;
    const corners = this.position.array;
    let at = 9 * this.filled;
    for (let i = 0; i < index.length; ++i) {
      const v = 3 * index[i]!;
      corners[at++] = positions[v]!;
      corners[at++] = positions[v + 1]!;
      corners[at++] = positions[v + 2]!;
    }
    (this.colour.array as Uint8Array).set(this.source!.palette.paint(part), 12 * this.filled);
    this.filled += step.length;
  }

  private shown(part: Surface): Surface {
    const shows = this.source?.shows;
    if (!shows) return part;
    const kept = Array.from(part.step.keys()).filter((t) => shows(part.step[t]!));
    return {
      positions: part.positions,
      index: Uint32Array.from(kept.flatMap((t) => [...part.index.subarray(3 * t, 3 * t + 3)])),
      step: Uint32Array.from(kept, (t) => part.step[t]!),
    };
  }
}

export class LineSlices {
  readonly object = new THREE.LineSegments(new THREE.BufferGeometry());
  private readonly index = buffer(new Uint32Array(2 * CAPACITY), 1);
  private sources: readonly FullLines[] = [];
  private source = 0; // the next one, and the next number of its index
  private at = 0;

  constructor() {
    this.object.geometry.setIndex(this.index);
    this.object.frustumCulled = false;
    this.object.visible = false;
  }

  begin(sources: readonly FullLines[]): void {
    this.sources = sources;
    this.source = 0;
    this.at = 0;
  }

  /** Takes the next segments of one object, at most `count`, and returns how many; 0: there are no more. */
  fill(count: number): number {
    while (this.source < this.sources.length && this.at >= this.sources[this.source]!.count) {
      ++this.source;
      this.at = 0;
    }
    const from = this.sources[this.source];
    if (!from) return 0;
    const end = Math.min(this.at + 2 * Math.min(count, CAPACITY), from.count);
    const taken = from.index.subarray(this.at, end);
    this.at = end;
    (this.index.array as Uint32Array).set(taken);
    send(this.index, taken.length);
    const { geometry } = this.object;
    for (const name of ['position', 'color'])
      geometry.setAttribute(name, from.lines.geometry.getAttribute(name));
    geometry.setDrawRange(0, taken.length);
    this.object.material = from.lines.material;
    return taken.length / 2;
  }
}
