// SPDX-License-Identifier: GPL-3.0-or-later
// Insula's real programs for the browser tests. Exit status 77: they are not built, or there is no multicast; skipped.
import { spawn } from 'node:child_process';
import { existsSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

const root = fileURLToPath(new URL('../../..', import.meta.url));
const folder = join(root, 'build/release/bin');

export class Programs {
  #children = [];
  #ended = false;

  constructor() {
    if (existsSync(join(folder, 'gateway'))) return;
    console.log(`skipped: no programs in ${folder}`);
    process.exit(77);
  }

  start(program, words, bus) {
    const env = { ...process.env, LCM_DEFAULT_URL: bus };
    const child = spawn(join(folder, program), words, { cwd: root, env, stdio: ['ignore', 'pipe', 'pipe'] });
    this.#children.push(child);
    return child;
  }

  /** The address that a gateway prints. */
  gateway(words, bus) {
    const child = this.start('gateway', ['--port', '0', ...words], bus);
    return new Promise((resolve) => {
      let said = '';
      for (const out of [child.stdout, child.stderr])
        out.on('data', (d) => {
          said += d;
          const found = /serving (\S+)/.exec(said);
          if (found) resolve(found[1]);
        });
      child.once('exit', (status) => {
        if (this.#ended) return;
        console.log(`skipped: the gateway ended with ${status}: ${said}`);
        process.exit(77);
      });
    });
  }

  end() {
    this.#ended = true;
    for (const child of this.#children) child.kill('SIGTERM');
  }
}
