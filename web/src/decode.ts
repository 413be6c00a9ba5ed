// Reads the binary answers of the server: tiles of the part's surface, and maps. path.ts reads the toolpath.
// Every count is compared with the bytes that are there before anything is allocated, so that a damaged
// answer gives a DecodeError and never an endless loop, a huge array or an index outside its array.

export const NO_STEP = 0xffffffff;
export const FINAL = 0xffffffff;
export const NONE = 0xffffffff;

export class DecodeError extends Error {}

export interface Surface {
  positions: Float32Array;
  index: Uint32Array;
  /** The step that made each triangle; NO_STEP: a face of the stock. */
  step: Uint32Array;
}

export interface Tile extends Surface {
  id: number;
  level: number;
}

/** Numbers of steps after an edit: a step s becomes s + by[i] of the last i with first[i] <= s. */
export interface Renumbering {
  first: Uint32Array;
  by: Int32Array;
}

export interface MeshAnswer {
  revision: number;
  reset: boolean;
  /** FINAL, or the number of steps after which this is the part. */
  atStep: number;
  /** For the tiles that the page already has, in this order. */
  renumberings: Renumbering[];
  tiles: Tile[];
}

/** The energy per area that the beam of a laser leaves. */
export interface BurnAnswer {
  revision: number;
  nx: number;
  ny: number;
  /** mm: the lower left corner of the first cell, and the side of cells. */
  x: number;
  y: number;
  cell: number;
  /** J/mm2 that is drawn black, and the highest. */
  black: number;
  highest: number;
  /** J of the whole program. */
  joules: number;
  /** mm, W at S `fullS`: the laser. */
  beam: number;
  power: number;
  fullS: number;
  /** J/mm2 */
  energy: Float32Array;
}

/** The depth of the difference from the target on each column: above 0 left, below 0 gouged. */
export interface TargetAnswer {
  revision: number;
  nx: number;
  ny: number;
  /** mm: the lower left corner of the first column, and the distance of columns. */
  x: number;
  y: number;
  pitch: number;
  depth: Float32Array;
}

/** Takes fields from a buffer; the arrays share its memory. */
export class Reader {
  private at = 0;
  private readonly view: DataView;

  constructor(
    private readonly buffer: ArrayBuffer,
    private readonly what: string,
  ) {
    this.view = new DataView(buffer);
  }

  private take(bytes: number): number {
    if (bytes > this.buffer.byteLength - this.at) {
      throw new DecodeError(`The ${this.what} ends after ${this.buffer.byteLength} bytes; more are expected`);
    }
    const from = this.at;
    this.at += bytes;
    return from;
  }

  magic(expected: string, newest = 1): void {
    const from = this.take(4);
    const found = String.fromCharCode(...new Uint8Array(this.buffer, from, 4));
    if (found !== expected) throw new DecodeError(`The ${this.what} starts with unknown bytes`);
    const version = this.u32();
    if (version !== newest)
      throw new DecodeError(`The ${this.what} has version ${version}; this page reads version ${newest}`);
  }

  u32(): number {
    return this.view.getUint32(this.take(4), true);
  }

  u32s(count: number): Uint32Array {
    return new Uint32Array(this.buffer, this.take(4 * count), count);
  }

  i32s(count: number): Int32Array {
    return new Int32Array(this.buffer, this.take(4 * count), count);
  }

  f32s(count: number): Float32Array {
    return new Float32Array(this.buffer, this.take(4 * count), count);
  }

  u8s(count: number): Uint8Array {
    return new Uint8Array(this.buffer, this.take(count), count);
  }

  /** Numbers in the fewest bytes that hold all of them, or one number that all are. */
  column(count: number): Uint32Array {
    const size = this.u32();
    if (size === 0) return new Uint32Array(count).fill(this.u32());
    if (size === 4) return this.u32s(count).slice();
    if (size !== 1 && size !== 2) throw new DecodeError(`The ${this.what} has numbers of ${size} bytes`);
    const from = this.take(size * count);
    const values = Uint32Array.from(new (size === 1 ? Uint8Array : Uint16Array)(this.buffer, from, count));
    this.align();
    return values;
  }

  bytes(count: number): ArrayBuffer {
    const from = this.take(count);
    return this.buffer.slice(from, from + count);
  }

  /** Arrays of bytes are followed by up to three unused ones. */
  align(): void {
    this.take((4 - (this.at % 4)) % 4);
  }

  finish(): void {
    const left = this.buffer.byteLength - this.at;
    if (left > 3) throw new DecodeError(`The ${this.what} has ${left} unexpected bytes at its end`);
  }
}

export function decodeMesh(buffer: ArrayBuffer): MeshAnswer {
  const read = new Reader(buffer, 'mesh');
  read.magic('KMSH');
  const revision = read.u32();
  const flags = read.u32();
  const atStep = read.u32();
  const count = read.u32();
  const tables = read.u32();
  const renumberings: Renumbering[] = [];
  for (let i = 0; i < tables; ++i) renumberings.push(readRenumbering(read));
  const tiles: Tile[] = [];
  for (let i = 0; i < count; ++i) {
    const id = read.u32();
    const level = read.u32();
    const vertices = read.u32();
    const triangles = read.u32();
    const positions = read.f32s(3 * vertices);
    const index = read.u32s(3 * triangles);
    const step = read.u32s(triangles);
    checkIndices(index, vertices, 'mesh');
    checkFinite(positions, 'mesh');
    tiles.push({ id, level, positions, index, step });
  }
  read.finish();
  return { revision, reset: (flags & 1) !== 0, atStep, renumberings, tiles };
}

function readRenumbering(read: Reader): Renumbering {
  read.u32(); // its revision: the server sends only those that the page needs
  const runs = read.u32();
  const pairs = read.i32s(2 * runs);
  const table = { first: new Uint32Array(runs), by: new Int32Array(runs) };
  for (let i = 0; i < runs; ++i) {
    table.first[i] = pairs[2 * i]!;
    table.by[i] = pairs[2 * i + 1]!;
    if (i > 0 && table.first[i]! <= table.first[i - 1]!)
      throw new DecodeError('The numbers of steps are not in order');
  }
  return table;
}

/** Gives the triangles of a tile the step numbers that hold after an edit. */
export function renumber(step: Uint32Array, { first, by }: Renumbering): void {
  for (let t = 0; t < step.length; ++t) {
    const old = step[t]!;
    if (old === NO_STEP) continue;
    let run = -1;
    for (let low = 0, high = first.length - 1; low <= high;) {
      const mid = (low + high) >> 1;
      if (first[mid]! <= old) {
        run = mid;
        low = mid + 1;
      } else {
        high = mid - 1;
      }
    }
    if (run >= 0) step[t] = old + by[run]!;
  }
}

export function decodeBurn(buffer: ArrayBuffer): BurnAnswer {
  const read = new Reader(buffer, 'burn');
  read.magic('KBRN');
  const revision = read.u32();
  const nx = read.u32();
  const ny = read.u32();
  const numbers = read.f32s(9);
  checkFinite(numbers, 'burn');
  const [x, y, cell, black, highest, joules, beam, power, fullS] = [...numbers] as [
    number, number, number, number, number, number, number, number, number,
  ];
  const energy = read.f32s(nx * ny);
  read.finish();
  checkFinite(energy, 'burn');
  if (!(cell > 0) || nx * ny === 0) throw new DecodeError('The burn has no valid cells');
  return { revision, nx, ny, x, y, cell, black, highest, joules, beam, power, fullS, energy };
}

export function decodeTarget(buffer: ArrayBuffer): TargetAnswer {
  const read = new Reader(buffer, 'comparison');
  read.magic('KDIF');
  const revision = read.u32();
  const nx = read.u32();
  const ny = read.u32();
  const [x, y, pitch] = read.f32s(3) as unknown as [number, number, number];
  const depth = read.f32s(nx * ny);
  read.finish();
  checkFinite(depth, 'comparison');
  if (!Number.isFinite(x) || !Number.isFinite(y) || !(pitch > 0))
    throw new DecodeError('The comparison has no valid columns');
  return { revision, nx, ny, x, y, pitch, depth };
}

function checkIndices(index: Uint32Array, vertices: number, what: string): void {
  for (const i of index) {
    if (i >= vertices) throw new DecodeError(`The ${what} names vertex ${i} of ${vertices}`);
  }
}

export function checkFinite(values: Float32Array, what: string): void {
  for (const value of values) {
    if (!Number.isFinite(value)) throw new DecodeError(`The ${what} contains a number that is not finite`);
  }
}

/** The bytes of a data block of an exported page: base64 of zlib data. */
export async function unpack(text: string): Promise<ArrayBuffer> {
  const binary = atob(text.trim());
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; ++i) bytes[i] = binary.charCodeAt(i);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Response(stream).arrayBuffer();
}
