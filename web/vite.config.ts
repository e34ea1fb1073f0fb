// SPDX-License-Identifier: GPL-2.0-or-later
import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { svelte } from '@sveltejs/vite-plugin-svelte';
import { defineConfig, type Plugin } from 'vite';

const here = (name: string): string => fileURLToPath(new URL(name, import.meta.url));

/** The page for selecting a machine: the frame of index.html with another program. */
function firstPage(): Plugin {
  const path = here('first.html');
  return {
    name: 'first-page',
    enforce: 'pre',
    resolveId: (id) => (id.endsWith('first.html') ? path : null),
    load: (id) => (id === path ? readFileSync(here('index.html'), 'utf8').replace('/src/main.ts', '/src/first/main.ts') : null),
  };
}

// The output contains all files of the page; nothing is fetched from other servers.
export default defineConfig({
  plugins: [firstPage(), svelte()],
  build: {
    outDir: process.env['MW_SCREEN_FOLDER'] ?? '../build/release/share/millwright/web',
    emptyOutDir: true,
    target: 'es2022',
    assetsInlineLimit: 0,
    chunkSizeWarningLimit: 1500,
    // The screen of a machine, and the page for selecting a machine.
    rollupOptions: { input: ['index.html', 'first.html'] },
  },
  worker: { format: 'es' },
});
