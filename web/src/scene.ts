// What is in the picture: part, lines, tool, marks on one stage, and what is under a point of it.
import { Vector3 } from 'three';
import { changeNear } from './change';
import { Palette } from './colours';
import { FINAL, type MeshAnswer, NO_STEP, type TargetAnswer } from './decode';
import type { Unit } from './format';
import type { Program } from './program';
import type { Vec3 } from './protocol';
import type { ColourMode, LayerName } from './settings';
import type { MeasuredPoint } from './ui/measure';
import { BurnBoard } from './view3d/burn';
import { detailOf } from './view3d/detail';
import { FixtureBodies } from './view3d/fixtures';
import { MachineBody } from './view3d/machine';
import { Marks } from './view3d/marks';
import { MovesView } from './view3d/moves';
import { PartView } from './view3d/part';
import { type FullDetail, RestPicture } from './view3d/rest_picture';
import { Rulers } from './view3d/rulers';
import { type Feature, featureAt } from './view3d/feature';
import { snap } from './view3d/snap';
import { Stage } from './view3d/stage';
import { ToolBody } from './view3d/tool_body';

const SMALLEST_CELL = 0.1; // mm, of parts without columns
const LINE_REACH = 6; // CSS pixels
const SNAP_REACH = 10; // CSS pixels
const AROUND = [[0, 0], [7, 0], [-7, 0], [0, 7], [0, -7], [5, 5], [5, -5], [-5, 5], [-5, -5]] as const;
const NO_MOTIONS = new Uint32Array();

export interface Picked {
  point: Vec3;
  /** The step of the surface or line; NO_STEP on the stock's own faces and the section. */
  step: number;
  /** The motion of a picked line, else -1. */
  motion: number;
}

export interface MeasureHint extends MeasuredPoint {
  /** Of edges of the part, where it is known. */
  feature: Feature | null;
}

export class Scene {
  readonly stage: Stage;
  readonly part = new PartView();
  readonly moves = new MovesView();
  readonly tool = new ToolBody();
  readonly marks = new Marks();
  readonly fixtures = new FixtureBodies();
  readonly machine = new MachineBody();
  readonly rulers = new Rulers();
  readonly burn = new BurnBoard();
  /** The cuts are drawn fainter or stronger than before. */
  onFade: () => void = () => {};
  /** Of the finished part that is left of a stock; null: none. */
  partBounds: [Vec3, Vec3] | null = null;
  private fade = 1;
  private target: TargetAnswer | null = null;
  private program: Program | null = null;
  private selected: Uint32Array = NO_MOTIONS;
  private mode: ColourMode = 'tool';
  private hiddenKey = '';
  private hiddenOf: Program['path'] | null = null;

  constructor(canvas: HTMLCanvasElement) {
    this.stage = new Stage(canvas);
    const detail = detailOf(this.stage.renderer);
    this.stage.beforeFrame = () => {
      const cell = this.program?.model.pitch ?? SMALLEST_CELL;
      this.part.chooseDetail(this.stage.visibleSpace(), detail.triangles, cell);
      this.fadeCuts();
      this.moves.chooseDetail(this.stage.pixelSize(), detail.segments);
      const { clientWidth, clientHeight } = this.stage.canvas;
      this.rulers.layOut((at) => this.stage.project(at), clientWidth, clientHeight);
    };
    canvas.after(this.rulers.labels);
    this.stage.scene.add(
      this.part.group,
      this.moves.group,
      this.tool.group,
      this.marks.group,
      this.fixtures.group,
      this.machine.group,
      this.rulers.group,
      this.burn,
    );
    this.drawAtRest();
  }

  /** The state of the drawing is in the page, where tests of it and pages around it can read it. */
  private drawAtRest(): void {
    const { stage, part } = this;
    const rest = new RestPicture(
      stage.renderer,
      stage.scene,
      () => stage.drawing,
      () => this.fullDetail(),
      part.material,
    );
    const slices = stage.setRestPicture(rest);
    slices.onChange = () => {
      const { dataset } = stage.canvas;
      const isComplete = slices.isFinished || (slices.count === 0 && !this.isCoarse);
      dataset.detail = isComplete ? 'full' : slices.count > 0 ? 'slices' : 'moving';
      dataset.slices = String(slices.count);
      dataset.triangles = String(slices.isFinished ? rest.triangles : part.triangles(stage.visibleSpace()));
    };
  }

  private get isCoarse(): boolean {
    return this.part.isCoarse || this.moves.isCoarse;
  }

  private fullDetail(): FullDetail | null {
    if (!this.isCoarse) return null;
    const { part, moves, stage } = this;
    return {
      surface: part.full(stage.visibleSpace()),
      surfaceObject: part.group,
      lines: moves.full(),
      isClear: part.isClear,
    };
  }

  private fadeCuts(): void {
    const bounds = this.program?.model.bounds;
    if (!bounds) return;
    const hasSurface = this.program!.model.kind !== 'drawing' && this.part.group.visible;
    const [low, high] = bounds;
    this.moves.fadeCuts(this.stage.pixelSize(), hasSurface ? (high[0] - low[0]) * (high[1] - low[1]) : 0);
    const { fade } = this.moves;
    const level = (f: number) => (f === 0 ? 0 : f < 1 ? 1 : 2);
    const isOther = level(fade) !== level(this.fade);
    this.fade = fade;
    if (isOther) this.onFade();
  }

  setUnit(unit: Unit): void {
    const model = this.program?.model;
    if (!model?.bounds) return;
    this.rulers.set(model.bounds, model.stock?.block ?? model.bounds, this.partBounds, unit);
  }

  update(program: Program, mesh: MeshAnswer, target: TargetAnswer | null, mode: ColourMode): void {
    this.target = target;
    const before = this.program?.model;
    const isOther = before?.name !== program.model.name || before?.source !== program.model.source;
    const isSame = !isOther && before?.revision === program.model.revision;
    const newPath = this.program?.path !== program.path;
    if (newPath) this.selected = NO_MOTIONS;
    this.program = program;
    this.mode = mode;
    const palette = this.palette();
    this.part.update(mesh, palette, isOther ? 'other' : isSame ? 'same' : 'save');
    program.hasEarlier = this.part.hasEarlier;
    this.partBounds = program.model.stock ? this.part.bounds() : null;
    this.part.recolour(palette);
    if (newPath) this.moves.update(program, palette);
    else this.moves.recolour(palette);
    this.marks.setStock(program.model.stock?.block ?? null);
    this.fixtures.set(program.model.fixtures ?? []);
    this.machine.set(program.model.machine?.travel ?? null);
    this.showDifference();
    this.stage.setBounds(
      program.model.bounds ?? [
        [0, 0, 0],
        [1, 1, 1],
      ],
    );
    this.stage.draw();
  }

  setColourMode(mode: ColourMode): void {
    if (mode === this.mode) return;
    this.mode = mode;
    this.showDifference();
    this.recolour();
  }

  private get differences(): TargetAnswer | null {
    return this.mode === 'target' ? this.target : null;
  }

  showBurn(): void {
    this.showDifference();
    this.stage.draw();
  }

  /** J/mm2 of the burn at a point of the canvas; null beside the board, and in other colourings. */
  burnAt(x: number, y: number): { point: Vec3; energy: number } | null {
    const found = this.burn.energyAt(this.stage.rayAt(x, y).ray);
    return found && { point: found.point.toArray() as Vec3, energy: found.energy };
  }

  /** Kinds of beads that are not shown. */
  hideBeads(kinds: ReadonlySet<number>): void {
    if (!this.program) return;
    const { path } = this.program;
    const isFiltered = this.mode === 'type' && path?.bead && kinds.size > 0;
    const key = isFiltered ? [...kinds].sort().join() : '';
    if (key === this.hiddenKey && path === this.hiddenOf) return;
    this.hiddenKey = key;
    this.hiddenOf = path;
    let hidden: Uint8Array | null = null;
    if (isFiltered) {
      hidden = new Uint8Array((path.step[path.motions - 1] ?? 0) + 1);
      for (let m = 0; m < path.motions; ++m) hidden[path.step[m]!] = kinds.has(path.bead![m]!) ? 1 : 0;
    }
    this.part.hide(hidden);
    this.moves.hide(hidden, this.palette());
    this.stage.draw();
  }

  /** Five times the tolerance has the full colour, as in the pictures of `kerf compare`. */
  private showDifference(): void {
    const { program, mode } = this;
    if (program && mode === 'change')
      program.change ??= this.part.change(program.model.bounds!, program.model.pitch ?? SMALLEST_CELL);
    const tolerance = program?.model.target?.tolerance_mm ?? 0;
    this.part.showDifference(this.differences, 5 * tolerance);
    this.part.showChange(mode === 'change' ? (program?.change ?? null) : null);
    this.burn.set(mode === 'burn' ? (program?.burn ?? null) : null, program?.model.bounds?.[1][2] ?? 0);
  }

  /** mm left (above 0) or gouged (below 0) on the column, or what has changed there; null: not compared. */
  differenceAt(point: Vec3): number | null {
    const change = this.program?.change;
    if (this.mode === 'change') return change ? changeNear(change, point) : null;
    const [x, y] = point;
    const t = this.target;
    if (!t) return null;
    const i = Math.floor((x - t.x) / t.pitch);
    const j = Math.floor((y - t.y) / t.pitch);
    return i >= 0 && j >= 0 && i < t.nx && j < t.ny ? t.depth[j * t.nx + i]! : null;
  }

  private recolour(): void {
    if (!this.program) return;
    const palette = this.palette();
    this.part.recolour(palette);
    this.moves.recolour(palette);
    this.stage.draw();
  }

  private palette(): Palette {
    const mode = this.mode === 'target' && !this.target ? 'tool' : this.mode;
    return new Palette(this.program!, mode, this.selected);
  }

  /** Highlights motions and the surfaces that they made. */
  select(motions: Uint32Array): void {
    this.selected = motions;
    this.moves.highlight(motions);
    this.recolour();
  }

  show(layers: Record<LayerName, boolean>): void {
    this.part.group.visible = layers.part;
    this.part.setClear(layers.clear);
    // The lines would cover the burn.
    this.moves.show(layers.cuts && this.mode !== 'burn', layers.rapids);
    this.moves.wide.show(layers.wide);
    this.rulers.show(layers.grid, layers.sizes);
    this.stage.setPerspective(layers.perspective);
    this.marks.stock.visible = layers.stock && this.program?.model.stock != null;
    this.tool.group.children.forEach((child) => (child.visible = layers.tool));
    this.fixtures.group.visible = layers.fixtures;
    this.machine.group.visible = layers.machine;
    this.stage.draw();
  }

  /** The instant of the lines and the tool; the part follows by PartView. */
  setInstant(time: number, isAtEnd: boolean, showTool: boolean): void {
    const program = this.program;
    if (!program) return;
    const m = program.motionAt(time);
    this.moves.limit(isAtEnd ? program.motions : m);
    if (m >= 0) {
      const number = program.path.tool[m]!;
      const tools = program.model.tools;
      this.tool.setTool(tools.find((t) => (t.number ?? -1) === number) ?? null);
    }
    this.tool.group.children.forEach((child) => (child.visible = showTool));
    const tip = isAtEnd ? null : program.tipAt(time);
    this.tool.moveTo(tip);
    this.machine.moveTo(tip, this.tool.height);
    if (program.model.kind === 'print') this.part.limit(isAtEnd ? FINAL : (program.path.step[m] ?? 0));
    this.stage.draw();
  }

  /** The point at or near a point of the canvas from which is measured; `centres` are snapped to as well. */
  measuredPoint(x: number, y: number, centres: readonly Vec3[]): MeasuredPoint | null {
    const pixels = (p: Vec3) => {
      const [px, py] = this.stage.project(p);
      return Math.hypot(px - x, py - y);
    };
    const nearest = centres.reduce<Vec3 | null>((a, b) => (a && pixels(a) <= pixels(b) ? a : b), null);
    if (nearest && pixels(nearest) <= SNAP_REACH) return { point: nearest, what: 'centre' };
    const reach = SNAP_REACH * this.stage.pixelSize();
    // Just beside the part its edge is meant.
    for (const [dx, dy] of AROUND) {
      const picked = this.pick(x + dx, y + dy, false);
      if (!picked) continue;
      const point = new Vector3(...picked.point);
      const snapped = snap(this.part.surfacesNear(point, reach), picked.point, reach);
      if (snapped && !this.stage.isHidden(new Vector3(...snapped.point))) return snapped;
      if (dx === 0 && dy === 0) return { point: picked.point, what: '' };
    }
    const line = this.part.group.visible && this.part.bounds() ? null : this.pick(x, y);
    return line ? this.endOfLine(line, pixels) : null;
  }

  /** What a click would measure from, with the edge or circle there; null: nothing. */
  measureHint(x: number, y: number, centres: readonly Vec3[]): MeasureHint | null {
    const measured = this.measuredPoint(x, y, centres);
    const bounds = this.part.bounds();
    if (measured?.what !== 'edge' || !bounds) return measured && { ...measured, feature: null };
    const near = (at: Vec3, reach: number) => this.part.surfacesNear(new Vector3(...at), reach);
    const size = new Vector3(...bounds[0]).distanceTo(new Vector3(...bounds[1]));
    const feature = featureAt(near, measured.point, SNAP_REACH * this.stage.pixelSize(), size);
    return { ...measured, feature };
  }

  /** The end of the picked motion, where it is near. */
  private endOfLine({ point, motion }: Picked, pixels: (p: Vec3) => number): MeasuredPoint {
    const ends = [0, 1].map((t) => this.program?.pointOn(motion, t) ?? null);
    const near = ends.find((end) => end && pixels(end) <= SNAP_REACH);
    return near ? { point: near, what: 'end' } : { point, what: '' };
  }

  /** What is drawn at a point of the canvas: a line in front of the surface, else the surface. */
  pick(x: number, y: number, wantsLines = true): Picked | null {
    const caster = this.stage.rayAt(x, y);
    const surface = this.part.hit(
      caster,
      (p) => this.stage.isHidden(p),
      (ray) => this.stage.onSection(ray),
    );
    if (wantsLines) {
      // A line on the surface is as far away as the surface, within the columns' accuracy.
      const limit = surface ? surface.distance + Math.max(this.program?.model.pitch ?? 0, 0.05) : Infinity;
      const { origin, direction } = caster.ray;
      const isVisible = (p: typeof origin) =>
        !this.stage.isHidden(p) && p.clone().sub(origin).dot(direction) <= limit;
      const line = this.moves.hit(x, y, LINE_REACH, this.stage.toPixels(), isVisible);
      if (line) {
        const step = this.program?.path.step[line.motion] ?? NO_STEP;
        return { point: line.point.toArray() as Vec3, step, motion: line.motion };
      }
    }
    return surface ? { point: surface.point.toArray() as Vec3, step: surface.step, motion: -1 } : null;
  }
}
