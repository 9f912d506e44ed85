// SPDX-License-Identifier: GPL-3.0-or-later
// Build of the page; in development, scene data and messages come from a gateway (or mock server) on port 8080.
import { defineConfig } from 'vite';

const gateway = process.env.INSULA_GATEWAY ?? 'http://127.0.0.1:8080';

export default defineConfig({
  base: './',
  build: {
    target: 'es2022',
    chunkSizeWarningLimit: 1500,
    reportCompressedSize: false,
    rollupOptions: {
      input: ['index.html', 'replay.html', 'start.html', 'login.html', 'room.html', 'studio.html', 'certificate.html'],
    },
  },
  server: {
    proxy: { '/ws': { target: gateway, ws: true }, '/bundle': gateway, '/sessions': gateway, '/api': gateway },
  },
});
