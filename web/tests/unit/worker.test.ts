// The page's side of its worker against the worker's own side, with an engine that only records its calls.
import { File as FileOfNode } from 'node:buffer';
import { expect, test, vi } from 'vitest';
import type { MeshAnswer } from '../../src/decode';
import { fileName } from '../../src/files';
import { LiveSource, type ModelListener } from '../../src/model_source';
import type { Model } from '../../src/protocol';
import { Desk } from '../../src/worker/desk';
import type { Engine, EngineAnswer } from '../../src/worker/engine';
import type { FromWorker, Request } from '../../src/worker/messages';
import { type Channel, WorkerTransport } from '../../src/worker/worker_transport';
import { encodeMesh, encodePath } from '../support/encode';

// Node.js 18, which Debian 12 has, keeps File in a module.
globalThis.File ??= FileOfNode as unknown as typeof File;

const bytesOf = (text: string) => new TextEncoder().encode(text) as Uint8Array<ArrayBuffer>;
const MODEL = { protocol: 1, state: 'ready', errors: [], target: null };
const binary = (buffer: ArrayBuffer) => found(new Uint8Array(buffer));
const found = (bytes: Uint8Array<ArrayBuffer>): EngineAnswer => ({ status: 200, bytes });

/** Files with the text "bad" have an error; every other one is shown with the next revision. */
class Recorder implements Engine {
  readonly files = new Map<string, string>();
  readonly calls: string[] = [];
  private revision = 0;

  put(name: string, bytes: Uint8Array): EngineAnswer {
    this.calls.push(`put ${name}`);
    if (bytes.length > 1000) return { status: 400, bytes: bytesOf('too large') };
    this.files.set(name, new TextDecoder().decode(bytes));
    return found(bytesOf(''));
  }
  load(name: string): EngineAnswer {
    this.calls.push(`load ${name}`);
    if (this.files.get(name) === 'trap') throw new Error('unreachable');
    if (this.files.get(name) === 'bad') {
      const event = { revision: this.revision, diagnostics: [{ severity: 'error', message: 'is bad' }] };
      return { status: 400, bytes: bytesOf(JSON.stringify(event)) };
    }
    return found(bytesOf(JSON.stringify({ revision: ++this.revision, tiles: 0, path: true })));
  }
  model(): EngineAnswer {
    return found(bytesOf(JSON.stringify({ ...MODEL, revision: this.revision })));
  }
  mesh(since: number): EngineAnswer {
    this.calls.push(`mesh ${since}`);
    return binary(encodeMesh(this.revision, []));
  }
  path(): EngineAnswer {
    return binary(encodePath(this.revision, [], []));
  }
  source(id: number): EngineAnswer {
    return found(bytesOf(`block ${id}\n`));
  }
  at(step: number, from: number): EngineAnswer {
    this.calls.push(`at ${step} ${from}`);
    return binary(encodeMesh(this.revision, [], 0, step));
  }
  exact(): EngineAnswer {
    return { status: 204, bytes: bytesOf('') };
  }
  download(format: string, post: string): EngineAnswer & { name: string } {
    return { ...found(bytesOf(`${format} ${post}`)), name: `part.${format}` };
  }
}

/** A worker in the same thread: messages arrive later, copied, and in order. */
class NearWorker implements Channel {
  onmessage: ((event: MessageEvent<FromWorker>) => void) | null = null;
  onerror: ((event: ErrorEvent) => void) | null = null;
  isEnded = false;
  asked = 0;
  readonly engine = new Recorder();
  private readonly desk = new Desk(this.engine, (message) => this.send(message));

  constructor(ready: FromWorker = { ready: true }) {
    this.send(ready);
  }
  private send(message: FromWorker): void {
    const copy = structuredClone(message);
    setTimeout(() => this.isEnded || this.onmessage?.({ data: copy } as MessageEvent<FromWorker>));
  }
  postMessage(message: Request): void {
    const copy = structuredClone(message);
    this.asked += 1;
    if (copy.body && new TextDecoder().decode(copy.body) === 'endless') return; // it is never answered
    setTimeout(() => this.isEnded || this.desk.handle(copy));
  }
  terminate(): void {
    this.isEnded = true;
  }
}

class Shown implements ModelListener {
  readonly log: string[] = [];
  model(model: Model, mesh: MeshAnswer): void {
    this.log.push(`model ${model.revision}${mesh.reset ? ' reset' : ''}`);
  }
  exact(): void {}
  errors(event: { diagnostics: { message: string }[] }): void {
    this.log.push(`errors ${event.diagnostics.map((d) => d.message).join()}`);
  }
  progress(): void {}
  connected(isConnected: boolean): void {
    this.log.push(isConnected ? 'connected' : 'lost');
  }
  failed(message: string): void {
    this.log.push(`failed ${message}`);
  }
  opened(name: string, text: string): void {
    this.log.push(`opened ${name} ${text}`);
  }
}

/** Waits until the log ends with these entries. */
const logged = (shown: Shown, ...entries: string[]) =>
  vi.waitFor(() => expect(shown.log.slice(-entries.length)).toEqual(entries), 10_000);

async function setUp(first: string | null = null, ready?: FromWorker) {
  const workers: NearWorker[] = [];
  const programs: Record<string, string> = { 'index.json': '{"files":["a.nc"]}', 'a.nc': 'M2' };
  const transport = new WorkerTransport(
    () => {
      workers.push(new NearWorker(ready));
      return workers.at(-1)!;
    },
    'programs',
    async (address) => {
      const text = programs[address.replace('programs/', '')];
      return new Response(text ?? '', { status: text === undefined ? 404 : 200 });
    },
  );
  const source = new LiveSource(transport, first);
  const shown = new Shown();
  source.start(shown);
  await vi.waitFor(() => expect(shown.log.length).toBeGreaterThan(0), 10_000);
  return { workers, source, shown };
}

test('the first program is opened, and its text is announced', async () => {
  const { shown, source, workers } = await setUp('a.nc');
  await logged(shown, 'model 1 reset');
  expect(shown.log.slice(0, -1).sort()).toEqual(['connected', 'opened a.nc M2']);
  expect(await source.names()).toEqual(['a.nc']);
  expect(workers[0]!.engine.calls.slice(0, 2)).toEqual(['put a.nc', 'load a.nc']);
});

test('a program that is not there is a failure with its name', async () => {
  const { shown } = await setUp('none.nc');
  await vi.waitFor(() => expect(shown.log).toContain('failed There is no program none.nc'));
});

test('an edit with an error leaves the part; the next one is shown', async () => {
  const { source, shown, workers } = await setUp('a.nc');
  await logged(shown, 'model 1 reset');
  await source.edit!('a.nc', 'bad');
  await source.edit!('a.nc', 'good');
  await logged(shown, 'model 1 reset', 'errors is bad', 'model 2');
  expect(workers[0]!.engine.calls).toContain('mesh 1'); // only what has changed since
});

test('while one text is cut only the newest of the next ones is kept', async () => {
  const { source, workers } = await setUp();
  await Promise.all(['1', '2', '3', '4'].map((text) => source.edit!('a.nc', text)));
  expect(workers[0]!.engine.calls.filter((call) => call.startsWith('load'))).toHaveLength(2);
  expect(workers[0]!.engine.files.get('a.nc')).toBe('4');
});

test('stopping starts another worker with the same files, whose revisions start over', async () => {
  const { source, shown, workers } = await setUp('a.nc');
  await logged(shown, 'model 1 reset');
  await source.upload(new File(['x'], 'de pth.gcmc'));
  await logged(shown, 'model 2');
  const before = workers[0]!.asked;
  const edit = source.edit!('a.nc', 'endless').catch((error: Error) => error.message);
  await vi.waitFor(() => expect(workers[0]!.asked).toBe(before + 1));
  source.stop();
  expect(await edit).toBe('stopped');
  expect(workers).toHaveLength(2);
  expect(workers[0]!.isEnded).toBe(true);
  await source.edit!('a.nc', 'good');
  await logged(shown, 'model 1 reset');
  expect([...workers[1]!.engine.files.keys()].sort()).toEqual(['a.nc', 'de_pth.gcmc']);
});

test('states, downloads and wrong requests', async () => {
  const { source } = await setUp('a.nc');
  expect((await source.instant(3, null)).atStep).toBe(3);
  const answer = await source.download('download/gcode?post=grbl')!();
  expect(await answer.text()).toBe('gcode grbl');
  expect(answer.headers.get('Content-Disposition')).toBe('filename="part.gcode"');
  expect(source.download('download/png?view=iso')).toBeNull();
  await expect(source.instant(-1, null)).rejects.toThrow('whole numbers');
  await expect(source.upload(new File(['x'.repeat(2000)], 'large.nc'))).rejects.toThrow('too large');
});

test('a trap of the engine is an error of the request, not the end of the page', async () => {
  const { source, shown } = await setUp();
  await expect(source.edit!('a.nc', 'trap')).rejects.toThrow('unreachable');
  await source.edit!('a.nc', 'good');
  await logged(shown, 'model 1 reset');
});

test('an engine that cannot be loaded fails what waits for it', async () => {
  const { shown } = await setUp('a.nc', { ready: false, problem: 'no WebAssembly' });
  await vi.waitFor(() => expect(shown.log).toContain('failed no WebAssembly'));
  expect(shown.log).toContain('lost');
});

test('names of files are those of the engine', () => {
  expect(fileName('part-2_b.nc')).toBe('part-2_b.nc');
  expect(fileName('a"b\r\nc/../d.nc')).toBe('a_b__c_.._d.nc');
  expect(fileName('')).toBe('_');
  expect(fileName('..x')).toBe('_..x');
});
