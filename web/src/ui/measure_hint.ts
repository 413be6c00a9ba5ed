// Beside the pointer while measuring: what a click would measure from, with its value.
import { byId } from '../dom';
import { length, lengthNumber, type Unit } from '../format';
import type { MeasureHint } from '../scene';
import type { Marks } from '../view3d/marks';

const REST = 60; // ms; finding edges takes longer than moving the pointer
const BESIDE = 14; // CSS pixels from the pointer

export class HintBox {
  private readonly box = byId('measure-hint');
  private timer = 0;

  constructor(
    private readonly marks: Marks,
    private readonly draw: () => void,
  ) {}

  /** Shows the hint for a point of the canvas once the pointer rests there. */
  want(x: number, y: number, unit: Unit, find: () => MeasureHint | null): void {
    window.clearTimeout(this.timer);
    this.timer = window.setTimeout(() => this.show(x, y, unit, find()), REST);
  }

  hide(): void {
    window.clearTimeout(this.timer);
    if (this.box.hidden) return;
    this.box.hidden = true;
    this.marks.setHint(null, null);
    this.draw();
  }

  private show(x: number, y: number, unit: Unit, hint: MeasureHint | null): void {
    if (!hint) return this.hide();
    this.box.textContent = hintText(hint, unit);
    this.box.hidden = false;
    const { clientWidth, clientHeight } = this.box.parentElement!;
    this.box.style.left = `${beside(x, this.box.offsetWidth, clientWidth)}px`;
    this.box.style.top = `${beside(y, this.box.offsetHeight, clientHeight)}px`;
    this.marks.setHint(hint.point, hint.feature?.circle ?? null);
    this.draw();
  }
}

/** Where a box of this size starts after the pointer, or before it where there is no room after it. */
function beside(at: number, size: number, room: number): number {
  const after = at + BESIDE;
  return after + size <= room ? after : Math.max(at - BESIDE - size, 0);
}

/** "hole, diameter 12.000 mm", "edge, 40.000 mm long", "corner, X 0.000  Y 30.000  Z 0.000". */
export function hintText({ what, point, feature }: MeasureHint, unit: Unit): string {
  if (feature?.circle) {
    const { radius } = feature.circle;
    if (feature.kind === 'arc') return `arc, radius ${length(radius, unit)}`;
    return `${feature.kind}, diameter ${length(2 * radius, unit)}`;
  }
  if (feature) return `edge, ${length(feature.length, unit)} long`;
  const [x, y, z] = point.map((v) => lengthNumber(v, unit));
  return `${what || 'point'}, X ${x}  Y ${y}  Z ${z}`;
}
