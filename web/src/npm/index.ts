// The npm package kerf-cam: Kerf's library in WebAssembly, for Node.js and pages. Lengths are mm, times s.
// Imports have endings, so that the package's types are read by TypeScript's resolution for Node.js too.
import { engineOf, type Engine, type Module } from '../worker/engine.js';
import type { Diagnostic, Model } from '../protocol.js';

export type { Diagnostic, Finding, Model } from '../protocol.js';
export type { FrameAnswer, FrameEvent, FrameRequest } from '../frame/messages.js';

/** What `load` throws: the file could not be read or cut. */
export class KerfError extends Error {
  constructor(readonly diagnostics: Diagnostic[]) {
    super(diagnostics.map((one) => one.message).join('\n') || 'the program could not be read');
    this.name = 'KerfError';
  }
}

/** A file in memory. */
export interface MadeFile {
  name: string;
  bytes: Uint8Array;
}

export interface DownloadOptions {
  /** The controller of G-code, as `kerf post --to` names it. */
  post?: string;
  /** The view of a picture, e.g. "top" or "iso". */
  view?: string;
}

export interface OpenOptions {
  /** Is called while a program is read and cut. */
  progress?: (phase: string, fraction: number) => void;
  /** Where kerf.wasm lies, if it is not beside the module. */
  locateFile?: (name: string) => string;
}

/** One program with the part that it cuts. */
export class Kerf {
  /** @internal Use `open`. */
  constructor(private readonly engine: Engine) {}

  /** Stores a file: a program, or one that a program includes. */
  put(name: string, content: string | Uint8Array): void {
    const bytes = typeof content === 'string' ? new TextEncoder().encode(content) : content;
    const stored = this.engine.put(name, bytes);
    if (stored.status !== FOUND) throw new Error(textOf(stored.bytes));
  }

  /**
   * Reads and cuts a stored file: G-code, gcmc, OpenSCAD, a path drawing or a cutting job.
   * @throws KerfError with every error that was found
   */
  load(name: string): Model {
    const loaded = this.engine.load(name);
    if (loaded.status !== FOUND) {
      const { diagnostics } = JSON.parse(textOf(loaded.bytes)) as { diagnostics: Diagnostic[] };
      throw new KerfError(diagnostics);
    }
    return JSON.parse(textOf(this.engine.model().bytes)) as Model;
  }

  /** A file of the loaded part: `stl`, `3mf`, `glb`, `obj`, `png` or `gcode`. */
  download(format: string, options: DownloadOptions = {}): MadeFile {
    const { status, bytes, name } = this.engine.download(format, options.post ?? '', options.view ?? '');
    if (status !== FOUND) throw new Error(textOf(bytes));
    return { name, bytes };
  }
}

/** @internal Starts the engine from the function `createKerf` of kerf.cjs. */
export async function start(
  createKerf: (options: object) => Promise<Module>,
  options: OpenOptions = {},
): Promise<Kerf> {
  return new Kerf(engineOf(await createKerf({ ...options })));
}

const FOUND = 200;
const textOf = (bytes: Uint8Array) => new TextDecoder().decode(bytes);
