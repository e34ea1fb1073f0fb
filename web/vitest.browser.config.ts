// SPDX-License-Identifier: GPL-2.0-or-later
import { defineConfig } from 'vitest/config';

// One machine and one browser at a time, because two cores are used and the machine runs in real time.
export default defineConfig({
  test: {
    include: ['tests-browser/**/*.test.ts'],
    environment: 'node',
    fileParallelism: false,
    testTimeout: 45_000,
    hookTimeout: 60_000,
    bail: 0,
  },
});
