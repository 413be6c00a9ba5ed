// A program as the page uses it: motions in planned time, and which source lines they come from.
import type { Change } from './change';
import type { BurnAnswer } from './decode';
import type { Path } from './path';
import type { Model, SourceFile, Vec3 } from './protocol';

export const RAPID = 0;
export const EXTRUDE = 4;
const EVERY = 64; // motions

/** A line of a source file; `file` is an index into Model.files, `line` counts from 1. */
export interface Location {
  file: number;
  line: number;
}

export class Program {
  /** Seconds from the start of the job to the start of every motion of EVERY, and to the end of the last. */
  private readonly times: Float64Array;
  /** Whether the part before the last save is known, and what has changed since; null: not compared. */
  hasEarlier = false;
  change: Change | null = null;
  /** Null: not loaded. */
  burn: BurnAnswer | null = null;

  constructor(
    readonly model: Model,
    readonly path: Path,
  ) {
    this.times = new Float64Array(Math.ceil(path.motions / EVERY) + 1);
    let time = 0;
    for (let m = 0; m < path.motions; ++m) {
      if (m % EVERY === 0) this.times[m / EVERY] = time;
      time += path.seconds[m]!;
    }
    this.times[this.times.length - 1] = time;
  }

  get motions(): number {
    return this.path.motions;
  }

  get totalTime(): number {
    return this.times[this.times.length - 1]!;
  }

  /** Seconds from the start of the job to the start of a motion, to the end of the job after the last. */
  startOf(motion: number): number {
    if (motion >= this.motions) return this.totalTime;
    let time = this.times[Math.floor(motion / EVERY)]!;
    for (let m = motion - (motion % EVERY); m < motion; ++m) time += this.path.seconds[m]!;
    return time;
  }

  /** The motion that runs at `time`, clamped to the job; -1 if there are no motions. */
  motionAt(time: number): number {
    if (this.motions === 0) return -1;
    const wanted = Math.max(time, 0);
    const row = Math.min(lastNotAbove(this.times, wanted), this.times.length - 2);
    let start = this.times[row]!;
    let m = row * EVERY;
    const end = Math.min(m + EVERY, this.motions) - 1;
    for (; m < end && start + this.path.seconds[m]! <= wanted; ++m) start += this.path.seconds[m]!;
    return m;
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
    return this.startOf(this.motionOfStep(step));
  }

  /** The tip of the tool at `time`, and null before the first known position. */
  tipAt(time: number): Vec3 | null {
    const m = this.motionAt(time);
    if (m < 0) return null;
    const seconds = this.path.seconds[m]!;
    const fraction = seconds > 0 ? Math.min((time - this.startOf(m)) / seconds, 1) : 1;
    return this.pointOn(m, fraction) ?? this.lastPointBefore(m);
  }

  /** The point at a fraction of the length of motion `m`; null if its positions are unknown. */
  pointOn(m: number, fraction: number): Vec3 | null {
    const { points } = this.path;
    const first = this.path.firstPoint(m);
    const last = this.path.endPoint[m]! - 1;
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
    const last = this.path.ownPoint(m) - 1;
    return last < 0 ? null : between(this.path.points, last, last, 0);
  }

  /** The chain of calls of the step that made a surface; empty for the stock's own faces. */
  chainOfStep(step: number): Location[] {
    const m = this.motionOfStep(step);
    if (m >= this.motions || this.path.step[m] !== step) return [];
    return this.path.chain(m);
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
