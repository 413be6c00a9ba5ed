// The report: times, tools, bounds, volumes and what the program is.
import { byId, el, swatch } from '../dom';
import { duration, feed, length, lengthNumber, type Unit, UNKNOWN, volume } from '../format';
import { RAPID, type Program } from '../program';
import type { Model, TargetFigures, Tool } from '../protocol';

export class ReportPane {
  private readonly pane = byId('report');

  update(program: Program, unit: Unit): void {
    const { model } = program;
    this.pane.replaceChildren(
      el('h2', {}, 'Time'),
      timeTable(model),
      el('h2', {}, 'Tools'),
      toolTable(model, unit),
      ...(model.target ? [el('h2', {}, 'Target'), targetTable(model.target, unit)] : []),
      el('h2', {}, 'Stock and motions'),
      sizeTable(program, unit),
    );
  }
}

function facts(rows: [string, string][]): HTMLElement {
  return el(
    'table',
    {},
    el(
      'tbody',
      {},
      ...rows.map(([name, value]) =>
        el('tr', {}, el('th', { scope: 'row' }, name), el('td', { class: 'n' }, value)),
      ),
    ),
  );
}

function timeTable(model: Model): HTMLElement {
  const times = model.times;
  const rows: [string, string][] = [
    ['Total', duration(times?.total_s)],
    ['Cutting', duration(times?.cutting_s)],
    ['Rapids', duration(times?.rapid_s)],
    ['Dwells', duration(times?.dwell_s)],
  ];
  rows.push(['Machine', times?.machine || (times?.planned ? 'planned with accelerations' : 'feeds only')]);
  return facts(rows);
}

function targetTable(target: TargetFigures, unit: Unit): HTMLElement {
  const deepest = (kind: string) =>
    target.regions.reduce((deep, r) => (r.kind === kind ? Math.max(deep, r.depth_mm) : deep), 0);
  return facts([
    ['File', target.file],
    ['Tolerance', length(target.tolerance_mm, unit)],
    ['Left', volume(target.left_mm3, unit)],
    ['Deepest left', length(deepest('rest'), unit)],
    ['Gouged', volume(target.gouged_mm3, unit)],
    ['Deepest gouge', length(deepest('gouge'), unit)],
  ]);
}

function toolTable(model: Model, unit: Unit): HTMLElement {
  const cuts = model.kind === 'milling' || model.kind === 'rotary';
  const row = (tool: Tool) =>
    el(
      'tr',
      {},
      el('td', {}, swatch(tool.colour), tool.number === null ? UNKNOWN : `T${tool.number}`),
      el('td', {}, tool.name),
      el('td', { class: 'n' }, duration(tool.time_s)),
      ...(cuts ? [volume(tool.removed_mm3, unit), length(tool.flute_length, unit)] : []).map((text) =>
        el('td', { class: 'n' }, text),
      ),
    );
  const head = ['Tool', 'Name', 'Time', ...(cuts ? ['Removed', 'Flutes'] : [])];
  return el(
    'table',
    {},
    el(
      'thead',
      {},
      el(
        'tr',
        {},
        ...head.map((h, i) => el('th', i > 1 ? { scope: 'col', class: 'n' } : { scope: 'col' }, h)),
      ),
    ),
    el('tbody', {}, ...model.tools.map(row)),
  );
}

function sizeTable(program: Program, unit: Unit): HTMLElement {
  const { model } = program;
  const rows: [string, string][] = [];
  const block = model.stock?.block ?? null;
  if (block) {
    rows.push([
      'Stock',
      `${block[1].map((v, i) => lengthNumber(v - block[0][i]!, unit)).join(' × ')} ${unit}`,
    ]);
    rows.push(['Stock from', model.stock?.source || UNKNOWN]);
  }
  const cut = cutBounds(program);
  for (const [i, axis] of ['X', 'Y', 'Z'].entries()) {
    rows.push([
      `Cuts in ${axis}`,
      cut ? `${lengthNumber(cut.low[i], unit)} to ${length(cut.high[i], unit)}` : UNKNOWN,
    ]);
  }
  const feeds = feedRange(program);
  rows.push(['Feeds', feeds ? [...new Set(feeds.map((f) => feed(f, unit)))].join(' to ') : UNKNOWN]);
  rows.push(['Motions', String(program.motions)]);
  rows.push(['Column pitch', length(model.pitch, unit)]);
  rows.push(['Program', [model.front_end, model.kind].filter(Boolean).join(', ')]);
  return facts(rows);
}

/** The box of all cutting motions, or null if there are none. */
export function cutBounds(program: Program): { low: number[]; high: number[] } | null {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  const { path } = program;
  const { endPoint, kind, points } = path;
  for (let m = 0; m < program.motions; ++m) {
    if (kind[m] === RAPID) continue;
    for (let p = 3 * path.firstPoint(m); p < 3 * endPoint[m]!; ++p) {
      low[p % 3] = Math.min(low[p % 3]!, points[p]!);
      high[p % 3] = Math.max(high[p % 3]!, points[p]!);
    }
  }
  return low[0]! <= high[0]! ? { low, high } : null;
}

export function feedRange(program: Program): [number, number] | null {
  let low = Infinity;
  let high = 0;
  for (let m = 0; m < program.motions; ++m) {
    const f = program.path.feed[m]!;
    if (program.path.kind[m] === RAPID || !(f > 0)) continue;
    low = Math.min(low, f);
    high = Math.max(high, f);
  }
  return high > 0 ? [low, high] : null;
}
