// Bundles the page into dist/: index.html, app.js, app.css, icon.svg. The same sources give the same bytes.
import { build } from 'esbuild';
import { copyFile, mkdir } from 'node:fs/promises';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const here = dirname(fileURLToPath(import.meta.url));
const dist = join(here, 'dist');

await mkdir(dist, { recursive: true });
await build({
  entryPoints: { app: join(here, 'src/main.ts') },
  outdir: dist,
  bundle: true,
  format: 'esm',
  target: 'es2022',
  minify: true,
  charset: 'utf8',
  legalComments: 'none',
});
await build({
  entryPoints: { app: join(here, 'src/style/app.css') },
  outdir: dist,
  bundle: true,
  minify: true,
  target: ['chrome110', 'firefox110', 'safari16'],
});
for (const name of ['index.html', 'icon.svg']) await copyFile(join(here, 'src', name), join(dist, name));
