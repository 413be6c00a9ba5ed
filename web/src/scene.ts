// What is in the picture: part, lines, tool, marks on one stage, and what is under a point of it.
import { Palette } from './colours';
import { FINAL, type MeshAnswer, NO_STEP, type TargetAnswer } from './decode';
import type { Unit } from './format';
import type { Program } from './program';
import type { Vec3 } from './protocol';
import type { ColourMode, LayerName } from './settings';
import { detailOf } from './view3d/detail';
import { FixtureBodies } from './view3d/fixtures';
import { MachineBody } from './view3d/machine';
import { Marks } from './view3d/marks';
import { MovesView } from './view3d/moves';
import { PartView } from './view3d/part';
import { Rulers } from './view3d/rulers';
import { Stage } from './view3d/stage';
import { ToolBody } from './view3d/tool_body';

const SMALLEST_CELL = 0.1; // mm, of parts without columns
const LINE_REACH = 6; // CSS pixels
const NO_MOTIONS = new Uint32Array();

export interface Picked {
  point: Vec3;
  /** The step of the surface or line; NO_STEP on the stock's own faces and the section. */
  step: number;
  /** The motion of a picked line, else -1. */
  motion: number;
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
  /** The cuts are drawn fainter or stronger than before. */
  onFade: () => void = () => {};
  private fade = 1;
  private target: TargetAnswer | null = null;
  private program: Program | null = null;
  private selected: Uint32Array = NO_MOTIONS;
  private mode: ColourMode = 'tool';

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
    );
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
    if (model?.bounds) this.rulers.set(model.bounds, model.stock?.block ?? model.bounds, unit);
  }

  update(program: Program, mesh: MeshAnswer, target: TargetAnswer | null, mode: ColourMode): void {
    this.target = target;
    const newPath = this.program?.path !== program.path;
    if (newPath) this.selected = NO_MOTIONS;
    this.program = program;
    this.mode = mode;
    const palette = this.palette();
    this.part.update(mesh, palette);
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

  /** Five times the tolerance has the full colour, as in the pictures of `kerf compare`. */
  private showDifference(): void {
    const tolerance = this.program?.model.target?.tolerance_mm ?? 0;
    this.part.showDifference(this.mode === 'target' ? this.target : null, 5 * tolerance);
  }

  /** mm left (above 0) or gouged (below 0) on the column at x, y; null: not compared. */
  differenceAt([x, y]: Vec3): number | null {
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
    this.moves.show(layers.cuts, layers.rapids);
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
    if (program.model.kind !== 'milling') this.part.limit(isAtEnd ? FINAL : (program.path.step[m] ?? 0));
    this.stage.draw();
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
