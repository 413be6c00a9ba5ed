// Unit and browser tests; the browser's tests share one machine, so they run one after the other.
import { defineConfig } from 'vitest/config';

export default defineConfig({
  test: { testTimeout: 40000, hookTimeout: 60000, fileParallelism: false },
});
