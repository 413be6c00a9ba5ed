// Writes the binary answers of the protocol, for tests; separate from the code that reads them.

export interface RawTile {
  id: number;
  level?: number;
  positions: number[];
  index: number[];
  step: number[];
}

class Writer {
  private bytes: number[] = [];

  text(text: string): this {
    for (const c of text) this.bytes.push(c.charCodeAt(0));
    return this;
  }

  u32(...values: number[]): this {
    for (const v of values) this.bytes.push(v & 255, (v >>> 8) & 255, (v >>> 16) & 255, (v >>> 24) & 255);
    return this;
  }

  f32(...values: number[]): this {
    const view = new DataView(new ArrayBuffer(4));
    for (const v of values) {
      view.setFloat32(0, v, true);
      for (let i = 0; i < 4; ++i) this.bytes.push(view.getUint8(i));
    }
    return this;
  }

  u8(...values: number[]): this {
    this.bytes.push(...values);
    return this;
  }

  /** In the fewest bytes that hold all values. */
  column(values: number[]): this {
    const high = Math.max(0, ...values);
    if (values.every((v) => v === values[0])) return this.u32(0, values[0] ?? 0);
    if (high > 0xffff) return this.u32(4, ...values);
    if (high <= 0xff)
      return this.u32(1)
        .u8(...values)
        .pad();
    return this.u32(2)
      .u8(...values.flatMap((v) => [v & 255, v >> 8]))
      .pad();
  }

  floats(values: number[]): this {
    return this.column([...new Uint32Array(Float32Array.from(values).buffer)]);
  }

  pad(): this {
    while (this.bytes.length % 4 !== 0) this.bytes.push(0);
    return this;
  }

  done(): ArrayBuffer {
    return new Uint8Array(this.bytes).buffer;
  }
}

export function encodeMesh(
  revision: number,
  tiles: RawTile[],
  flags = 0,
  atStep = 0xffffffff,
  tables: [number, number][][] = [],
): ArrayBuffer {
  const out = new Writer().text('KMSH').u32(1, revision, flags, atStep, tiles.length, tables.length);
  for (const runs of tables) out.u32(revision, runs.length, ...runs.flat());
  for (const t of tiles) {
    out.u32(t.id, t.level ?? 0, t.positions.length / 3, t.index.length / 3);
    out
      .f32(...t.positions)
      .u32(...t.index)
      .u32(...t.step);
  }
  return out.done();
}

export interface RawMotion {
  step: number;
  tool?: number;
  origin?: number;
  seconds?: number;
  feed?: number;
  kind?: number;
  points: number[];
}

export interface RawOrigin {
  file: number;
  line: number;
  caller?: number;
}

export interface PathOptions {
  /** mm3/s of each motion. */
  flow?: number[];
  power?: number[];
  bead?: number[];
  /** Motions of a block. */
  block?: number;
  /** Blocks by their numbers, from 1, that the page has. */
  has?: number[];
  /** The number of the first block. */
  id?: number;
}

/** Calls must be before the origins that they are callers of. */
export function encodePath(
  revision: number,
  motions: RawMotion[],
  origins: RawOrigin[],
  options: PathOptions = {},
): ArrayBuffer {
  const size = options.block ?? Math.max(motions.length, 1);
  const blocks: { table: number[]; lines: number[]; bytes: ArrayBuffer }[] = [];
  for (let first = 0; first < motions.length; first += size) {
    const id = (options.id ?? 1) + blocks.length;
    const part = (values?: number[]) => values?.slice(first, first + size);
    const made = encodeBlock(motions.slice(first, first + size), origins, {
      flow: part(options.flow),
      power: part(options.power),
      bead: part(options.bead),
    });
    const bytes = options.has?.includes(id) ? new ArrayBuffer(0) : made.bytes;
    blocks.push({ ...made, table: [id, ...made.table, bytes.byteLength], bytes });
  }
  const total = (k: number) => blocks.reduce((sum, block) => sum + block.table[k]!, 0);
  const out = new Writer().text('KPTH').u32(2, revision, total(1), total(2), blocks.length, total(4), 0);
  for (const block of blocks) out.u32(...block.table);
  for (const block of blocks) out.u32(...block.lines);
  for (const block of blocks) out.u8(...new Uint8Array(block.bytes));
  return out.done();
}

function encodeBlock(
  motions: RawMotion[],
  origins: RawOrigin[],
  more: PathOptions,
): { table: number[]; lines: number[]; bytes: ArrayBuffer } {
  const points: number[] = [];
  const counts: number[] = [];
  const kinds = motions.map((m) => {
    const start = m.points.slice(0, 3);
    const isJoined = points.length > 0 && start.length > 0 && String(points.slice(-3)) === String(start);
    const own = isJoined ? m.points.slice(3) : m.points;
    points.push(...own);
    counts.push(own.length / 3);
    return (m.kind ?? 1) + (isJoined ? 8 : 0);
  });
  // The last origin is that of motions without one.
  const all = [...origins, { file: 0xffffffff, line: 0 }];
  const files = [...new Set(all.map((o) => o.file))];
  const lines = files.map((file) => all.find((o) => o.file === file)!.line);
  const last = lines.map((line) => line - 1);
  const signed = (v: number) => (v < 0 ? -2 * v - 1 : 2 * v);
  const numbers = motions.map((m) => m.origin ?? all.length - 1);
  const first = motions[0]!.step;
  const out = new Writer()
    .column(motions.map((m, k) => (m.step - first - k) >>> 0))
    .column(counts)
    .column(kinds)
    .column(motions.map((m) => (m.tool ?? -1) + 1))
    .column(numbers.map((n, k) => signed(n - (k > 0 ? numbers[k - 1]! : -1))))
    .floats(motions.map((m) => m.seconds ?? 1))
    .floats(motions.map((m) => m.feed ?? 0))
    .floats(more.flow ?? motions.map(() => 0))
    .floats(more.power ?? motions.map(() => 0))
    .column(more.bead ?? motions.map(() => 0))
    .u32(...files)
    .column(all.map((o) => files.indexOf(o.file)))
    .column(
      all.map((o) => {
        const group = files.indexOf(o.file);
        const by = o.line - last[group]!;
        last[group] = o.line;
        return signed(by);
      }),
    )
    .column(all.map((o) => (o.caller ?? -1) + 1))
    .f32(...points);
  return {
    table: [motions.length, points.length / 3, all.length, files.length, first],
    lines,
    bytes: out.done(),
  };
}

export function encodeTarget(
  revision: number,
  nx: number,
  ny: number,
  x: number,
  y: number,
  pitch: number,
  depth: number[],
): ArrayBuffer {
  return new Writer()
    .text('KDIF')
    .u32(1, revision, nx, ny)
    .f32(x, y, pitch, ...depth)
    .done();
}
