// The engine in WebAssembly against the command: the same model, triangles and motions.
import { existsSync, readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { expect, test } from 'vitest';
import { decodeMesh } from '../../src/decode';
import { decodePath } from '../../src/path';
import type { Model } from '../../src/protocol';
import { type Engine, type EngineAnswer, engineOf, type Module } from '../../src/worker/engine';
import { EXAMPLES, KERF, ViewServer } from '../support/command';

const SITE = process.env.KERF_SITE ?? '';
const PROGRAMS = ['demo.nc', 'plate.gcmc'];

async function engine(): Promise<Engine> {
  const create = createRequire(import.meta.url)(join(SITE, 'kerf.js')) as (options: {
    wasmBinary: Uint8Array;
  }) => Promise<Module>;
  return engineOf(await create({ wasmBinary: readFileSync(join(SITE, 'kerf.wasm')) }));
}

const json = (answer: EngineAnswer) => JSON.parse(new TextDecoder().decode(answer.bytes)) as Model;

/** Numbers to ten digits: functions such as the cosine differ in their last bit between C libraries. */
const rounded = (model: object): unknown =>
  JSON.parse(JSON.stringify(model), (_key, value: unknown) =>
    typeof value === 'number' ? Number(value.toPrecision(10)) : value,
  );

/** A sum that does not depend on the order of triangles. */
function extent(buffer: ArrayBuffer): { triangles: number; sum: number } {
  let triangles = 0;
  let sum = 0;
  for (const tile of decodeMesh(buffer).tiles) {
    triangles += tile.step.length;
    const at = tile.positions;
    for (const i of tile.index) sum += at[3 * i]! + 2 * at[3 * i + 1]! + 3 * at[3 * i + 2]!;
  }
  return { triangles, sum };
}

for (const name of PROGRAMS) {
  test.skipIf(!existsSync(KERF))(`${name}: model, mesh and motions are those of kerf view`, async () => {
    const kerf = await engine();
    expect(kerf.put(name, readFileSync(join(EXAMPLES, name))).status).toBe(200);
    expect(kerf.load(name).status).toBe(200);
    const pitch = String(json(kerf.model()).pitch);
    const own = await ViewServer.start(join(EXAMPLES, name), '--resolution', pitch);
    try {
      for (;;) {
        const event = (await (await own.get('model')).json()) as Model;
        if (event.state === 'ready') break;
        await new Promise((done) => setTimeout(done, 100));
      }
      const here = json(kerf.model());
      const there = (await (await own.get('model')).json()) as Model;
      const { files: hereFiles, source: hereSource, input: hereInput, ...hereRest } = here;
      const { files: thereFiles, source: thereSource, input: thereInput, ...thereRest } = there;
      expect([hereInput, thereInput]).toEqual([0, 1]); // a server counts the versions of the files
      expect(hereFiles.map((file) => file.text)).toEqual(thereFiles.map((file) => file.text));
      expect(hereSource).toBe(name);
      expect(thereSource).toContain(name);
      const relative = (model: object) =>
        rounded(JSON.parse(JSON.stringify(model).replaceAll(join(EXAMPLES, name), name)) as Model);
      expect(relative(hereRest)).toEqual(relative(thereRest));
      const mesh = extent(await (await own.get('mesh?since=0')).arrayBuffer());
      const made = extent(kerf.mesh(0).bytes.buffer);
      expect(made.triangles).toBe(mesh.triangles);
      expect(made.sum).toBeCloseTo(mesh.sum, 1);
      const path = decodePath(await (await own.get('path')).arrayBuffer());
      expect(decodePath(kerf.path(0).bytes.buffer).points).toEqual(path.points);
    } finally {
      await own.end();
    }
  });
}
