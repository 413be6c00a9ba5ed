// What sizes and positions are read from: the axes at the work zero, a grid with its coordinates, and the
// sizes of the stock. Texts are elements above the canvas, which move before each frame.
import * as THREE from 'three';
import { el } from '../dom';
import { length, type Unit } from '../format';
import type { Vec3 } from '../protocol';

export interface Label {
  at: Vec3;
  text: string;
  kind: 'axis' | 'grid' | 'size' | 'size part';
}

const AXES: readonly [string, number][] = [
  ['X', 0xd62728],
  ['Y', 0x2a9d3a],
  ['Z', 0x2468d8],
];
const GRID = 0x8b95a3;
const CELLS = 8; // along the longer side, at least
const MAX_LINES = 60;
const SMALLEST_GAP = 34; // CSS pixels between the numbers of a grid
const MM_PER_INCH = 25.4;

/** The largest of 1, 2, 5, 10, ... times `unit` that is not above `size`. */
export function gridStep(size: number, unit: number): number {
  const power = 10 ** Math.floor(Math.log10(size / unit));
  const digit = size / unit / power;
  return unit * power * (digit >= 5 ? 5 : digit >= 2 ? 2 : 1);
}

export class Rulers {
  readonly group = new THREE.Group();
  readonly labels = el('div', { class: 'labels', 'aria-hidden': 'true' });
  private readonly axes = new THREE.Group();
  private readonly grid = new THREE.LineSegments(
    new THREE.BufferGeometry(),
    new THREE.LineBasicMaterial({ color: GRID, transparent: true, opacity: 0.35, depthWrite: false }),
  );
  private shown: { label: Label; element: HTMLElement }[] = [];
  private key = '';
  /** mm between the lines of the grid. */
  step = 0;

  constructor() {
    this.grid.frustumCulled = false;
    this.group.add(this.grid, this.axes);
  }

  show(grid: boolean, sizes: boolean): void {
    this.group.visible = grid;
    this.labels.classList.toggle('no-grid', !grid);
    this.labels.classList.toggle('no-sizes', !sizes);
  }

  /** `part`: the box of what is left of the stock; null: not known. */
  set(
    bounds: readonly [Vec3, Vec3],
    block: readonly [Vec3, Vec3] | null,
    part: readonly [Vec3, Vec3] | null,
    unit: Unit,
  ): void {
    const key = JSON.stringify([bounds, block, part, unit]);
    if (key === this.key) return;
    this.key = key;
    const [low, high] = bounds;
    const side = Math.max(high[0] - low[0], high[1] - low[1], 1e-3);
    this.step = gridStep(side / CELLS, unit === 'mm' ? 1 : MM_PER_INCH);
    const labels = [...this.setGrid(low, high, unit), ...this.setAxes(2 * this.step)];
    if (block) labels.push(...sizesOf(block, unit));
    if (part && !(block && isSame(part, block))) labels.push(...partSizesOf(part, unit));
    this.shown = labels.map((label) => ({ label, element: el('span', { class: label.kind }, label.text) }));
    this.labels.replaceChildren(...this.shown.map(({ element }) => element));
  }

  private setGrid(low: Vec3, high: Vec3, unit: Unit): Label[] {
    const z = low[2];
    const lines: number[] = [];
    const labels: Label[] = [];
    const from = [0, 1].map((i) => Math.floor(low[i]! / this.step + 1e-9) - 1);
    const to = [0, 1].map((i) => Math.ceil(high[i]! / this.step - 1e-9) + 1);
    for (const i of [0, 1] as const) {
      const other = 1 - i;
      const [a, b] = [from[other]! * this.step, to[other]! * this.step];
      for (let k = from[i]!; k <= to[i]! && k - from[i]! < MAX_LINES; ++k) {
        const v = k * this.step;
        lines.push(...(i === 0 ? [v, a, z, v, b, z] : [a, v, z, b, v, z]));
        labels.push({ at: i === 0 ? [v, a, z] : [a, v, z], text: short(v, unit), kind: 'grid' });
      }
    }
    this.grid.geometry.dispose();
    this.grid.geometry = new THREE.BufferGeometry();
    this.grid.geometry.setAttribute('position', new THREE.Float32BufferAttribute(lines, 3));
    return labels;
  }

  private setAxes(size: number): Label[] {
    for (const child of this.axes.children) (child as THREE.LineSegments).geometry.dispose();
    this.axes.clear();
    return AXES.map(([name, color], i) => {
      const end = [0, 0, 0].map((_, k) => (k === i ? size : 0)) as Vec3;
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute('position', new THREE.Float32BufferAttribute([0, 0, 0, ...end], 3));
      // Seen through the part: the work zero is often inside of it.
      const material = new THREE.LineBasicMaterial({ color, depthTest: false });
      const line = new THREE.LineSegments(geometry, material);
      line.renderOrder = 9;
      line.frustumCulled = false;
      this.axes.add(line);
      return { at: end.map((v) => 1.08 * v) as Vec3, text: name, kind: 'axis' };
    });
  }

  /** Moves the texts to their positions; those that would touch the one before are left out. */
  layOut(project: (at: Vec3) => [number, number], width: number, height: number): void {
    let last: [number, number] | null = null;
    for (const { label, element } of this.shown) {
      const [x, y] = project(label.at);
      const isClose =
        label.kind === 'grid' && last !== null && Math.hypot(x - last[0], y - last[1]) < SMALLEST_GAP;
      const isOutside = x < 0 || y < 0 || x > width || y > height;
      element.hidden = isClose || isOutside;
      if (element.hidden) continue;
      element.style.transform = `translate(-50%, -50%) translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
      if (label.kind === 'grid') last = [x, y];
    }
  }
}

/** A coordinate without zeros at its end. */
function short(v: number, unit: Unit): string {
  return String(Number((unit === 'mm' ? v : v / MM_PER_INCH).toFixed(4)));
}

function isSame(a: readonly [Vec3, Vec3], b: readonly [Vec3, Vec3]): boolean {
  return [0, 1].every((end) => a[end]!.every((v, i) => Math.abs(v - b[end]![i]!) < 1e-3));
}

/** As of a block, at the edges that are opposite to those of the stock. */
function partSizesOf([low, high]: readonly [Vec3, Vec3], unit: Unit): Label[] {
  const centre = (i: number) => (low[i]! + high[i]!) / 2;
  const positions: Vec3[] = [
    [centre(0), high[1], high[2]],
    [low[0], centre(1), high[2]],
    [low[0], high[1], centre(2)],
  ];
  return positions.map((at, i) => {
    const text = `part ${length(high[i]! - low[i]!, unit)}`;
    return { at, text, kind: 'size part' };
  });
}

/** The lengths of three edges of a block. */
function sizesOf([low, high]: readonly [Vec3, Vec3], unit: Unit): Label[] {
  const centre = (i: number) => (low[i]! + high[i]!) / 2;
  const positions: Vec3[] = [
    [centre(0), low[1], low[2]],
    [high[0], centre(1), low[2]],
    [high[0], low[1], centre(2)],
  ];
  return positions.flatMap((at, i): Label[] => {
    const size = high[i]! - low[i]!;
    return size > 0 ? [{ at, text: length(size, unit), kind: 'size' }] : [];
  });
}
