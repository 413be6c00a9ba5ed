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

/** `flow`: one number per motion, or none for an answer without them. */
export function encodePath(
  revision: number,
  motions: RawMotion[],
  origins: RawOrigin[],
  flow: number[] = [],
): ArrayBuffer {
  const points = motions.flatMap((m) => m.points);
  let first = 0;
  const firsts = [0, ...motions.map((m) => (first += m.points.length / 3))];
  const out = new Writer()
    .text('KPTH')
    .u32(1, revision, motions.length, points.length / 3, origins.length, flow.length > 0 ? 1 : 0, 0)
    .u32(...motions.map((m) => m.step))
    .u32(...firsts)
    .u32(...motions.map((m) => m.tool ?? -1))
    .u32(...motions.map((m) => m.origin ?? 0xffffffff))
    .f32(...motions.map((m) => m.seconds ?? 1))
    .f32(...motions.map((m) => m.feed ?? 0))
    .f32(...points)
    .u32(...origins.map((o) => o.file))
    .u32(...origins.map((o) => o.line))
    .u32(...origins.map((o) => o.caller ?? 0xffffffff))
    .u8(...motions.map((m) => m.kind ?? 1));
  if (flow.length > 0) out.pad().f32(...flow);
  return out.done();
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
