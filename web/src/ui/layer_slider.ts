// The layers of a print: a slider that goes to the end of one, so that the print is seen up to it.
import { byId } from '../dom';
import type { Program } from '../program';

export class LayerSlider {
  private readonly box = byId('layers');
  private readonly slider = byId<HTMLInputElement>('layer');
  private readonly text = byId('layer-text');
  private ends: number[] = []; // seconds

  constructor(seek: (time: number) => void) {
    this.slider.addEventListener('input', () => seek(this.ends[Number(this.slider.value) - 1] ?? Infinity));
  }

  update(program: Program): void {
    this.ends = program.model.kind === 'print' ? layerEnds(program) : [];
    this.box.hidden = this.ends.length < 2;
    this.slider.max = String(this.ends.length);
  }

  show(time: number): void {
    const below = this.ends.findIndex((end) => time <= end + 1e-6);
    const layer = below < 0 ? this.ends.length : below + 1;
    this.slider.value = String(layer);
    this.text.textContent = `${layer} of ${this.ends.length}`;
  }
}

/** The times at which the beads of each height end. */
function layerEnds(program: Program): number[] {
  const { path } = program;
  const ends: number[] = [];
  let height = -Infinity;
  for (let m = 0; m < program.motions; ++m) {
    if (!(path.flow?.[m]! > 0)) continue;
    const last = path.endPoint[m]! - 1;
    if (last < path.firstPoint(m)) continue;
    const z = path.points[3 * last + 2]!;
    if (z > height + 1e-4) {
      ends.push(0);
      height = z;
    }
    ends[ends.length - 1] = program.startOf(m + 1);
  }
  return ends;
}
