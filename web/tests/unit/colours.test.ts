// Which colour a step, a triangle and a depth get.
import { describe, expect, test } from 'vitest';
import { operationStarts, Palette, ramp } from '../../src/colours';
import { decodeMesh, NO_STEP } from '../../src/decode';
import { decodePath } from '../../src/path';
import { Program } from '../../src/program';
import { sampleMesh, sampleModel, samplePath } from '../support/sample';

const program = new Program(sampleModel(), decodePath(samplePath()));
const BLUE = [86, 180, 233];
const ORANGE = [230, 159, 0];
const RED = [214, 32, 40];

test('by tool, with hazards and the stock', () => {
  const palette = new Palette(program, 'tool');
  expect(palette.ofStep(3)).toEqual(BLUE);
  expect(palette.ofStep(6)).toEqual(ORANGE);
  expect(palette.ofStep(7)).toEqual(RED);
  expect(palette.ofStep(NO_STEP)).toEqual([188, 170, 140]);
  expect(palette.ofStep(5000)).toEqual([188, 170, 140]);
});

test('the selection is marked in every mode', () => {
  for (const mode of ['tool', 'depth', 'operation', 'step', 'speed', 'layer'] as const) {
    const palette = new Palette(program, mode, Uint32Array.of(2));
    expect(palette.isMarked(3)).toBe(true);
    expect(palette.isMarked(6)).toBe(false);
    expect(palette.ofStep(3)).not.toEqual(new Palette(program, mode).ofStep(3));
  }
});

test('by depth, each corner by its own height', () => {
  const tile = decodeMesh(sampleMesh()).tiles[2]!;
  const palette = new Palette(program, 'depth');
  const colours = palette.paint(tile);
  expect(colours.length).toBe(12 * tile.step.length);
  for (let t = 0; t < tile.step.length; ++t) {
    const z = tile.positions[3 * tile.index[3 * t]! + 2]!;
    expect([...colours.slice(12 * t, 12 * t + 3)]).toEqual(ramp((z + 10) / 10));
  }
});

test('operations start at notes, else at tool changes', () => {
  expect(operationStarts(program)).toEqual([0, 5]);
  const noted = {
    ...program.model,
    marks: [...program.model.marks, { step: 2, kind: 'note', text: 'slot' }],
  };
  expect(operationStarts(new Program(noted, program.path))).toEqual([2]);
  const palette = new Palette(program, 'operation');
  expect(palette.ofStep(3)).toEqual(palette.ofStep(1));
  expect(palette.ofStep(6)).not.toEqual(palette.ofStep(3));
});

describe('ramp', () => {
  test('ends and what is outside', () => {
    expect(ramp(-1)).toEqual(ramp(0));
    expect(ramp(2)).toEqual(ramp(1));
    expect(ramp(NaN)).toEqual(ramp(0));
    expect(ramp(1)).toEqual([253, 231, 37]);
  });
  test('gets lighter', () => {
    const lightness = (t: number) => ramp(t).reduce((sum, c, i) => sum + c * [0.3, 0.6, 0.1][i]!, 0);
    for (let i = 0; i < 20; ++i) expect(lightness((i + 1) / 20)).toBeGreaterThan(lightness(i / 20));
  });
});
