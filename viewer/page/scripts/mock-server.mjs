// SPDX-License-Identifier: GPL-3.0-or-later
// Stands in for engine and gateway: serves dist/, a synthetic bundle and animated frames on /ws, obeys commands and hand
// input. node scripts/mock-server.mjs [--port 8080] [--start SECONDS] [--script '{"rupture": 8, "dye": 5, "clip": 6, "temporary": 7}']
import { createServer } from 'node:http';
import { existsSync, readFileSync } from 'node:fs';
import { dirname, extname, join, normalize } from 'node:path';
import { fileURLToPath } from 'node:url';
import { WebSocketServer } from 'ws';
import { load_lcm } from './mock/lcm.mjs';
import { make_frame, make_scene } from './mock/scene.mjs';
import { Theatre } from './mock/theatre.mjs';

const here = dirname(fileURLToPath(import.meta.url));
const types = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.json': 'application/json', '.bin': 'application/octet-stream', '.svg': 'image/svg+xml' };

export async function start_mock({ port = 8080, start_s = 0, script = {}, dist = join(here, '../dist'), meshes = join(here, '../../../meshes') } = {}) {
  const lcm = await load_lcm();
  const scene = make_scene(meshes);
  const theatre = new Theatre(scene.clips.map((c) => c.id), script);
  const state = { theatre, session: BigInt(Date.now()) * 1000n, time: start_s, paused: false, sequence: 0n, held: [null, null], commands: [], inputs: 0 };

  const server = createServer((request, response) => {
    const path = decodeURIComponent(new URL(request.url, 'http://x').pathname);
    const reply = (code, type, body) => { response.writeHead(code, { 'content-type': type, 'cache-control': 'no-store' }); response.end(body); };
    const bundle = /^\/bundle\/(\d+)\/([\w.-]+)$/.exec(path);
    if (bundle && bundle[1] === state.session.toString()) {
      if (bundle[2] === 'scene.json') return reply(200, 'application/json', JSON.stringify({ ...scene.json, session: Number(state.session) }));
      const data = scene.files.get(bundle[2]);
      return data ? reply(200, types[extname(bundle[2])], data) : reply(404, 'text/plain', 'not found');
    }
    const file = join(dist, normalize(path === '/' ? '/index.html' : path));
    if (!file.startsWith(dist) || !existsSync(file)) return reply(404, 'text/plain', 'not found');
    return reply(200, types[extname(file)] ?? 'application/octet-stream', readFileSync(file));
  });

  const sockets = new WebSocketServer({ server, path: '/ws' });
  const frame_packet = (channel, payload) => Buffer.concat([Buffer.from([channel.length]), Buffer.from(channel, 'latin1'), payload]);
  const broadcast = (channel, payload) => {
    const packet = frame_packet(channel, payload);
    for (const s of sockets.clients) if (s.readyState === 1 && s.bufferedAmount < 1e6) s.send(packet);
  };
  const scene_info = () => Object.assign(lcm.scene_info_t.make(), { session: state.session, scene: 'mock', title: scene.json.title, bundle: '/mock', state: state.paused ? 'paused' : 'running' });
  sockets.on('connection', (socket) => {
    socket.send(frame_packet('SCENE_INFO', lcm.scene_info_t.encode(scene_info())));
    socket.on('message', (data) => {
      const bytes = new Uint8Array(data);
      const name = Buffer.from(bytes.subarray(1, 1 + bytes[0])).toString('latin1');
      const payload = bytes.subarray(1 + bytes[0]);
      if (name === 'USER_COMMAND') {
        const c = lcm.user_command_t.decode(payload);
        state.commands.push(c.argument ? `${c.command} ${c.argument}` : c.command);
        if (c.command === 'pause') state.paused = true;
        if (c.command === 'resume') state.paused = false;
        if (c.command === 'reset') { state.time = 0; state.held = [null, null]; theatre.reset(); }
        if (['exchange', 'ask', 'message'].includes(c.command)) theatre.run(c.command, c.argument);
      } else if (name === 'HAND_INPUT') {
        const h = lcm.hand_input_t.decode(payload);
        state.inputs++;
        if (h.hand === 0 || h.hand === 1) state.held[h.hand] = h;
      }
    });
  });

  theatre.step(state.time, 0);
  let last = performance.now();
  let since_status = 0;
  const timer = setInterval(() => {
    const now = performance.now();
    const dt = (now - last) / 1000;
    last = now;
    if (!state.paused) state.time += dt;
    if (!state.paused) theatre.step(state.time, dt);
    for (const said of theatre.said.splice(0)) {
      const e = Object.assign(lcm.sim_event_t.make(), said, { session: state.session, sequence: state.sequence, sim_time_s: state.time, value: 0 });
      broadcast('SIM_EVENT', lcm.sim_event_t.encode(e));
    }
    if (sockets.clients.size === 0) return;
    const f = make_frame(scene, lcm, state.time, state.held, theatre);
    if (!state.held[0]) state.last_tool = [...f.tool[0].p_m];
    f.session = state.session;
    f.sequence = state.sequence++;
    f.time_us = BigInt(Math.round(now * 1000));
    f.paused = state.paused;
    broadcast('RENDER_FRAME', lcm.render_frame_t.encode(f));
    since_status += dt;
    if (since_status < 1) return;
    since_status = 0;
    broadcast('SCENE_INFO', lcm.scene_info_t.encode(scene_info()));
    const h = lcm.haptic_status_t.make();
    h.ticks_per_s = 1000;
    h.fresh_forces_per_s = Float64Array.from([988, 991]);
    h.rows = 120;
    broadcast('HAPTIC_STATUS', lcm.haptic_status_t.encode(h));
  }, 1000 / 60);

  await new Promise((resolve, reject) => { server.once('error', reject); server.listen(port, '127.0.0.1', resolve); });
  return {
    url: `http://127.0.0.1:${server.address().port}/`, state,
    stop: () => new Promise((resolve) => { clearInterval(timer); for (const s of sockets.clients) s.terminate(); server.close(resolve); server.closeAllConnections(); }),
  };
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const option = (name, otherwise) => { const i = process.argv.indexOf(name); return i < 0 ? otherwise : JSON.parse(process.argv[i + 1]); };
  const mock = await start_mock({ port: option('--port', 8080), start_s: option('--start', 0), script: option('--script', {}) });
  console.log(mock.url);
}
