import type { Kerf, OpenOptions } from './types/npm/index.js';

export * from './types/npm/index.js';
/** Starts the engine. */
export function open(options?: OpenOptions): Promise<Kerf>;
