// Builds the worker of the page without a server as one script, dist/worker.js.
import { defineConfig } from 'vite';

export default defineConfig({
  build: {
    target: 'es2022',
    outDir: 'dist',
    emptyOutDir: false,
    lib: {
      entry: 'src/worker/worker.ts',
      formats: ['iife'],
      name: 'kerfWorker',
      fileName: () => 'worker.js',
    },
  },
});
