// What the colours and lines of the picture mean.
import { isContact, type Key, keysOf, PATH_COLOURS, rampGradient } from '../colours';
import { byId, el } from '../dom';
import { length, type Unit } from '../format';
import type { Program } from '../program';
import type { ColourMode, LayerName } from '../settings';

// Colourings of the whole surface, also where a hazard made it.
const COVERING: ReadonlySet<ColourMode> = new Set(['target', 'change', 'burn']);
const NARROW = '(max-width: 760px)';

export class Legend {
  private readonly box = byId<HTMLDetailsElement>('legend');
  private readonly list = byId('legend-list');
  /** Kinds of beads that are not shown. */
  readonly hidden = new Set<number>();
  onFilter: () => void = () => {};

  constructor() {
    this.box.open = !window.matchMedia(NARROW).matches;
  }

  update(
    program: Program,
    mode: ColourMode,
    unit: Unit,
    show: Record<LayerName, boolean>,
    grid: number,
    fade: number,
  ): void {
    this.box.hidden = !show.legend;
    if (!show.legend) return;
    const { model } = program;
    const keys = keysOf(program, mode, unit);
    if (model.findings.some(isContact) && !COVERING.has(mode))
      keys.push({ colour: model.hazard_colour ?? [214, 32, 40], text: 'hazard' });
    const [cuts, rapids] = model.kind === 'print' ? ['beads', 'travel'] : ['cuts', 'rapids'];
    if (show.cuts && mode !== 'burn' && program.motions > 0)
      keys.push({
        line: PATH_COLOURS.cut,
        text:
          fade === 0
            ? `${cuts}: hidden, denser than pixels`
            : fade < 1
              ? `${cuts}: faded, zoom in`
              : cuts!,
      });
    if (show.rapids && program.motions > 0) keys.push({ line: PATH_COLOURS.rapid, text: rapids! });
    if (show.wide) keys.push({ colour: PATH_COLOURS.wide, text: 'path as wide as its tool' });
    const rows = keys.map((key) => this.row(key));
    if (show.grid && grid > 0) rows.push(el('li', {}, `grid ${length(grid, unit)}`));
    this.list.replaceChildren(...rows);
  }

  private row(key: Key): HTMLElement {
    if (!('bead' in key) || key.bead === undefined) return row(key);
    const { bead } = key;
    const box = el('input', { type: 'checkbox' });
    box.checked = !this.hidden.has(bead);
    box.addEventListener('change', () => {
      if (box.checked) this.hidden.delete(bead);
      else this.hidden.add(bead);
      this.onFilter();
    });
    return el('li', {}, el('label', {}, box, ...row(key).childNodes));
  }
}

function row(key: Key): HTMLElement {
  if ('low' in key) {
    const bar = el('span', { class: 'ramp' });
    bar.style.background = key.gradient ?? rampGradient();
    return el('li', {}, `${key.text}`, el('div', { class: 'scale' }, key.low, bar, key.high));
  }
  const swatch = el('span', { class: 'line' in key ? 'swatch stroke' : 'swatch' });
  swatch.style.background = `rgb(${('line' in key ? key.line : key.colour).join()})`;
  return el('li', {}, swatch, key.text);
}
