// Planned time, positions and source lines of a small job whose numbers are in tests/support/sample.ts.
import { describe, expect, test } from 'vitest';
import { decodePath } from '../../src/path';
import { locate, Program } from '../../src/program';
import { encodePath } from '../support/encode';
import { sampleModel, samplePath } from '../support/sample';

const program = new Program(sampleModel(), decodePath(samplePath()));

describe('planned time', () => {
  test('motions start where the one before ends', () => {
    expect(Array.from({ length: 7 }, (_, m) => program.startOf(m))).toEqual([0, 1, 4, 10, 11, 19, 20]);
    expect(program.totalTime).toBe(20);
  });

  test.each([
    [-1, 0],
    [0, 0],
    [0.99, 0],
    [1, 1],
    [9.5, 2],
    [19, 5],
    [20, 5],
    [1e9, 5],
  ])('at %d s motion %d', (time, motion) => {
    expect(program.motionAt(time)).toBe(motion);
  });

  test.each([
    [0, 0],
    [1, 0],
    [2, 1],
    [5, 4],
    [6, 4],
    [7, 5],
    [8, 6],
    [1000, 6],
  ])('step %d starts with motion %d', (step, motion) => {
    expect(program.motionOfStep(step)).toBe(motion);
  });

  test('many motions, some without time', () => {
    const isQuick = (k: number) => k % 7 === 0 || (k > 100 && k < 300);
    const seconds = Array.from({ length: 1000 }, (_, k) => (isQuick(k) ? 0 : 1 + (k % 3)));
    const raw = seconds.map((s, k) => ({ step: k, seconds: s, points: [k, 0, 0, k + 1, 0, 0] }));
    const many = new Program(sampleModel(), decodePath(encodePath(1, raw, [])));
    let start = 0;
    const starts = seconds.map((s) => (start += s) - s);
    expect(starts.map((_, m) => many.startOf(m))).toEqual(starts);
    expect(many.totalTime).toBe(start);
    for (let time = 0; time < start; time += 0.5)
      expect(many.motionAt(time)).toBe(starts.filter((s) => s <= time).length - 1);
  });

  test('a job without motions', () => {
    const empty = new Program({ ...sampleModel(), motions: 0 }, decodePath(encodePath(1, [], [])));
    expect(empty.motionAt(3)).toBe(-1);
    expect(empty.totalTime).toBe(0);
    expect(empty.tipAt(0)).toBeNull();
    expect(empty.motionOfStep(0)).toBe(0);
  });
});

describe('positions', () => {
  test('along a line', () => expect(program.tipAt(7)).toEqual([30, 10, -4]));
  test('along several lines, by their length', () => {
    // 9 up, then 53.14 across, then 9 down: the midpoint is half way across.
    const [x, y, z] = program.tipAt(10.5)!;
    expect(x).toBeCloseTo(30);
    expect(y).toBeCloseTo(19);
    expect(z).toBe(5);
  });
  test('after the end', () => expect(program.tipAt(99)).toEqual([58, 28, -1]));

  test('unknown until the first known position, then the last known one', () => {
    const path = decodePath(
      encodePath(
        1,
        [
          { step: 0, points: [] },
          { step: 1, points: [1, 2, 3, 4, 5, 6] },
          { step: 2, points: [] },
        ],
        [],
      ),
    );
    const unknown = new Program(sampleModel(), path);
    expect(unknown.tipAt(0.5)).toBeNull();
    expect(unknown.tipAt(2.5)).toEqual([4, 5, 6]);
  });
});

describe('source lines', () => {
  test('chain of calls, innermost first', () => {
    expect(program.chainOfStep(6)).toEqual([
      { file: 0, line: 6 },
      { file: 0, line: 7 },
    ]);
    expect(program.chainOfStep(2)).toEqual([{ file: 0, line: 4 }]);
    expect(program.chainOfStep(5)).toEqual([]);
    expect(program.chainOfStep(0xffffffff)).toEqual([]);
  });

  test('motions of a line, and those that it calls', () => {
    expect([...program.path.motionsOf({ file: 0, line: 6 })]).toEqual([3, 4]);
    expect([...program.path.motionsOf({ file: 0, line: 7 })]).toEqual([4]);
    expect([...program.path.motionsOf({ file: 0, line: 1 })]).toEqual([]);
    expect([...program.path.motionsOf({ file: 1, line: 6 })]).toEqual([]);
  });

  test('the location that a diagnostic names', () => {
    expect(locate(program.model.files, { file: 'sample.nc', line: 8 })).toEqual({ file: 0, line: 8 });
    expect(locate(program.model.files, { file: 'other.nc', line: 8 })).toBeNull();
    expect(locate(program.model.files, { file: 'sample.nc' })).toBeNull();
    expect(locate(program.model.files, null)).toBeNull();
  });
});
