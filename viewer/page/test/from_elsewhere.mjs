// SPDX-License-Identifier: GPL-3.0-or-later
// A gateway whose pages come from another machine, though all runs on this one. It lives in a network of its own with
// two addresses: it listens on one, and what comes in through a socket in the file system is sent on from the other.
// As a program, that is the inner side: `node from_elsewhere.mjs SOCKET GATEWAY WORDS...`.
import { execFileSync, spawn } from 'node:child_process';
import { once } from 'node:events';
import { connect, createServer } from 'node:net';
import { join } from 'node:path';
import { createInterface } from 'node:readline';
import { fileURLToPath } from 'node:url';

const file = fileURLToPath(import.meta.url);
const [station, visitor] = ['198.51.100.1', '198.51.100.2'];

/** Hands on what comes in by the sockets that `way` opens. */
const relay = (way) =>
  createServer((from) => {
    const to = way();
    for (const s of [from, to]) s.on('error', () => [from, to].forEach((x) => x.destroy()));
    from.pipe(to).pipe(from);
  });

/** The first line of a program's output that matches. */
async function told(child, pattern) {
  for await (const line of createInterface({ input: child.stdout })) {
    const found = pattern.exec(line);
    if (found) return found;
  }
  return null;
}

async function inside([socket, gateway, ...words]) {
  execFileSync('ip', ['link', 'set', 'lo', 'up']);
  for (const address of [station, visitor]) execFileSync('ip', ['address', 'add', `${address}/32`, 'dev', 'lo']);
  const child = spawn(gateway, ['--listen', station, '--port', '0', ...words], {
    stdio: ['ignore', 'pipe', 'inherit'],
  });
  process.once('SIGTERM', () => child.kill());
  child.once('exit', (status) => process.exit(status ?? 0));
  const port = Number((await told(child, /serving \S+:(\d+)\//))[1]);
  relay(() => connect({ host: station, port, localAddress: visitor })).listen(socket, () => console.log('ready'));
}

/** Null: this machine allows no network of one's own. Ends with `end`. */
export async function gatewayFromElsewhere(folder, gateway, words) {
  const socket = join(folder, 'elsewhere');
  const child = spawn('unshare', ['-Urn', process.execPath, file, socket, gateway, ...words], {
    env: { ...process.env, LCM_DEFAULT_URL: 'memq://' },
    stdio: ['ignore', 'pipe', 'inherit'],
  });
  child.on('error', () => undefined);
  if (!(await told(child, /^ready$/))) return null;
  const server = relay(() => connect(socket)).listen(0, '127.0.0.1');
  await once(server, 'listening');
  const end = async () => {
    server.close();
    const ended = once(child, 'exit');
    child.kill();
    await ended;
  };
  return { address: `http://127.0.0.1:${server.address().port}/`, end };
}

if (process.argv[1] === file) await inside(process.argv.slice(2));
