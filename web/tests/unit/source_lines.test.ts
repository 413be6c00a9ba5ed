// Lines of large texts: each is that of the block in which it is, and few blocks are kept.
import { expect, test, vi } from 'vitest';
import { BlockLines, linesOf } from '../../src/ui/source_lines';

/** Blocks of ten lines "id:line". */
function text(blocks: number, idOfFirst = 1) {
  const table = Array.from({ length: blocks }, (_, b): [number, number] => [idOfFirst + b, 10]);
  const blockOf = vi.fn((id: number) =>
    Promise.resolve(Array.from({ length: 10 }, (_, k) => `${id}:${k}\r\n`).join('')),
  );
  return { table, blockOf };
}

const settled = () => new Promise((done) => setTimeout(done));

test('a line is there once its block has arrived', async () => {
  const { table, blockOf } = text(5);
  const changed = vi.fn();
  const file = { path: 'a.nc', text: null, complete: true, blocks: table };
  const lines = linesOf(file, blockOf, changed);
  expect(lines.count).toBe(50);
  expect(lines.line(23)).toBeNull();
  expect(lines.line(24)).toBeNull();
  await settled();
  expect(changed).toHaveBeenCalledOnce();
  expect([20, 23, 29].map((k) => lines.line(k))).toEqual(['3:0', '3:3', '3:9']);
  expect(blockOf.mock.calls).toEqual([[3]]);
});

test('blocks that are shown again after an edit are not asked for again', async () => {
  const { table, blockOf } = text(5);
  const before = new BlockLines(table, blockOf, () => {});
  before.line(0);
  before.line(10);
  await settled();
  const after = new BlockLines([[9, 12], ...table.slice(1)], blockOf, () => {});
  after.takeFrom(before);
  expect(after.count).toBe(52);
  expect(after.line(12)).toBe('2:0');
  expect(after.line(0)).toBeNull();
  expect(blockOf.mock.calls).toEqual([[1], [2], [9]]);
});

test('few blocks are kept, and one that could not be read is asked for again', async () => {
  const { table, blockOf } = text(100);
  const lines = new BlockLines(table, blockOf, () => {});
  for (let k = 0; k < 1000; k += 10) {
    lines.line(k);
    await settled();
  }
  expect(lines.line(990)).toBe('100:0');
  expect(lines.line(0)).toBeNull();
  blockOf.mockRejectedValueOnce(new Error('no block'));
  lines.line(500);
  await settled();
  expect(lines.line(500)).toBeNull();
  await settled();
  expect(lines.line(500)).toBe('51:0');
});

test('whole texts', () => {
  const of = (content: string | null, complete = true) => {
    const lines = linesOf({ path: 'a', text: content, complete }, undefined, () => {});
    return Array.from({ length: lines.count }, (_, k) => lines.line(k));
  };
  expect(of('a\r\nb\rc\n')).toEqual(['a', 'b', 'c', '']);
  expect(of(null)).toEqual(['(not a text file)']);
  expect(of('a', false)).toEqual(['a', '(the rest of this file is not shown)']);
});
