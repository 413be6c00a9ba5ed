import type { Kerf, OpenOptions } from './types/npm/index';

export * from './types/npm/index';
/** Starts the engine. */
export function open(options?: OpenOptions): Promise<Kerf>;
