// SPDX-License-Identifier: GPL-3.0-or-later
// sound_rendering.mjs with the voices of the page as one script, which a browser can run: window.rendering.
import { fileURLToPath } from 'node:url';
import { build } from 'vite';

export async function renderingScript() {
  const [{ output }] = await build({
    configFile: false,
    logLevel: 'error',
    build: {
      write: false,
      minify: false,
      lib: {
        entry: fileURLToPath(new URL('sound_rendering.mjs', import.meta.url)),
        formats: ['iife'],
        name: 'rendering',
      },
    },
  });
  return `${output[0].code};window.rendering = rendering;`;
}
