// Unit and browser tests; the browser's tests share one machine, so they run one after the other.
import { defineConfig } from 'vitest/config';

export default defineConfig({
  test: { testTimeout: 120_000, hookTimeout: 120_000, fileParallelism: false },
});
