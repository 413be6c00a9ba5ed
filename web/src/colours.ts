// The colour of each step, and of each triangle: by tool, operation, depth, step, speed or layer; hazards
// in the hazard colour. Colours are sRGB bytes.
import { NO_STEP, type Surface } from './decode';
import { feed, length, type Unit, volume } from './format';
import { RAPID, type Program } from './program';
import type { Mark, Rgb, Tool } from './protocol';
import type { ColourMode } from './settings';

const STOCK: Rgb = [188, 170, 140];
const HAZARD: Rgb = [214, 32, 40];
const SELECTED: Rgb = [255, 110, 185];

// Distinct under the common kinds of colour blindness (Okabe and Ito, without black and the hazard's red).
const GROUPS: readonly Rgb[] = [
  [86, 180, 233],
  [230, 159, 0],
  [0, 158, 115],
  [204, 121, 167],
  [240, 228, 66],
  [0, 114, 178],
  [150, 150, 150],
];
// From low to high: dark blue, green, yellow; increasing in lightness.
const RAMP: readonly Rgb[] = [
  [68, 60, 140],
  [49, 104, 142],
  [33, 145, 140],
  [94, 201, 98],
  [253, 231, 37],
];

// As in the pictures of `kerf compare`.
const MATCH: Rgb = [150, 190, 150];
const LEFT: readonly [Rgb, Rgb] = [
  [170, 205, 250],
  [10, 40, 160],
];
const GOUGED: readonly [Rgb, Rgb] = [
  [250, 190, 150],
  [170, 0, 20],
];

export function ramp(t: number): Rgb {
  const x = Math.min(Math.max(Number.isFinite(t) ? t : 0, 0), 1) * (RAMP.length - 1);
  const i = Math.min(Math.floor(x), RAMP.length - 2);
  const a = RAMP[i]!;
  const b = RAMP[i + 1]!;
  return [0, 1, 2].map((k) => Math.round(a[k]! + (x - i) * (b[k]! - a[k]!))) as Rgb;
}

// By the numbers of Model.bead_kinds: walls orange and yellow, infill red and violet, support green.
const BEADS: readonly Rgb[] = [
  [150, 150, 150],
  [200, 180, 120],
  [230, 126, 34],
  [245, 200, 66],
  [40, 70, 190],
  [178, 66, 120],
  [150, 100, 220],
  [225, 90, 110],
  [70, 150, 230],
  [245, 240, 170],
  [255, 160, 140],
  [70, 160, 90],
  [30, 110, 70],
  [110, 170, 170],
  [190, 190, 200],
];

// As in the pictures of `kerf simulate --show burn`: the board, scorched, charred.
const BOARD: Rgb = [238, 222, 190];
const SCORCHED: Rgb = [140, 84, 36];
const CHARRED: Rgb = [18, 12, 8];

/** The colour of a board where the beam leaves `t` of the energy that makes it black. */
export function burnColour(t: number): Rgb {
  const x = 2 * Math.min(Math.max(t, 0), 1);
  const [from, to] = x < 1 ? [BOARD, SCORCHED] : [SCORCHED, CHARRED];
  const part = x < 1 ? x : x - 1;
  return [0, 1, 2].map((k) => Math.round(from[k]! + part * (to[k]! - from[k]!))) as Rgb;
}

/** The kinds of beads in a print, in the order of their numbers. */
export function beadKinds({ path, model }: Program): number[] {
  const found = new Set<number>();
  path.bead?.forEach((kind, m) => {
    if ((path.flow?.[m] ?? 0) > 0 && kind < (model.bead_kinds?.length ?? 0)) found.add(kind);
  });
  return [...found].sort((a, b) => a - b);
}

export const PATH_COLOURS: Record<'cut' | 'rapid' | 'wide', Rgb> = {
  cut: [70, 76, 84],
  rapid: [217, 130, 43],
  wide: [150, 50, 190],
};

export function rampGradient(): string {
  return `linear-gradient(to right, ${RAMP.map((c) => `rgb(${c.join()})`).join()})`;
}

/** An entry of the legend: an area's colour, a line's colour, or a range. */
export type Key =
  | { colour: Rgb; text: string; bead?: number }
  | { line: Rgb; text: string }
  | { low: string; high: string; text: string; gradient?: string };

const MAX_KEYS = 10;

/** Whether a colouring shows a difference in a program. */
export function applies(program: Program, mode: ColourMode): boolean {
  const { model, path } = program;
  const isPrint = model.kind === 'print';
  switch (mode) {
    case 'operation':
      return operationStarts(program).length > 1;
    case 'depth':
      return !isPrint && (model.bounds?.[1][2] ?? 0) > (model.bounds?.[0][2] ?? 0);
    case 'step':
      return program.motions > 1;
    case 'speed':
      return path.feed.some((f) => f > 0);
    case 'flow':
      return path.flow !== null;
    case 'layer':
      return isPrint;
    case 'power':
      return path.power !== null;
    case 'type':
      return beadKinds(program).length > 0;
    case 'burn':
      return path.power !== null;
    case 'change':
      return program.hasEarlier && model.kind === 'milling';
    case 'target':
      return model.target != null;
    default:
      return true;
  }
}

/** What the colours of the surface mean. */
export function keysOf(program: Program, mode: ColourMode, unit: Unit): Key[] {
  const { model, path } = program;
  const stock: Key[] = model.stock ? [{ colour: model.stock_colour ?? STOCK, text: 'stock, not cut' }] : [];
  const high = (values: Float32Array) => values.reduce((a, b) => Math.max(a, b), 0);
  const [low, top] = [model.bounds?.[0][2] ?? 0, model.bounds?.[1][2] ?? 0];
  switch (mode) {
    case 'operation': {
      const starts = operationStarts(program);
      const isNamed = (m: Mark) => m.kind === 'note' || m.tool != null;
      const names = model.marks.filter((m) => starts.includes(m.step) && isNamed(m));
      const keys = names
        .slice(0, MAX_KEYS)
        .map((m, i) => ({ colour: group(i), text: m.text || `T${m.tool}` }));
      const left = names.length - MAX_KEYS;
      if (left > 0) keys.push({ colour: [128, 128, 128], text: `and ${left} more` });
      return [...stock, ...keys];
    }
    case 'depth':
    case 'layer':
      return [{ low: length(low, unit), high: length(top, unit), text: 'Z' }];
    case 'step':
      return [...stock, { low: 'first', high: 'last', text: 'order of the cuts' }];
    case 'speed': {
      let max = 0;
      for (let m = 0; m < program.motions; ++m)
        if (path.kind[m] !== RAPID) max = Math.max(max, path.feed[m]!);
      return [...stock, { low: '0', high: feed(max, unit), text: 'feed' }];
    }
    case 'flow':
      return [{ low: '0', high: `${high(path.flow ?? new Float32Array()).toFixed(1)} mm³/s`, text: 'flow' }];
    case 'power':
      return [...stock, { low: 'S0', high: `S${high(path.power!)}`, text: 'power of the beam' }];
    case 'type':
      return beadKinds(program).map((bead) => {
        const text = (model.bead_kinds![bead] || 'not named').replaceAll('_', ' ');
        return { colour: BEADS[bead] ?? BEADS[0]!, text, bead };
      });
    case 'burn':
      return burnKeys(program, unit);
    case 'change':
      return changeKeys(program, unit);
    case 'target': {
      const full = 5 * (model.target?.tolerance_mm ?? 0);
      return [
        { colour: MATCH, text: 'within the tolerance' },
        { colour: differenceColour(full, full), text: `left: ${length(full, unit)} or more` },
        { colour: differenceColour(-full, full), text: `gouged: ${length(full, unit)} or more` },
      ];
    }
    default: {
      const tools = model.tools.filter((t) => t.number !== null).slice(0, MAX_KEYS);
      if (model.kind === 'print' && tools.length === 0) return [{ colour: group(0), text: 'beads' }];
      const named = (t: Tool) => ({ colour: t.colour, text: `T${t.number} ${t.name ?? ''}`.trim() });
      return [...stock, ...tools.map(named)];
    }
  }
}

function changeKeys({ change }: Program, unit: Unit): Key[] {
  if (!change) return [];
  const { highest, more, less } = change;
  if (highest === 0) return [{ colour: MATCH, text: 'no change of the part' }];
  const keys: Key[] = [{ colour: MATCH, text: 'as before the last save' }];
  const deep = `up to ${length(highest, unit)}`;
  if (more > 0)
    keys.push({
      colour: differenceColour(-highest, highest),
      text: `${volume(more, unit)} removed more, ${deep}`,
    });
  if (less > 0)
    keys.push({
      colour: differenceColour(highest, highest),
      text: `${volume(less, unit)} removed less, ${deep}`,
    });
  return keys;
}

function burnKeys({ burn, path }: Program, unit: Unit): Key[] {
  if (!burn) return [{ colour: BOARD, text: 'board; the burn is being made' }];
  const colours = [BOARD, SCORCHED, CHARRED].map((c) => `rgb(${c.join()})`);
  const gradient = `linear-gradient(to right, ${colours.join()})`;
  const { black, beam, power, fullS, joules } = burn;
  const keys: Key[] = [
    {
      low: '0',
      high: `${black.toPrecision(3)} J/mm² or more`,
      text: `burn, ${joules.toPrecision(3)} J in all`,
      gradient,
    },
    { colour: BOARD, text: `board; beam ${length(beam, unit)}, ${power} W at S${fullS}` },
  ];
  const highest = path.power!.reduce((a, b) => Math.max(a, b), 0);
  if (highest > fullS) keys.push({ colour: CHARRED, text: `S${highest} of the program counts as S${fullS}` });
  return keys;
}

export function group(index: number): Rgb {
  return GROUPS[index % GROUPS.length]!;
}

/** The colour of a difference from the target, saturated from `full` mm: left blue, gouged red. */
export function differenceColour(depth: number, full: number): Rgb {
  if (depth === 0) return MATCH;
  const t = Math.min(Math.abs(depth) / Math.max(full, 1e-9), 1);
  const [from, to] = depth < 0 ? GOUGED : LEFT;
  return from.map((v, k) => Math.round(v + t * (to[k]! - v))) as Rgb;
}

/** As a number whose bytes in memory are red, green, blue and 255. */
export function word([r, g, b]: Rgb): number {
  return (r | (g << 8) | (b << 16) | (255 << 24)) >>> 0;
}

/** Colours of the steps of one program in one mode. */
export class Palette {
  readonly stock: Rgb;
  readonly hazard: Rgb;
  readonly byDepth: boolean;
  private readonly words: Uint32Array;
  private readonly stockWord: number;
  private readonly marked: Uint8Array;
  private readonly low: number;
  private readonly high: number;

  constructor(
    private readonly program: Program,
    readonly mode: ColourMode,
    selectedMotions?: Uint32Array,
  ) {
    const { model } = program;
    this.stock = model.stock_colour ?? STOCK;
    this.hazard = model.hazard_colour ?? HAZARD;
    this.byDepth = mode === 'depth';
    this.low = model.bounds?.[0][2] ?? 0;
    this.high = model.bounds?.[1][2] ?? 0;
    this.words = new Uint32Array(stepCount(program));
    this.stockWord = word(this.stock);
    this.marked = new Uint8Array(stepCount(program));
    this.fill();
    for (const finding of model.findings) {
      if (!isContact(finding)) continue;
      const first = finding.step ?? NO_STEP;
      for (let s = first; s < first + (finding.steps ?? 1); ++s) this.mark(s, this.hazard);
    }
    for (const m of selectedMotions ?? []) this.mark(program.path.step[m]!, SELECTED);
  }

  ofStep(step: number): Rgb {
    const w = this.wordOfStep(step);
    return [w & 255, (w >> 8) & 255, (w >> 16) & 255];
  }

  /** Whether a step has the colour of hazards or of the selection, whatever the mode. */
  isMarked(step: number): boolean {
    return this.marked[step] === 1;
  }

  ofDepth(z: number): Rgb {
    return ramp(this.high > this.low ? (z - this.low) / (this.high - this.low) : 1);
  }

  /** Four bytes for each corner of each triangle of a tile. */
  paint(surface: Surface): Uint8Array {
    const { step, index, positions } = surface;
    const out = new Uint32Array(3 * step.length);
    for (let t = 0; t < step.length; ++t) {
      if (this.byDepth && !this.isMarked(step[t]!)) {
        for (let k = 3 * t; k < 3 * t + 3; ++k) out[k] = word(this.ofDepth(positions[3 * index[k]! + 2]!));
      } else {
        out.fill(this.wordOfStep(step[t]!), 3 * t, 3 * t + 3);
      }
    }
    return new Uint8Array(out.buffer);
  }

  /** The colour of a step as four bytes, red first. */
  wordOfStep(step: number): number {
    return step < this.words.length ? this.words[step]! : this.stockWord;
  }

  private mark(step: number, rgb: Rgb): void {
    if (step >= this.marked.length) return;
    this.marked[step] = 1;
    this.set(step, rgb);
  }

  private set(step: number, rgb: Rgb): void {
    if (step < this.words.length) this.words[step] = word(rgb);
  }

  private fill(): void {
    const { program } = this;
    const { path } = program;
    const colour = motionColours(program, this.mode);
    this.words.fill(word([150, 150, 150]));
    let last: Rgb | null = null;
    let own = 0;
    for (let m = 0; m < program.motions; ++m) {
      const next = colour(m);
      if (next !== last) own = word(next); // most motions have the colour of those before
      last = next;
      this.words[path.step[m]!] = own;
    }
  }
}

function motionColours(program: Program, mode: ColourMode): (m: number) => Rgb {
  const { path, model } = program;
  switch (mode) {
    case 'operation': {
      const starts = operationStarts(program);
      return (m) => group(Math.max(countNotAbove(starts, path.step[m]!) - 1, 0));
    }
    case 'step':
      return (m) => ramp(program.motions > 1 ? m / (program.motions - 1) : 0);
    case 'speed': {
      let max = 0;
      for (let m = 0; m < program.motions; ++m)
        if (path.kind[m] !== RAPID) max = Math.max(max, path.feed[m]!);
      return (m) => ramp(max > 0 ? path.feed[m]! / max : 0);
    }
    case 'flow': {
      const max = (path.flow ?? new Float32Array()).reduce((high, flow) => Math.max(high, flow), 0);
      return (m) => ramp(max > 0 ? path.flow![m]! / max : 0);
    }
    case 'power': {
      const max = (path.power ?? new Float32Array()).reduce((high, s) => Math.max(high, s), 0);
      return (m) => ramp(max > 0 ? path.power![m]! / max : 0);
    }
    case 'type':
      return (m) => BEADS[path.bead?.[m] ?? 0] ?? BEADS[0]!;
    case 'burn':
    case 'change':
    case 'target':
      return () => model.stock_colour ?? STOCK;
    case 'layer':
    case 'depth': {
      const [low, high] = [model.bounds?.[0][2] ?? 0, model.bounds?.[1][2] ?? 0];
      return (m) => ramp(high > low ? (endZ(program, m) - low) / (high - low) : 1);
    }
    default: {
      const colours = new Map(model.tools.map((tool) => [tool.number ?? -1, tool.colour]));
      return (m) => colours.get(path.tool[m]!) ?? group(Math.max(path.tool[m]!, 0));
    }
  }
}

/** The steps at which operations start: notes of the program, else tool changes. */
export function operationStarts(program: Program): number[] {
  const notes = program.model.marks.filter((mark) => mark.kind === 'note');
  const marks = notes.length > 0 ? notes : program.model.marks.filter((mark) => mark.kind === 'tool');
  return marks.map((mark) => mark.step);
}

function endZ(program: Program, m: number): number {
  const last = program.path.endPoint[m]! - 1;
  return last < 0 ? 0 : program.path.points[3 * last + 2]!;
}

/** Whether material was touched, so that the surface shows the hazard. */
export function isContact(finding: { removed_mm3?: number | null; depth_mm?: number | null }): boolean {
  return (finding.removed_mm3 ?? 0) > 0 || (finding.depth_mm ?? 0) > 0;
}

function stepCount(program: Program): number {
  const last = program.motions > 0 ? program.path.step[program.motions - 1]! + 1 : 0;
  return Math.max(last, 0);
}

function countNotAbove(sorted: readonly number[], value: number): number {
  let low = 0;
  let high = sorted.length;
  while (low < high) {
    const mid = (low + high) >> 1;
    if (sorted[mid]! <= value) low = mid + 1;
    else high = mid;
  }
  return low;
}
