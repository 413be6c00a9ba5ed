// The motions of a toolpath. They come in blocks; those that an edit has not changed are taken from the path
// before it. Every number is here once, in the smallest type that holds all of its kind.
import { checkFinite, DecodeError, NONE, Reader } from './decode';
import type { Location } from './program';

const JOINED = 8; // of the kind: the motion starts at the last point before its own
const ENTRY = 7; // numbers of a block in the table
const LARGEST = 100_000; // motions, points or origins of a block

type Small = Int8Array | Int16Array | Int32Array;

/** Whole numbers, of which rows with the same distance take no memory. */
class Series {
  constructor(
    private readonly first: number,
    private readonly by: number,
    private readonly values: Int16Array | Int32Array | null,
  ) {}

  at(index: number): number {
    return this.values ? this.values[index]! : this.first + this.by * index;
  }

  static of(values: Int32Array): Series {
    const first = values[0] ?? 0;
    const by = values.length > 1 ? values[1]! - first : 0;
    if (values.every((v, i) => v === first + by * i)) return new Series(first, by, null);
    return new Series(0, 0, values.every((v) => v === (v << 16) >> 16) ? Int16Array.from(values) : values);
  }
}

/** The locations in the sources from which the motions of a block come. */
interface Origins {
  count: number;
  /** That of each motion. */
  ofMotion: Series;
  /** The file of each group; NONE: none. */
  files: Uint32Array;
  group: Series;
  /** Counted from the first one of the group. */
  line: Series;
  /** The number of the call that led here, + 1; 0: none. */
  caller: Series;
}

/** What a block has wherever it is in the program. */
interface Content {
  id: number;
  origins: Origins;
  hasFlow: boolean;
  hasPower: boolean;
  hasBeads: boolean;
}

interface Block {
  content: Content;
  motions: number;
  points: number;
  firstMotion: number;
  firstPoint: number;
  firstStep: number;
  /** Of each group of origins. */
  lines: Uint32Array;
}

export class Path {
  readonly step: Uint32Array;
  /** The index behind the last point of each motion. */
  readonly endPoint: Uint32Array;
  /** 1: the motion starts at the last point before its own. */
  readonly isJoined: Uint8Array;
  /** -1: none yet. */
  tool: Small;
  readonly seconds: Float32Array;
  readonly feed: Float32Array;
  readonly points: Float32Array;
  readonly kind: Uint8Array;
  /** mm3/s of beads, 0 for other motions; null: no beads. */
  flow: Float32Array | null = null;
  /** S of the beam of a laser, 0 where it is off; null: no laser. */
  power: Float32Array | null = null;
  /** What beads are part of, as numbers of Model.bead_kinds; null: not known. */
  bead: Uint8Array | null = null;
  readonly blocks: Block[] = [];

  constructor(
    readonly revision: number,
    readonly motions: number,
    points: number,
  ) {
    this.step = new Uint32Array(motions);
    this.endPoint = new Uint32Array(motions);
    this.isJoined = new Uint8Array(motions);
    this.tool = new Int32Array(motions);
    this.seconds = new Float32Array(motions);
    this.feed = new Float32Array(motions);
    this.points = new Float32Array(3 * points);
    this.kind = new Uint8Array(motions);
  }

  /** The index of the first of the points that belong to a motion alone. */
  ownPoint(motion: number): number {
    return motion > 0 ? this.endPoint[motion - 1]! : 0;
  }

  /** The index of a motion's start; that of the end if its position is unknown. */
  firstPoint(motion: number): number {
    return this.ownPoint(motion) - this.isJoined[motion]!;
  }

  /** The last motion that has a point not after this one. */
  motionOfPoint(point: number): number {
    let low = 0;
    let high = this.motions - 1;
    while (low < high) {
      const mid = (low + high) >> 1;
      if (this.endPoint[mid]! <= point) low = mid + 1;
      else high = mid;
    }
    return low;
  }

  /** Where a motion comes from, and the calls that led there, innermost first. */
  chain(motion: number): Location[] {
    const block = this.blockOf(motion);
    const found: Location[] = [];
    if (!block) return found;
    const { ofMotion, files, group, line, caller } = block.content.origins;
    for (let o = ofMotion.at(motion - block.firstMotion) + 1; o > 0; o = caller.at(o - 1)) {
      const g = group.at(o - 1);
      const at = block.lines[g]! + line.at(o - 1);
      // Line 0: a point of a drawing, which has no lines.
      if (files[g]! !== NONE && at > 0) found.push({ file: files[g]!, line: at });
    }
    return found;
  }

  private blockOf(motion: number): Block | undefined {
    let low = 0;
    let high = this.blocks.length - 1;
    while (low < high) {
      const mid = (low + high + 1) >> 1;
      if (this.blocks[mid]!.firstMotion <= motion) low = mid;
      else high = mid - 1;
    }
    return this.blocks[low];
  }

  /** The motions that a line makes, itself or by calls. */
  motionsOf(where: Location): Uint32Array {
    const found: number[] = [];
    for (const block of this.blocks) {
      const { count, ofMotion, files, group, line, caller } = block.content.origins;
      if (!files.includes(where.file)) continue;
      const wanted = new Uint8Array(count + 1); // a call is before what it calls
      for (let o = 0; o < count; ++o) {
        const g = group.at(o);
        const isHere = files[g] === where.file && block.lines[g]! + line.at(o) === where.line;
        wanted[o + 1] = isHere ? 1 : wanted[caller.at(o)]!;
      }
      for (let k = 0; k < block.motions; ++k)
        if (wanted[ofMotion.at(k) + 1]) found.push(block.firstMotion + k);
    }
    return Uint32Array.from(found);
  }
}

/** What is missing in an answer for a page without the path before. */
export class MissingBlock extends DecodeError {}

/** `before`: the path of which unchanged blocks are taken. */
export function decodePath(buffer: ArrayBuffer, before: Path | null = null): Path {
  const read = new Reader(buffer, 'toolpath');
  read.magic('KPTH', 2);
  const [revision, motions, points, count, groups] = read.u32s(6) as unknown as [
    number, number, number, number, number,
  ];
  const table = read.u32s(ENTRY * count);
  const lines = read.u32s(groups);
  checkTable(table, motions, points, groups);
  const path = new Path(revision, motions, points);
  const known = new Map<number, [Path, Block]>();
  for (const block of before?.blocks ?? []) known.set(block.content.id, [before!, block]);
  let firstMotion = 0;
  let firstPoint = 0;
  let firstLine = 0;
  for (let b = 0; b < count; ++b) {
    const [id, blockMotions, blockPoints, origins, blockGroups, firstStep, size] = table.subarray(
      ENTRY * b,
    ) as unknown as [number, number, number, number, number, number, number];
    const where = {
      motions: blockMotions,
      points: blockPoints,
      firstMotion,
      firstPoint,
      firstStep,
      lines: lines.slice(firstLine, firstLine + blockGroups),
    };
    const own = size > 0 ? undefined : known.get(id);
    const content = own
      ? copyBlock(path, where, ...own)
      : readBlock(path, where, id, origins, new Reader(read.bytes(size), 'toolpath'), size);
    const block = { ...where, content };
    path.blocks.push(block);
    known.set(id, [path, block]);
    firstMotion += blockMotions;
    firstPoint += blockPoints;
    firstLine += blockGroups;
  }
  read.finish();
  for (let m = 1; m < motions; ++m)
    if (path.step[m]! < path.step[m - 1]!)
      throw new DecodeError('The steps of the toolpath are not in order');
  path.tool = smallest(path.tool);
  return path;
}

function checkTable(table: Uint32Array, motions: number, points: number, groups: number): void {
  const sums = [0, 0, 0];
  for (let at = 0; at < table.length; at += ENTRY) {
    if (table[at + 1] === 0 || table.subarray(at + 1, at + 4).some((count) => count > LARGEST))
      throw new DecodeError('The toolpath has a block of a wrong size');
    [1, 2, 4].forEach((field, k) => (sums[k]! += table[at + field]!));
  }
  if (sums[0] !== motions || sums[1] !== points || sums[2] !== groups)
    throw new DecodeError('The blocks of the toolpath have other counts than the whole');
}

type Where = Omit<Block, 'content'>;

/** A block that the page has, at its new location. */
function copyBlock(path: Path, where: Where, from: Path, block: Block): Content {
  const { content } = block;
  const { origins } = content;
  if (block.motions !== where.motions || block.points !== where.points)
    throw new DecodeError('A block of the toolpath has changed');
  if (origins.files.length !== where.lines.length) throw new DecodeError('A block has other groups of lines');
  const first = block.firstMotion;
  const end = first + block.motions;
  const to = where.firstMotion;
  type Numbers = Float32Array | Uint8Array | Small;
  const copy = (target: Numbers, source: Numbers) => target.set(source.subarray(first, end), to);
  for (let m = first; m < end; ++m) {
    path.step[to + m - first] = from.step[m]! - block.firstStep + where.firstStep;
    path.endPoint[to + m - first] = from.endPoint[m]! - block.firstPoint + where.firstPoint;
  }
  copy(path.isJoined, from.isJoined);
  copy(path.tool, from.tool);
  copy(path.seconds, from.seconds);
  copy(path.feed, from.feed);
  copy(path.kind, from.kind);
  if (content.hasFlow) copy((path.flow ??= new Float32Array(path.motions)), from.flow!);
  if (content.hasPower) copy((path.power ??= new Float32Array(path.motions)), from.power!);
  if (content.hasBeads) copy((path.bead ??= new Uint8Array(path.motions)), from.bead!);
  path.points.set(
    from.points.subarray(3 * block.firstPoint, 3 * (block.firstPoint + block.points)),
    3 * where.firstPoint,
  );
  return content;
}

function readBlock(
  path: Path,
  where: Where,
  id: number,
  origins: number,
  read: Reader,
  size: number,
): Content {
  if (size === 0) throw new MissingBlock('The toolpath names a block that the page does not have');
  const { motions, firstMotion: first } = where;
  const end = first + motions;
  const steps = read.column(motions);
  const counts = read.column(motions);
  const kinds = read.column(motions);
  const tools = read.column(motions);
  const numbers = differences(read.column(motions), -1);
  let point = where.firstPoint;
  for (let k = 0; k < motions; ++k) {
    const m = first + k;
    path.step[m] = where.firstStep + k + steps[k]!;
    path.isJoined[m] = kinds[k]! & JOINED ? 1 : 0;
    path.kind[m] = kinds[k]! & ~JOINED;
    if (path.isJoined[m] && point === where.firstPoint)
      throw new DecodeError('A motion starts at a point that its block does not have');
    point += counts[k]!;
    if (point > where.firstPoint + where.points) throw new DecodeError('A block has too few points');
    path.endPoint[m] = point;
    path.tool[m] = tools[k]! - 1;
    if (!(numbers[k]! >= 0 && numbers[k]! < origins))
      throw new DecodeError('The toolpath names an unknown origin');
  }
  if (point !== where.firstPoint + where.points) throw new DecodeError('A block has too many points');
  path.seconds.set(floats(read.column(motions)), first);
  path.feed.set(floats(read.column(motions)), first);
  for (let m = first; m < end; ++m)
    if (!(path.seconds[m]! >= 0)) throw new DecodeError('A motion of the toolpath has no valid time');
  const flow = floats(read.column(motions));
  const power = floats(read.column(motions));
  const bead = read.column(motions);
  checkFinite(flow, 'toolpath');
  checkFinite(power, 'toolpath');
  const hasFlow = flow.some((f) => f !== 0);
  const hasPower = power.some((s) => s !== 0);
  const hasBeads = bead.some((kind) => kind !== 0);
  if (hasFlow) (path.flow ??= new Float32Array(path.motions)).set(flow, first);
  if (hasPower) (path.power ??= new Float32Array(path.motions)).set(power, first);
  if (hasBeads) (path.bead ??= new Uint8Array(path.motions)).set(bead, first);
  const found = readOrigins(read, origins, where.lines.length, Series.of(numbers));
  const points = read.f32s(3 * where.points);
  checkFinite(points, 'toolpath');
  path.points.set(points, 3 * where.firstPoint);
  read.finish();
  return { id, origins: found, hasFlow, hasPower, hasBeads };
}

function readOrigins(read: Reader, count: number, groups: number, ofMotion: Series): Origins {
  const files = read.u32s(groups).slice();
  const group = Int32Array.from(read.column(count));
  const line = read.column(count);
  const caller = Int32Array.from(read.column(count));
  const last = new Int32Array(groups).fill(-1);
  const lines = new Int32Array(count);
  for (let o = 0; o < count; ++o) {
    const g = group[o]!;
    if (!(g >= 0 && g < groups)) throw new DecodeError('The toolpath names an unknown file');
    if (!(caller[o]! >= 0 && caller[o]! <= o)) throw new DecodeError('The toolpath names an unknown caller');
    last[g] = last[g]! + signed(line[o]!);
    lines[o] = last[g]!;
  }
  return {
    count,
    ofMotion,
    files,
    group: Series.of(group),
    line: Series.of(lines),
    caller: Series.of(caller),
  };
}

/** A small number of either sign: 0, -1, 1, -2, ... */
function signed(value: number): number {
  return (value >>> 1) ^ -(value & 1);
}

/** The sums of differences. */
function differences(values: Uint32Array, before: number): Int32Array {
  const out = new Int32Array(values.length);
  let last = before;
  for (let i = 0; i < values.length; ++i) out[i] = last = last + signed(values[i]!);
  return out;
}

function floats(values: Uint32Array): Float32Array {
  return new Float32Array(values.buffer, values.byteOffset, values.length);
}

function smallest(values: Small): Small {
  if (values.every((v) => v === (v << 24) >> 24)) return Int8Array.from(values);
  return values.every((v) => v === (v << 16) >> 16) ? Int16Array.from(values) : values;
}
