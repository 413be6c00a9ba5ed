// The entry of the package: the library with the engine beside it.
import createKerf from './kerf.cjs';
import { start } from './library.mjs';

export { Kerf, KerfError } from './library.mjs';
export const open = (options) => start(createKerf, options);
