// What a page that has the viewer in a frame sends, and what it hears: docs/manual/viewer-embedding.md.
// Imports have endings, as these types are in the npm package, too.
import type { Diagnostic, Finding } from '../protocol.js';

/** The version of these messages: the member `kerf` of each. */
export const VERSION = 1;

export type FrameAction =
  | { do: 'hello' }
  | { do: 'load'; name: string; text: string }
  | { do: 'line'; line: number; file?: string }
  | { do: 'colour'; colour: string }
  | { do: 'play' }
  | { do: 'stop' };

/** A message to the viewer. `id` is that of its answer. */
export type FrameRequest = { kerf: typeof VERSION; id?: number | string } & FrameAction;

export interface FrameAnswer {
  kerf: typeof VERSION;
  /** Null: the message had none, or an invalid one. */
  id: number | string | null;
  ok: boolean;
  /** Of ok = false: what is wrong, and what was expected. */
  error?: string;
  expected?: string;
}

export type FrameEvent = { kerf: typeof VERSION } & (
  | {
      event: 'ready';
      name: string;
      revision: number;
      /** As in the events "line" and "finding". */
      files: string[];
      /** The colourings that apply. */
      colours: string[];
      /** The actions of this page. */
      actions: string[];
      findings: number;
    }
  | { event: 'line'; file: string; line: number }
  | { event: 'finding'; finding: Finding }
  | { event: 'errors'; diagnostics: Diagnostic[] }
);

/** A message that cannot be carried out. */
export interface Problem {
  error: string;
  expected: string;
}

const LONGEST_NAME = 100;
const LONGEST_TEXT = 64 << 20; // characters, as files that are dropped on the page
const HIGHEST_LINE = 2 ** 31;
const LONGEST_ID = 100;

interface Check {
  isValid(value: unknown): boolean;
  expected: string;
  isOptional?: boolean;
}

const text = (longest: number, expected: string, form = /^[^]/): Check => ({
  isValid: (v) => typeof v === 'string' && v.length <= longest && form.test(v),
  expected,
});
const SHAPES: Record<FrameAction['do'], Record<string, Check>> = {
  hello: {},
  load: {
    name: text(
      LONGEST_NAME,
      `name: a file name of 1 to ${LONGEST_NAME} characters without folders`,
      /^[^/\\]+$/,
    ),
    text: text(LONGEST_TEXT, 'text: the text of the program'),
  },
  line: {
    line: {
      isValid: (v) => Number.isInteger(v) && (v as number) >= 1 && (v as number) <= HIGHEST_LINE,
      expected: 'line: a whole number from 1',
    },
    file: { ...text(4096, 'file: the name of a file of the program'), isOptional: true },
  },
  colour: { colour: text(LONGEST_NAME, 'colour: the name of a colouring') },
  play: {},
  stop: {},
};
export const ACTIONS = Object.keys(SHAPES) as FrameAction['do'][];

/** The id of a message, be the rest as it may. */
export function idOf(data: unknown): number | string | null {
  const id = isObject(data) ? data.id : null;
  if (typeof id === 'number' && Number.isFinite(id)) return id;
  return typeof id === 'string' && id.length <= LONGEST_ID ? id : null;
}

/** The action of a message, or what is wrong with it. */
export function readRequest(data: unknown): FrameAction | Problem {
  const form = `an object {kerf: ${VERSION}, do: ${ACTIONS.map((name) => `"${name}"`).join(' | ')}, ...}`;
  if (!isObject(data)) return { error: 'the message is no object', expected: form };
  if (data.kerf !== VERSION) return { error: `its member kerf is not ${VERSION}`, expected: form };
  const known = ACTIONS.find((name) => name === data.do);
  if (!known) return { error: 'its member do names no action', expected: form };
  if (data.id !== undefined && idOf(data) === null)
    return {
      error: 'its id is invalid',
      expected: `id: a number, or a text of up to ${LONGEST_ID} characters`,
    };
  const shape = SHAPES[known];
  for (const [name, check] of Object.entries(shape)) {
    if (data[name] === undefined && check.isOptional) continue;
    if (check.isValid(data[name])) continue;
    const what = data[name] === undefined ? `${name} is missing` : `wrong ${name}`;
    return { error: `"${known}": ${what}`, expected: check.expected };
  }
  const other = Object.keys(data).find((name) => !['kerf', 'id', 'do'].includes(name) && !(name in shape));
  if (other !== undefined) {
    const members = Object.values(shape).map((check) => check.expected);
    return {
      error: `"${known}": unknown member ${other.slice(0, LONGEST_NAME)}`,
      expected: members.join('; ') || 'no further members',
    };
  }
  return data as unknown as FrameAction;
}

function isObject(value: unknown): value is Record<string, unknown> {
  return typeof value === 'object' && value !== null && !Array.isArray(value);
}
