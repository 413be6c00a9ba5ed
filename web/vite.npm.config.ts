// Builds the module of the npm package as one script, dist/npm/library.mjs.
import { defineConfig } from 'vite';

export default defineConfig({
  build: {
    target: 'es2022',
    outDir: 'dist/npm',
    minify: false,
    lib: { entry: 'src/npm/index.ts', formats: ['es'], fileName: () => 'library.mjs' },
  },
});
