// SPDX-License-Identifier: GPL-2.0-or-later
import { svelte } from '@sveltejs/vite-plugin-svelte';
import { defineConfig } from 'vite';

// Everything that the page needs lies in the output: nothing is fetched from elsewhere.
export default defineConfig({
  plugins: [svelte()],
  build: {
    outDir: process.env['MW_SCREEN_FOLDER'] ?? '../build/release/share/millwright/web',
    emptyOutDir: true,
    target: 'es2022',
    assetsInlineLimit: 0,
    chunkSizeWarningLimit: 1500,
    // The screen of a machine, and the page that chooses one.
    rollupOptions: { input: ['index.html', 'first.html'] },
  },
  worker: { format: 'es' },
});
