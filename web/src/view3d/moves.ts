// The toolpath as lines: cuts in the colours of the part, rapids in a colour of their own, and highlighted
// motions on top.
import * as THREE from 'three';
import { type Palette, PATH_COLOURS, word } from '../colours';
import { RAPID, type Program } from '../program';
import type { Rgb } from '../protocol';
import { coarserLines } from './coarse';
import type { FullLines } from './full_detail';
import { WidePath } from './wide_path';

const RAPID_COLOUR = word(PATH_COLOURS.rapid);
// Length of cuts per area of the picture, in pixels: lines fade between these, and are hidden above.
const SPARSE = 0.2;
const DENSE = 0.5;
const HIGHLIGHT = 0xff2d95;
const CELL_PIXELS = 2;

export interface LineHit {
  motion: number;
  point: THREE.Vector3;
  /** CSS pixels between the line and the pointer. */
  pixels: number;
}

export class MovesView {
  readonly group = new THREE.Group();
  private readonly cuts = lines(flatLines());
  private readonly rapids = lines(flatLines());
  readonly wide = new WidePath();
  private readonly chosen = lines(new THREE.LineBasicMaterial({ color: HIGHLIGHT, depthTest: false }));
  private program: Program | null = null;
  private cutIndex: Uint32Array = new Uint32Array();
  private rapidIndex: Uint32Array = new Uint32Array();
  /** mm: the size of cells of the lines that are drawn; 0: all of them. */
  private readonly cells = new Map<THREE.LineSegments, number>();
  private end = Infinity; // of the points that are shown
  private cutLength = 0; // mm
  /** 1: cuts are drawn as they are; less: faded, because they are denser than pixels; 0: hidden. */
  fade = 1;
  private showsCuts = true;
  private hidden: Uint8Array | null = null; // 1 for each step that is not shown

  constructor() {
    this.chosen.renderOrder = 10;
    this.group.add(this.cuts, this.rapids, this.wide, this.chosen);
  }

  show(cuts: boolean, rapids: boolean): void {
    this.showsCuts = cuts;
    this.cuts.visible = cuts && this.fade > 0;
    this.rapids.visible = rapids;
  }

  hide(hidden: Uint8Array | null, palette: Palette): void {
    if (hidden === this.hidden) return;
    this.hidden = hidden;
    const { end } = this;
    if (!this.program) return;
    this.update(this.program, palette);
    this.showUpTo(end);
  }

  update(program: Program, palette: Palette): void {
    this.program = program;
    const { points, kind } = program.path;
    const position = new THREE.BufferAttribute(points, 3);
    const { step } = program.path;
    this.cutIndex = segments(program, (m) => kind[m] !== RAPID && this.hidden?.[step[m]!] !== 1);
    this.rapidIndex = segments(program, (m) => kind[m] === RAPID);
    this.cutLength = lengthOf(points, this.cutIndex);
    this.cells.clear();
    this.end = Infinity;
    this.replace(this.cuts, position, this.cutIndex);
    this.replace(this.rapids, position, this.rapidIndex);
    this.replace(this.chosen, position, new Uint32Array());
    this.wide.set(program, this.cutIndex, (p) => program.path.motionOfPoint(p));
    this.recolour(palette);
  }

  /** Draws coarser lines where there are more segments than `limit`; `pixel`: mm, at the present zoom. */
  chooseDetail(pixel: number, limit: number): void {
    if (!this.program) return;
    const segments = (this.cutIndex.length + this.rapidIndex.length) / 2;
    const cell = segments > limit ? 2 ** Math.ceil(Math.log2(CELL_PIXELS * pixel)) : 0;
    const { points } = this.program.path;
    for (const [object, index] of this.objects) {
      if (!object.visible || cell === (this.cells.get(object) ?? 0)) continue;
      this.cells.set(object, cell);
      const pairs = cell > 0 ? coarserLines(points, index, cell) : index;
      object.geometry.setIndex(new THREE.BufferAttribute(pairs, 1));
      this.limitTo(object, this.end);
    }
  }

  /** Whether fewer segments are drawn than there are. */
  get isCoarse(): boolean {
    return this.objects.some(([object]) => object.visible && (this.cells.get(object) ?? 0) > 0);
  }

  /** The visible lines in their own detail. */
  full(): FullLines[] {
    const visible = this.objects.filter(([object]) => object.visible);
    return visible.map(([lines, index]) => ({ lines, index, count: countBelow(index, this.end) }));
  }

  /** Lets the surface be seen below cuts that would cover it; `area`: mm2 that they share, 0: no surface. */
  fadeCuts(pixel: number, area: number): void {
    const cover = area > 0 ? (this.cutLength * pixel) / area : 0;
    this.fade = Math.min(Math.max((DENSE - cover) / (DENSE - SPARSE), 0), 1);
    const material = this.cuts.material as THREE.LineBasicMaterial;
    material.transparent = this.fade < 1;
    material.opacity = this.fade;
    this.cuts.visible = this.showsCuts && this.fade > 0;
  }

  private get objects() {
    return [
      [this.cuts, this.cutIndex],
      [this.rapids, this.rapidIndex],
    ] as const;
  }

  private showUpTo(end: number): void {
    this.end = end;
    for (const [object] of this.objects) this.limitTo(object, end);
    this.wide.limit(countBelow(this.cutIndex, end) / 2);
  }

  private limitTo(object: THREE.LineSegments, end: number): void {
    const pairs = object.geometry.index?.array as Uint32Array | undefined;
    object.geometry.setDrawRange(0, pairs ? countBelow(pairs, end) : 0);
  }

  private replace(object: THREE.LineSegments, position: THREE.BufferAttribute, index: Uint32Array): void {
    object.geometry.dispose();
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', position);
    geometry.setIndex(new THREE.BufferAttribute(index, 1));
    object.geometry = geometry;
    object.frustumCulled = false;
  }

  recolour(palette: Palette): void {
    const program = this.program;
    if (!program) return;
    const { path } = program;
    const { endPoint, kind, step, points } = path;
    const colours = new Uint32Array(points.length / 3);
    let last = -1;
    let dark = 0;
    for (let m = 0; m < program.motions; ++m) {
      const first = path.ownPoint(m);
      const end = endPoint[m]!;
      const isMarked = palette.isMarked(step[m]!);
      if (kind[m] === RAPID && !isMarked) {
        colours.fill(RAPID_COLOUR, first, end);
      } else if (palette.byDepth && !isMarked) {
        for (let p = first; p < end; ++p) colours[p] = word(darker(palette.ofDepth(points[3 * p + 2]!)));
      } else {
        const own = palette.wordOfStep(step[m]!);
        if (own !== last) dark = word(darker(palette.ofStep(step[m]!)));
        last = own;
        for (let p = first; p < end; ++p) colours[p] = dark;
      }
    }
    const attribute = new THREE.BufferAttribute(new Uint8Array(colours.buffer), 4, true);
    this.rapids.geometry.setAttribute('color', attribute);
    this.cuts.geometry.setAttribute('color', attribute);
  }

  /** Shows only the motions before `motion`, and that one. */
  limit(motion: number): void {
    const last = Math.min(motion, (this.program?.motions ?? 0) - 1);
    const end = last >= 0 ? this.program!.path.endPoint[last]! : 0;
    this.showUpTo(end);
  }

  highlight(motions: Uint32Array): void {
    if (!this.program) return;
    const wanted = new Set(motions);
    this.chosen.geometry.setIndex(
      new THREE.BufferAttribute(
        segments(this.program, (m) => wanted.has(m)),
        1,
      ),
    );
    this.chosen.geometry.setDrawRange(0, Infinity);
  }

  /** The box around motions, or null if none of them has a known position. */
  boundsOf(motions: Uint32Array): THREE.Box3 | null {
    const box = new THREE.Box3();
    if (!this.program) return null;
    const { path } = this.program;
    const { endPoint, points } = path;
    const point = new THREE.Vector3();
    for (const m of motions) {
      for (let p = path.firstPoint(m); p < endPoint[m]!; ++p)
        box.expandByPoint(point.fromArray(points, 3 * p));
    }
    return box.isEmpty() ? null : box;
  }

  /** The visible line nearest to a pixel, within `reach` CSS pixels; `rows` as from Stage.toPixels. */
  hit(
    x: number,
    y: number,
    reach: number,
    rows: number[],
    isVisible: (p: THREE.Vector3) => boolean,
  ): LineHit | null {
    let best: LineHit | null = null;
    for (const [object, index] of this.objects) {
      if (object.visible) best = this.nearest(index, x, y, rows, best, reach, isVisible);
    }
    return best;
  }

  private nearest(
    index: Uint32Array,
    x: number,
    y: number,
    r: number[],
    best: LineHit | null,
    reach: number,
    isVisible: (p: THREE.Vector3) => boolean,
  ): LineHit | null {
    const points = this.program!.path.points;
    const row = (k: number, p: number) =>
      r[k]! * points[p]! + r[k + 1]! * points[p + 1]! + r[k + 2]! * points[p + 2]! + r[k + 3]!;
    const px = (p: number) => row(0, p) / row(12, p);
    const py = (p: number) => row(4, p) / row(12, p);
    const count = countBelow(index, this.end);
    for (let i = 0; i + 1 < count; i += 2) {
      const a = 3 * index[i]!;
      const b = 3 * index[i + 1]!;
      const ax = px(a);
      const ay = py(a);
      const dx = px(b) - ax;
      const dy = py(b) - ay;
      const squared = dx * dx + dy * dy;
      const t = squared > 0 ? Math.min(Math.max(((x - ax) * dx + (y - ay) * dy) / squared, 0), 1) : 0;
      const pixels = Math.hypot(ax + t * dx - x, ay + t * dy - y);
      if (pixels > reach || (best && pixels >= best.pixels)) continue;
      const point = new THREE.Vector3()
        .fromArray(points, a)
        .lerp(new THREE.Vector3().fromArray(points, b), t);
      if (isVisible(point)) best = { motion: this.program!.path.motionOfPoint(index[i + 1]!), point, pixels };
    }
    return best;
  }
}

/** Darker than the surface that the motion made, so that the line is visible on it. */
function darker(rgb: Rgb): Rgb {
  return rgb.map((c) => Math.round(0.62 * c)) as Rgb;
}

/** Lines in the colour of their end: motions share the points between them. */
function flatLines(): THREE.LineBasicMaterial {
  const material = new THREE.LineBasicMaterial({ vertexColors: true });
  const { color_pars_vertex, color_pars_fragment } = THREE.ShaderChunk;
  const flat = (chunk: string) => chunk.replaceAll('varying', 'flat varying');
  material.onBeforeCompile = (shader) => {
    shader.vertexShader = shader.vertexShader.replace(
      '#include <color_pars_vertex>',
      flat(color_pars_vertex),
    );
    shader.fragmentShader = shader.fragmentShader.replace(
      '#include <color_pars_fragment>',
      flat(color_pars_fragment),
    );
  };
  return material;
}

function lines(material: THREE.LineBasicMaterial): THREE.LineSegments {
  return new THREE.LineSegments(new THREE.BufferGeometry(), material);
}

/** Pairs of points of the chosen motions, in order. */
function segments(program: Program, isWanted: (m: number) => boolean): Uint32Array {
  const { path } = program;
  let count = 0;
  for (let m = 0; m < program.motions; ++m) {
    if (isWanted(m)) count += Math.max(path.endPoint[m]! - path.firstPoint(m) - 1, 0);
  }
  const pairs = new Uint32Array(2 * count);
  let at = 0;
  for (let m = 0; m < program.motions; ++m) {
    if (!isWanted(m)) continue;
    for (let p = path.firstPoint(m); p + 1 < path.endPoint[m]!; ++p) {
      pairs[at++] = p;
      pairs[at++] = p + 1;
    }
  }
  return pairs;
}

/** Of all segments seen from above, mm. */
function lengthOf(points: Float32Array, pairs: Uint32Array): number {
  let sum = 0;
  for (let i = 0; i + 1 < pairs.length; i += 2) {
    const a = 3 * pairs[i]!;
    const b = 3 * pairs[i + 1]!;
    const d = Math.hypot(points[b]! - points[a]!, points[b + 1]! - points[a + 1]!);
    if (Number.isFinite(d)) sum += d;
  }
  return sum;
}

/** How many entries of an increasing list of pairs are below `end`. */
function countBelow(index: Uint32Array, end: number): number {
  let low = 0;
  let high = index.length;
  while (low < high) {
    const mid = (low + high) >> 1;
    if (index[mid]! < end) low = mid + 1;
    else high = mid;
  }
  return low - (low % 2);
}
