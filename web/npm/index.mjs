// The entry of the package: the library with the engine beside it.
import createKerf from './kerf.cjs';
import { start } from './library.mjs';

export { Kerf, KerfError } from './library.mjs';

/** The engine's bytes in Node.js, whose fetch() takes no paths. */
async function engineBytes(locateFile) {
  const { readFile } = await import('node:fs/promises');
  return readFile(locateFile?.('kerf.wasm') ?? new URL('kerf.wasm', import.meta.url));
}

export async function open(options = {}) {
  const inNode = typeof process === 'object' && process.versions?.node !== undefined;
  return start(createKerf, inNode ? { ...options, wasmBinary: await engineBytes(options.locateFile) } : options);
}
