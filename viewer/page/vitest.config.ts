// SPDX-License-Identifier: GPL-3.0-or-later
// Unit tests run in node; the browser test is test/e2e.mjs.
import { defineConfig } from 'vitest/config';

export default defineConfig({
  // A slow or busy machine fails no test.
  test: { include: ['test/*.test.ts'], environment: 'node', testTimeout: 60_000 },
  // Tests read the project's scenes.
  server: { fs: { allow: ['../..'] } },
});
