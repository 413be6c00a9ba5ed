// Measuring: the distance of two points, or the circle through three. Points snap to corners and edges of the
// part, to ends of lines, and to the centres of circles measured before.
import { byId, el } from '../dom';
import { length, lengthNumber, type Unit } from '../format';
import type { Vec3 } from '../protocol';
import type { Marks } from '../view3d/marks';
import { type Circle, circleThrough } from '../view3d/snap';

export interface MeasuredPoint {
  point: Vec3;
  /** What it has snapped to; empty: a point of a surface or line. */
  what: '' | 'corner' | 'edge' | 'end' | 'centre';
}

export class Measure {
  /** Of the circles measured since measuring started. */
  readonly centres: Vec3[] = [];
  private points: MeasuredPoint[] = [];
  private circle: Circle | null = null;
  private readonly box = byId('measured');
  private readonly choice = byId<HTMLSelectElement>('measure-what');
  private unit: Unit = 'mm';

  constructor(
    private readonly marks: Marks,
    private readonly changed: () => void,
  ) {
    this.choice.addEventListener('change', () => this.restart());
  }

  private get count(): number {
    return this.choice.value === 'circle' ? 3 : 2;
  }

  add(point: MeasuredPoint): void {
    if (this.points.length === this.count) this.points = [];
    this.points.push(point);
    const [a, b, c] = this.points;
    this.circle = this.count === 3 && c ? circleThrough(a!.point, b!.point, c.point) : null;
    if (this.circle) this.centres.push(this.circle.centre);
    this.show(true, this.unit);
  }

  /** Forgets the points and centres. */
  clear(isOn: boolean): void {
    this.centres.length = 0;
    this.points = [];
    this.circle = null;
    this.marks.setPoint(null);
    this.show(isOn, this.unit);
  }

  /** Between the distance of two points and the circle through three. */
  toggleWhat(): void {
    this.choice.value = this.choice.value === 'circle' ? 'distance' : 'circle';
    this.restart();
  }

  private restart(): void {
    this.points = [];
    this.circle = null;
    this.show(true, this.unit);
  }

  show(isOn: boolean, unit: Unit): void {
    this.unit = unit;
    this.box.hidden = !isOn;
    this.marks.setDistance(this.points.map(({ point }) => point));
    this.marks.setCircles(this.circle ? [this.circle] : [], this.centres);
    byId('measured-text').replaceChildren(...unbroken(this.text()));
    this.changed();
  }

  private text(): string {
    const { points, unit } = this;
    const number = (v: number) => lengthNumber(v, unit);
    if (points.length < this.count) {
      const which = ['first', 'second', 'third'][points.length]!;
      const last = points[points.length - 1];
      const at = last?.what ? `At ${last.what === 'corner' ? 'a' : 'an'} ${last.what}. ` : '';
      const where = this.count === 3 ? ' on the rim' : '';
      const key = points.length === 0 ? ' (P: the centre of the view)' : '';
      return `${at.replace('an centre', 'a centre')}Click the ${which} point${where}${key}.`;
    }
    const names = points.map(({ what }) => what || 'point').join(', ');
    if (this.count === 3) {
      if (!this.circle) return `The three points lie on a line (${names})`;
      const { centre, radius } = this.circle;
      const [x, y, z] = centre.map(number);
      return `Diameter ${length(2 * radius, unit)}   centre X ${x}  Y ${y}  Z ${z}   (${names})`;
    }
    const d = points[1]!.point.map((v, i) => v - points[0]!.point[i]!);
    const axes = ['X', 'Y', 'Z'].map((axis, i) => `${axis} ${number(d[i]!)}`).join('  ');
    return `Distance ${length(Math.hypot(...d), unit)}   ${axes}   (${names})`;
  }
}

/** A name stays on the line of its value; values are separated by two spaces or more. */
function unbroken(text: string): (HTMLElement | string)[] {
  const values = text.split(/( {2,})/);
  return values.length < 2 ? values : values.map((v, i) => (i % 2 ? v : el('span', { class: 'value' }, v)));
}
