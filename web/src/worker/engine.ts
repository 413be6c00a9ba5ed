// Kerf in WebAssembly: the functions of src/app/browser/wasm/exports.cpp.

export interface EngineAnswer {
  status: number;
  bytes: Uint8Array<ArrayBuffer>;
}

export interface Engine {
  put(name: string, bytes: Uint8Array): EngineAnswer;
  /** The data of the event "model", or with status 400 of the event "errors". */
  load(name: string): EngineAnswer;
  model(): EngineAnswer;
  mesh(since: number): EngineAnswer;
  path(since: number): EngineAnswer;
  source(id: number): EngineAnswer;
  at(step: number, from: number): EngineAnswer;
  exact(): EngineAnswer;
  download(format: string, post: string, view: string): EngineAnswer & { name: string };
}

/** What emscripten's createKerf() returns, as far as it is used. */
export interface Module {
  HEAPU8: Uint8Array;
  cwrap(
    name: string,
    result: string | null,
    parameters: string[],
  ): (...values: (number | string)[]) => number;
  UTF8ToString(at: number): string;
  _malloc(size: number): number;
  _free(at: number): void;
}

export function engineOf(module: Module): Engine {
  const call = (name: string, ...parameters: string[]) => module.cwrap(`kerf_${name}`, 'number', parameters);
  const first = call('answer');
  const size = call('answer_size');
  const fileName = call('answer_name');
  const answer = (status: number): EngineAnswer => ({
    status,
    bytes: module.HEAPU8.slice(first(), first() + size()) as Uint8Array<ArrayBuffer>,
  });
  const put = call('put', 'string', 'number', 'number');
  const load = call('load', 'string');
  const model = call('model');
  const mesh = call('mesh', 'number');
  const path = call('path', 'number');
  const source = call('source', 'number');
  const at = call('at', 'number', 'number');
  const exact = call('exact');
  const download = call('download', 'string', 'string', 'string');
  return {
    put(name, bytes) {
      const start = module._malloc(Math.max(bytes.length, 1));
      module.HEAPU8.set(bytes, start);
      const status = put(name, start, bytes.length);
      module._free(start);
      return answer(status);
    },
    load: (name) => answer(load(name)),
    model: () => answer(model()),
    mesh: (since) => answer(mesh(since)),
    path: (since) => answer(path(since)),
    source: (id) => answer(source(id)),
    at: (step, from) => answer(at(step, from)),
    exact: () => answer(exact()),
    download(format, post, view) {
      const made = answer(download(format, post, view));
      return { ...made, name: module.UTF8ToString(fileName()) };
    },
  };
}
