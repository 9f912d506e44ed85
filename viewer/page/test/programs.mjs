// SPDX-License-Identifier: GPL-3.0-or-later
// Insula's real programs for the browser tests. Exit status 77: they are not built, or there is no multicast; skipped.
import { spawn, spawnSync } from 'node:child_process';
import { existsSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

export const root = fileURLToPath(new URL('../../..', import.meta.url));
const folder = join(root, 'build/release/bin');
export const gatewayProgram = join(folder, 'gateway');

/** A bus of this test alone. */
export const ownBus = (first = 0) => `udpm://239.255.76.67:${20000 + ((process.pid + first) % 20000)}?ttl=0`;

export class Programs {
  #children = [];
  #ended = false;
  #mayEnd = new Set();

  constructor() {
    if (existsSync(gatewayProgram)) return;
    console.log(`skipped: no programs in ${folder}`);
    process.exit(77);
  }

  start(program, words, bus) {
    const env = { ...process.env, LCM_DEFAULT_URL: bus };
    const child = spawn(join(folder, program), words, { cwd: root, env, stdio: ['ignore', 'pipe', 'pipe'] });
    this.#children.push(child);
    return child;
  }

  /** Its end is no fault of this machine. */
  mayEnd(child) {
    this.#mayEnd.add(child);
  }

  /** The address that a gateway prints. */
  async gateway(words, bus) {
    return (await this.told(this.start('gateway', ['--port', '0', ...words], bus), /serving (\S+)/)).address;
  }

  /** Engine, haptic server and gateway, with their data in that folder: the address, and all that was printed. */
  play(data, words, bus) {
    const still = ['--no-browser', '--no-reload', '--port', '0', '--data', data];
    return this.told(this.start('insula', ['play', ...still, ...words], bus), /viewer at (\S+)/);
  }

  /** What `insula` prints; it must succeed. */
  insula(words) {
    const { status, stdout, stderr } = spawnSync(join(folder, 'insula'), words, { cwd: root, encoding: 'utf8' });
    if (status !== 0) throw new Error(`insula ${words.join(' ')} ended with ${status}: ${stderr}`);
    return stdout;
  }

  /** What it says up to that pattern, and the pattern's first group. */
  told(child, pattern) {
    return new Promise((resolve) => {
      let said = '';
      for (const out of [child.stdout, child.stderr])
        out.on('data', (d) => {
          said += d;
          const found = pattern.exec(said);
          if (found) resolve({ address: found[1], said });
        });
      child.once('exit', (status) => {
        if (this.#ended || this.#mayEnd.has(child)) return;
        console.log(`skipped: ${child.spawnfile} ended with ${status}: ${said}`);
        process.exit(77);
      });
    });
  }

  /** Ends all, and waits for that: afterwards nobody writes into their folders. */
  async end() {
    this.#ended = true;
    const alive = this.#children.filter((c) => c.exitCode === null && c.signalCode === null);
    const ends = alive.map((c) => new Promise((resolve) => c.once('exit', resolve)));
    for (const child of alive) child.kill('SIGTERM');
    await Promise.all(ends);
  }
}
