// What is in the picture: part, lines, tool, marks on one stage, and what is under a point of it.
import { Palette } from './colours';
import { FINAL, type MeshAnswer, NO_STEP } from './decode';
import type { Program } from './program';
import type { Vec3 } from './protocol';
import type { ColourMode, LayerName } from './settings';
import { Marks } from './view3d/marks';
import { MovesView } from './view3d/moves';
import { PartView } from './view3d/part';
import { Stage } from './view3d/stage';
import { ToolBody } from './view3d/tool_body';

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
  private program: Program | null = null;
  private selected: Uint32Array = NO_MOTIONS;
  private mode: ColourMode = 'tool';

  constructor(canvas: HTMLCanvasElement) {
    this.stage = new Stage(canvas);
    this.stage.scene.add(this.part.group, this.moves.group, this.tool.group, this.marks.group);
  }

  update(program: Program, mesh: MeshAnswer, mode: ColourMode): void {
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
    this.stage.setBounds(
      program.model.bounds ?? [
        [0, 0, 0],
        [1, 1, 1],
      ],
    );
    this.stage.draw();
  }

  setColourMode(mode: ColourMode): void {
    this.mode = mode;
    this.recolour();
  }

  private recolour(): void {
    if (!this.program) return;
    const palette = this.palette();
    this.part.recolour(palette);
    this.moves.recolour(palette);
    this.stage.draw();
  }

  private palette(): Palette {
    return new Palette(this.program!, this.mode, this.selected);
  }

  /** Highlights motions and the surfaces that they made. */
  select(motions: Uint32Array): void {
    this.selected = motions;
    this.moves.highlight(motions);
    this.recolour();
  }

  show(layers: Record<LayerName, boolean>): void {
    this.part.group.visible = layers.part;
    this.moves.show(layers.cuts, layers.rapids);
    this.marks.stock.visible = layers.stock && this.program?.model.stock != null;
    this.tool.group.children.forEach((child) => (child.visible = layers.tool));
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
    this.tool.moveTo(isAtEnd ? null : program.tipAt(time));
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
