// Messages of the page around a frame: what is carried out, and what the answer to a wrong one says.
import { describe, expect, test } from 'vitest';
import { isAllowed, originsIn } from '../../src/frame/frame';
import { idOf, readRequest } from '../../src/frame/messages';

const wrong: [unknown, RegExp, RegExp][] = [
  [null, /no object/, /\{kerf: 1, do: "hello" \|/],
  ['play', /no object/, /kerf: 1/],
  [[], /no object/, /kerf: 1/],
  [{ do: 'play' }, /kerf is not 1/, /kerf: 1/],
  [{ kerf: 2, do: 'play' }, /kerf is not 1/, /kerf: 1/],
  [{ kerf: 1 }, /names no action/, /"hello" \| "load" \| "line" \| "colour" \| "play" \| "stop"/],
  [{ kerf: 1, do: 'constructor' }, /names no action/, /"stop"/],
  [{ kerf: 1, do: 'play', id: {} }, /id is invalid/, /a number, or a text/],
  [{ kerf: 1, do: 'play', id: 'x'.repeat(101) }, /id is invalid/, /up to 100/],
  [{ kerf: 1, do: 'play', speed: 2 }, /unknown member speed/, /no further members/],
  [{ kerf: 1, do: 'line' }, /line is missing/, /a whole number from 1/],
  [{ kerf: 1, do: 'line', line: '3' }, /wrong line/, /a whole number from 1/],
  [{ kerf: 1, do: 'line', line: 0 }, /wrong line/, /a whole number from 1/],
  [{ kerf: 1, do: 'line', line: 1.5 }, /wrong line/, /a whole number from 1/],
  [{ kerf: 1, do: 'line', line: NaN }, /wrong line/, /a whole number from 1/],
  [{ kerf: 1, do: 'line', line: 1, file: 3 }, /wrong file/, /the name of a file/],
  [{ kerf: 1, do: 'colour', colour: 3 }, /wrong colour/, /name of a colouring/],
  [{ kerf: 1, do: 'load', name: 'a.nc' }, /text is missing/, /text of the program/],
  [{ kerf: 1, do: 'load', name: '../a.nc', text: '' }, /wrong name/, /without folders/],
  [{ kerf: 1, do: 'load', name: '', text: '' }, /wrong name/, /1 to 100/],
];

describe('messages', () => {
  test.each(wrong)('%j is wrong', (message, error, expected) => {
    const problem = readRequest(message) as { error: string; expected: string };
    expect(problem.error).toMatch(error);
    expect(problem.expected).toMatch(expected);
  });

  test.each([
    { kerf: 1, do: 'hello' },
    { kerf: 1, id: 7, do: 'line', line: 3 },
    { kerf: 1, id: 'a', do: 'line', line: 3, file: 'part.nc' },
    { kerf: 1, do: 'load', name: 'part.nc', text: 'G0 X1\n' },
    { kerf: 1, do: 'colour', colour: 'depth' },
    { kerf: 1, do: 'stop' },
  ])('%j is carried out', (message) => {
    expect(readRequest(message)).toEqual(message);
  });

  test('the id of a wrong message is that of its answer', () => {
    expect(idOf({ id: 'a', do: 3 })).toBe('a');
    for (const data of [null, 3, 'a', [], {}, { id: [] }, { id: NaN }]) expect(idOf(data)).toBeNull();
  });
});

describe('origins', () => {
  test('the own one, allowed ones, and files for files', () => {
    const page = 'https://shop.example/parts/part.html?x=1';
    expect(isAllowed('https://shop.example', page, [])).toBe(true);
    for (const other of ['https://shop.example:444', 'http://shop.example', 'https://other.example', 'null'])
      expect(isAllowed(other, page, [])).toBe(false);
    expect(isAllowed('https://other.example', page, ['https://other.example'])).toBe(true);
    expect(isAllowed('null', page, ['null'])).toBe(false);
    expect(isAllowed('null', 'file:///part.html', [])).toBe(true);
    expect(isAllowed('https://other.example', 'file:///part.html', [])).toBe(false);
    expect(isAllowed('null', 'about:srcdoc', [])).toBe(false);
  });

  test('a list has origins alone', () => {
    expect(originsIn(' https://a.example  http://localhost:3000 ')).toEqual([
      'https://a.example',
      'http://localhost:3000',
    ]);
    expect(originsIn("KERF_FRAMES * null https:// 'self' https://a/ https://A")).toEqual([]);
  });
});
