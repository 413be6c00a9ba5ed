// A program as the page uses it: motions in planned time, and which source lines they come from.
import { type BurnAnswer, NONE, type PathAnswer } from './decode';
import type { Change } from './view3d/change';
import type { Model, SourceFile, Vec3 } from './protocol';

export const RAPID = 0;
export const EXTRUDE = 4;

/** A line of a source file; `file` is an index into Model.files, `line` counts from 1. */
export interface Location {
  file: number;
  line: number;
}

export class Program {
  /** Seconds from the start of the job to the start of each motion, and to the end of the last. */
  readonly startTime: Float64Array;
  /** Whether the part before the last save is known, and what has changed since; null: not compared. */
  hasEarlier = false;
  change: Change | null = null;
  /** Null: not loaded. */
  burn: BurnAnswer | null = null;

  constructor(
    readonly model: Model,
    readonly path: PathAnswer,
  ) {
    this.startTime = new Float64Array(path.motions + 1);
    for (let m = 0; m < path.motions; ++m) this.startTime[m + 1] = this.startTime[m]! + path.seconds[m]!;
  }

  get motions(): number {
    return this.path.motions;
  }

  get totalTime(): number {
    return this.startTime[this.motions]!;
  }

  /** The motion that runs at `time`, clamped to the job; -1 if there are no motions. */
  motionAt(time: number): number {
    if (this.motions === 0) return -1;
    return Math.min(lastNotAbove(this.startTime, Math.max(time, 0)), this.motions - 1);
  }

  /** The first motion of step `step` or of one after it; the number of motions if there is none. */
  motionOfStep(step: number): number {
    let low = 0;
    let high = this.motions;
    while (low < high) {
      const mid = (low + high) >> 1;
      if (this.path.step[mid]! < step) low = mid + 1;
      else high = mid;
    }
    return low;
  }

  /** How many seconds after the start step `step` starts. */
  timeOfStep(step: number): number {
    return this.startTime[this.motionOfStep(step)]!;
  }

  /** The tip of the tool at `time`, and null before the first known position. */
  tipAt(time: number): Vec3 | null {
    const m = this.motionAt(time);
    if (m < 0) return null;
    const seconds = this.path.seconds[m]!;
    const fraction = seconds > 0 ? Math.min((time - this.startTime[m]!) / seconds, 1) : 1;
    return this.pointOn(m, fraction) ?? this.lastPointBefore(m);
  }

  /** The point at a fraction of the length of motion `m`; null if its positions are unknown. */
  pointOn(m: number, fraction: number): Vec3 | null {
    const { points, firstPoint } = this.path;
    const first = firstPoint[m]!;
    const last = firstPoint[m + 1]! - 1;
    if (last < first) return null;
    let length = 0;
    for (let p = first; p < last; ++p) length += distance(points, p, p + 1);
    let left = length * Math.min(Math.max(fraction, 0), 1);
    for (let p = first; p < last; ++p) {
      const d = distance(points, p, p + 1);
      if (left <= d && d > 0) return between(points, p, p + 1, left / d);
      left -= d;
    }
    return between(points, last, last, 0);
  }

  private lastPointBefore(m: number): Vec3 | null {
    const last = this.path.firstPoint[m]! - 1;
    return last < 0 ? null : between(this.path.points, last, last, 0);
  }

  /** The location of an origin and those of the calls that led there, innermost first. */
  chain(origin: number): Location[] {
    const found: Location[] = [];
    const { originFile, originLine, originCaller } = this.path;
    // A chain cannot be longer than the list; a damaged one that runs in a ring ends there.
    for (let o = origin, left = originFile.length; o !== NONE && left > 0; o = originCaller[o]!, --left) {
      if (originFile[o]! !== NONE) found.push({ file: originFile[o]!, line: originLine[o]! });
    }
    return found;
  }

  /** The chain of calls of the step that made a surface; empty for the stock's own faces. */
  chainOfStep(step: number): Location[] {
    const m = this.motionOfStep(step);
    if (m >= this.motions || this.path.step[m] !== step) return [];
    return this.chain(this.path.origin[m]!);
  }

  /** The motions that a line makes, itself or by calls. */
  motionsOf(where: Location): Uint32Array {
    const wanted = this.originsBelow(where);
    const { origin } = this.path;
    let count = 0;
    for (const o of origin) count += o !== NONE ? wanted[o]! : 0;
    const found = new Uint32Array(count);
    for (let m = 0, i = 0; m < this.motions; ++m) {
      const o = origin[m]!;
      if (o !== NONE && wanted[o]!) found[i++] = m;
    }
    return found;
  }

  /** 1 for each origin that is `where` or was called from it. */
  private originsBelow(where: Location): Uint8Array {
    const { originFile, originLine, originCaller } = this.path;
    const count = originFile.length;
    const known = new Uint8Array(count); // 1: the answer of this origin is final
    const wanted = new Uint8Array(count);
    for (let first = 0; first < count; ++first) {
      const walked: number[] = [];
      let answer = 0;
      for (let o = first; o !== NONE; o = originCaller[o]!) {
        if (known[o]) {
          answer = wanted[o]!;
          break;
        }
        known[o] = 1; // also ends a ring
        walked.push(o);
        if (originFile[o] === where.file && originLine[o] === where.line) {
          answer = 1;
          break;
        }
      }
      for (const o of walked) wanted[o] = answer;
    }
    return wanted;
  }
}

/** The location of a diagnostic in these files. */
export function locate(
  files: readonly SourceFile[],
  origin: { file?: string | null; line?: number | null } | null | undefined,
): Location | null {
  if (!origin?.file || !origin.line) return null;
  const file = fileIndex(files, origin.file);
  return file < 0 ? null : { file, line: origin.line };
}

export function fileIndex(files: readonly SourceFile[], path: string): number {
  return files.findIndex((f) => f.path === path);
}

function distance(points: Float32Array, a: number, b: number): number {
  return Math.hypot(
    points[3 * b]! - points[3 * a]!,
    points[3 * b + 1]! - points[3 * a + 1]!,
    points[3 * b + 2]! - points[3 * a + 2]!,
  );
}

function between(points: Float32Array, a: number, b: number, t: number): Vec3 {
  const at = (k: number) => points[3 * a + k]! + t * (points[3 * b + k]! - points[3 * a + k]!);
  return [at(0), at(1), at(2)];
}

/** The last index whose value is not above `value`; the values increase. */
function lastNotAbove(values: Float64Array, value: number): number {
  let low = 0;
  let high = values.length - 1;
  while (low < high) {
    const mid = (low + high + 1) >> 1;
    if (values[mid]! <= value) low = mid;
    else high = mid - 1;
  }
  return low;
}
