// The setup sheet: what has to be known at the machine, on one page to print. What is unknown is a dash.
import { byId, el } from '../dom';
import { duration, length, lengthNumber, type Unit, UNKNOWN } from '../format';
import type { Program } from '../program';
import type { Tool } from '../protocol';
import { cutBounds } from './report_pane';

/** Prints the sheet; `picture` is the address of a picture of the part. */
export async function printSheet(program: Program, unit: Unit, picture: string): Promise<void> {
  const image = el('img', { alt: 'The part', src: picture });
  await image.decode();
  const sheet = byId('sheet');
  sheet.replaceChildren(...contents(program, unit, image));
  sheet.hidden = false;
  window.addEventListener('afterprint', () => (sheet.hidden = true), { once: true });
  window.print();
}

function contents(program: Program, unit: Unit, image: HTMLElement): HTMLElement[] {
  const { model } = program;
  return [
    el('h1', {}, model.name),
    image,
    table(['Stock and zero', ''], setup(program, unit)),
    table(['Tool', 'Name', 'Stick-out', 'Flutes', 'Deepest cut', 'Time'], tools(program, unit)),
    table(
      ['Attention', ''],
      model.findings.map((f) => [f.kind.replaceAll('_', ' '), f.message]).slice(0, 20),
    ),
  ].filter((each) => each.textContent !== '' || each === image);
}

function table(head: string[], rows: string[][]): HTMLElement {
  if (rows.length === 0) return el('div');
  return el(
    'table',
    {},
    el('thead', {}, el('tr', {}, ...head.map((h) => el('th', { scope: 'col' }, h)))),
    el('tbody', {}, ...rows.map((row) => el('tr', {}, ...row.map((cell) => el('td', {}, cell))))),
  );
}

function setup(program: Program, unit: Unit): string[][] {
  const { model } = program;
  const rows: string[][] = [];
  const block = model.stock?.block;
  const u = unit === 'mm' ? 'mm' : 'in';
  if (block) {
    const [low, high] = block;
    const size = high.map((v, i) => lengthNumber(v - low[i]!, unit)).join(' × ');
    rows.push(['Stock', `${size} ${u} (${model.stock?.source || UNKNOWN})`]);
    const from = low.map((v) => lengthNumber(-v, unit));
    rows.push([
      'Zero, from the lower left corner of the stock',
      `X ${from[0]}, Y ${from[1]} ${u}; ${length(high[2], unit)} below its top`,
    ]);
  }
  const cut = cutBounds(program);
  if (cut) {
    const range = (i: number) => `${lengthNumber(cut.low[i], unit)} to ${lengthNumber(cut.high[i], unit)}`;
    rows.push(['Cuts', `X ${range(0)}, Y ${range(1)}, Z ${range(2)} ${u}`]);
  }
  for (const fixture of model.fixtures ?? []) rows.push(['Fixture', fixture.name]);
  const times = model.times;
  rows.push([
    'Time',
    `${duration(times?.total_s)} (${times?.planned ? times.machine || 'planned' : 'feeds only'})`,
  ]);
  return rows;
}

/** The lowest cut of each tool, mm. */
function deepest(program: Program): Map<number, number> {
  const lowest = new Map<number, number>();
  const { path } = program;
  const { tool, kind, endPoint, points } = path;
  for (let m = 0; m < program.motions; ++m) {
    if (kind[m] === 0) continue;
    for (let p = path.firstPoint(m); p < endPoint[m]!; ++p)
      lowest.set(tool[m]!, Math.min(lowest.get(tool[m]!) ?? Infinity, points[3 * p + 2]!));
  }
  return lowest;
}

function tools(program: Program, unit: Unit): string[][] {
  const lowest = deepest(program);
  return program.model.tools
    .filter((tool) => tool.number !== null || lowest.has(-1))
    .map((tool) => [
      tool.number === null ? UNKNOWN : `T${tool.number}`,
      tool.name ?? UNKNOWN,
      length(stickOut(tool), unit),
      length(tool.flute_length, unit),
      length(lowest.get(tool.number ?? -1), unit),
      duration(tool.time_s),
    ]);
}

/** How far the tool reaches out of its holder; null: the holder is not known. */
export function stickOut(tool: Tool): number | null {
  const holder = tool.profiles.find((profile) => profile.part === 'holder');
  return holder ? Math.min(...holder.points.map(([, z]) => z)) : null;
}
