// SPDX-License-Identifier: GPL-3.0-or-later
// Leaves a compressed copy (name.gz) beside each built text; the gateway sends it to browsers that unpack it. Fails
// when the page's first load, before any scene, is 1 MB or more.
import { readdirSync, readFileSync, statSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { gzipSync } from 'node:zlib';

const dist = join(dirname(fileURLToPath(import.meta.url)), '../dist');
const limit = 1_000_000;
let sent = 0;
for (const name of readdirSync(dist, { recursive: true })) {
  const file = join(dist, name);
  if (!statSync(file).isFile() || name.endsWith('.gz')) continue;
  const text = readFileSync(file);
  const packed = /\.(js|css|html|svg|json)$/.test(name) && text.length > 1000 ? gzipSync(text, { level: 9 }) : null;
  if (packed) writeFileSync(`${file}.gz`, packed);
  sent += packed?.length ?? text.length;
}
console.log(`first load: ${(sent / 1000).toFixed(0)} kB`);
if (sent >= limit) {
  console.error(`the first load must stay below ${limit / 1000} kB`);
  process.exit(1);
}
