// A small job, computed here: a block of 60 x 40 x 10 mm with two slots, in the protocol's form. Slot 1
// (lines 3 and 4) is at Y 10, slot 2 (line 6, called from line 7) at Y 28; a rapid at line 8 touches the
// block.
import type { Diagnostic, Model } from '../../src/protocol';
import { encodeMesh, encodePath, type RawMotion, type RawTile } from './encode';

export const HOSTILE = '<img src=x onerror="document.title=1"><script>document.title=2</script>';
const NX = 60;
const NY = 40;

export interface SampleOptions {
  revision?: number;
  /** mm below the top. */
  depth?: number;
  /** Steps done; slots after it are not cut. */
  steps?: number;
  errors?: Diagnostic[];
}

const LINES = [
  '(sample)',
  'T1 M6',
  'G0 X5 Y10 Z5',
  'G1 Z-4 F200',
  'G1 X55 F800',
  'G1 Y28 X5',
  'M98 P6',
  'G0 X58 Z-1',
  `(${HOSTILE})`,
  'M30',
];

function motions(depth: number): RawMotion[] {
  return [
    { step: 1, tool: 1, origin: 0, seconds: 1, kind: 0, points: [0, 0, 5, 5, 10, 5] },
    { step: 2, tool: 1, origin: 1, seconds: 3, feed: 200, points: [5, 10, 5, 5, 10, -depth] },
    { step: 3, tool: 1, origin: 2, seconds: 6, feed: 800, points: [5, 10, -depth, 55, 10, -depth] },
    {
      step: 4,
      tool: 1,
      origin: 3,
      seconds: 1,
      kind: 0,
      points: [55, 10, -depth, 55, 10, 5, 5, 28, 5, 5, 28, -depth],
    },
    { step: 6, tool: 2, origin: 5, seconds: 8, feed: 600, points: [5, 28, -depth, 55, 28, -depth] },
    { step: 7, tool: 2, origin: 6, seconds: 1, kind: 0, points: [55, 28, -depth, 58, 28, -1] },
  ];
}

const ORIGINS = [
  { file: 0, line: 3 },
  { file: 0, line: 4 },
  { file: 0, line: 5 },
  { file: 0, line: 6 },
  { file: 0, line: 7 },
  { file: 0, line: 6, caller: 4 },
  { file: 0, line: 8 },
];

/** The step that made the column at a cell, and its height. */
function column(i: number, j: number, depth: number, steps: number): [number, number] {
  const inSlot = (y: number) => i >= 3 && i < 57 && Math.abs(j + 0.5 - y) < 3;
  if (inSlot(10) && steps > 3) return [-depth, 3];
  if (inSlot(28) && steps > 6) return [-depth, 6];
  return [0, 0xffffffff];
}

/** One tile per ten columns in X: tops, and walls between columns of different heights. */
function tiles(depth: number, steps: number): RawTile[] {
  const found: RawTile[] = [];
  for (let first = 0; first < NX; first += 10) found.push(tile(first, depth, steps));
  return found;
}

function tile(first: number, depth: number, steps: number): RawTile {
  const out: RawTile = { id: first / 10, positions: [], index: [], step: [] };
  const quad = (step: number, ...p: number[]) => {
    const v = out.positions.length / 3;
    out.positions.push(...p);
    out.index.push(v, v + 1, v + 2, v, v + 2, v + 3);
    out.step.push(step, step);
  };
  const at = (i: number, j: number) =>
    i < 0 || j < 0 || i >= NX || j >= NY ? ([-10, 0xffffffff] as const) : column(i, j, depth, steps);
  for (let i = first; i < first + 10; ++i) {
    for (let j = 0; j < NY; ++j) {
      const [z, step] = at(i, j);
      quad(step, i, j, z, i + 1, j, z, i + 1, j + 1, z, i, j + 1, z);
      quad(0xffffffff, i, j, -10, i, j + 1, -10, i + 1, j + 1, -10, i + 1, j, -10);
      const wall = (n: readonly [number, number], ...xy: number[]) => {
        if (n[0] >= z) return;
        const [ax, ay, bx, by] = xy as [number, number, number, number];
        quad(n[1], ax, ay, n[0], bx, by, n[0], bx, by, z, ax, ay, z);
      };
      wall(at(i - 1, j), i, j + 1, i, j);
      wall(at(i + 1, j), i + 1, j, i + 1, j + 1);
      wall(at(i, j - 1), i, j, i + 1, j);
      wall(at(i, j + 1), i + 1, j + 1, i, j + 1);
    }
  }
  return out;
}

export function sampleMesh(options: SampleOptions = {}): ArrayBuffer {
  const steps = options.steps ?? 0xffffffff;
  const atStep = steps > 7 ? 0xffffffff : steps;
  return encodeMesh(options.revision ?? 1, tiles(options.depth ?? 4, steps), 0, atStep);
}

export function samplePath(options: SampleOptions = {}): ArrayBuffer {
  return encodePath(options.revision ?? 1, motions(options.depth ?? 4), ORIGINS);
}

export function sampleModel(options: SampleOptions = {}): Model {
  const errors = options.errors ?? [];
  return {
    protocol: 1,
    revision: options.revision ?? 1,
    state: errors.length ? 'failed' : 'ready',
    errors,
    name: 'sample.nc',
    source: 'sample.nc',
    front_end: 'G-code',
    kind: 'milling',
    units: 'mm',
    bounds: [
      [0, 0, -10],
      [60, 40, 0],
    ],
    stock: {
      block: [
        [0, 0, -10],
        [60, 40, 0],
      ],
      source: 'program',
      shape: 'block',
    },
    pitch: 1,
    steps: 8,
    motions: 6,
    tools: [
      {
        number: 1,
        name: HOSTILE,
        source: 'program',
        colour: [86, 180, 233],
        flute_length: 12,
        time_s: 11,
        removed_mm3: 1296,
        profiles: [
          {
            part: 'flute',
            points: [
              [0, 0],
              [3, 0],
              [3, 12],
            ],
          },
          {
            part: 'shank',
            points: [
              [3, 12],
              [3, 30],
            ],
          },
          {
            part: 'holder',
            points: [
              [10, 30],
              [10, 45],
              [0, 45],
            ],
          },
        ],
      },
      {
        number: 2,
        name: 'ball mill 6 mm',
        colour: [230, 159, 0],
        flute_length: null,
        time_s: 9,
        removed_mm3: 1296,
        profiles: [
          {
            part: 'flute',
            points: [
              [0, 0],
              [2, 1],
              [3, 3],
              [3, 15],
            ],
          },
        ],
      },
    ],
    stock_colour: [188, 170, 140],
    hazard_colour: [214, 32, 40],
    findings: [
      {
        kind: 'rapid_in_stock',
        at: [57, 28, -3],
        depth_mm: 3,
        removed_mm3: 12.5,
        step: 7,
        steps: 1,
        message: 'a rapid cuts the material',
        hint: 'Retract first.',
        origin: { file: 'sample.nc', line: 8, column: 1 },
      },
    ],
    diagnostics: [{ severity: 'note', message: HOSTILE, origin: { file: 'sample.nc', line: 9 } }],
    report: {},
    times: { total_s: 20, cutting_s: 17, rapid_s: 3, dwell_s: 0, planned: true, machine: '' },
    marks: [
      { step: 0, kind: 'tool', text: 'T1', tool: 1 },
      { step: 5, kind: 'tool', text: 'T2', tool: 2 },
    ],
    files: [{ path: 'sample.nc', text: LINES.join('\n'), complete: true }],
    tiles: { count: 6, level: 0 },
  };
}
