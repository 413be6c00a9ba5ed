// Numbers as text: both units, unknown values, rounding.
import { describe, expect, test } from 'vitest';
import { duration, feed, length, lengthNumber, UNKNOWN, volume } from '../../src/format';

test.each([
  [25.4, 'mm', '25.400 mm'],
  [25.4, 'inch', '1.0000 in'],
  [-0.0001, 'mm', '0.000 mm'],
  [3.175, 'inch', '0.1250 in'],
  [null, 'mm', UNKNOWN],
  [undefined, 'inch', UNKNOWN],
  [NaN, 'mm', UNKNOWN],
  [Infinity, 'mm', UNKNOWN],
] as const)('length %s in %s', (mm, unit, text) => expect(length(mm, unit)).toBe(text));

test('a number without unit', () => expect(lengthNumber(-12.7, 'inch')).toBe('-0.5000'));

describe('duration', () => {
  test.each([
    [0, 0, '0:00'],
    [59.4, 0, '0:59'],
    [59.6, 0, '1:00'],
    [3599.6, 0, '1:00:00'],
    [3725, 0, '1:02:05'],
    [5.25, 1, '0:05.3'],
    [59.97, 1, '1:00.0'],
    [-3, 0, '0:00'],
    [null, 0, UNKNOWN],
  ] as const)('%s s with %d decimals', (seconds, decimals, text) =>
    expect(duration(seconds, decimals)).toBe(text),
  );
});

test('feeds and volumes', () => {
  expect(feed(1000, 'mm')).toBe('1000 mm/min');
  expect(feed(1270, 'inch')).toBe('50.0 in/min');
  expect(volume(16387.064, 'inch')).toBe('1.0000 in³');
  expect(volume(undefined, 'mm')).toBe(UNKNOWN);
});
