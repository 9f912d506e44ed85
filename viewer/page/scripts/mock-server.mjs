// SPDX-License-Identifier: GPL-3.0-or-later
// Stands in for engine and gateway: serves dist/, a synthetic bundle and animated frames on /ws, obeys commands and
// hand input. node scripts/mock-server.mjs [--port 8080] [--start SECONDS] [--script '{"rupture": 8, "dye": 5,
// "clip": 6, "temporary": 7}']
import { createServer } from 'node:http';
import { existsSync, readFileSync } from 'node:fs';
import { dirname, extname, join, normalize } from 'node:path';
import { fileURLToPath } from 'node:url';
import { WebSocketServer } from 'ws';
import { loadLcm } from './mock/lcm.mjs';
import { makeFrame } from './mock/frame.mjs';
import { makeScene } from './mock/scene.mjs';
import { Theatre } from './mock/theatre.mjs';

const here = dirname(fileURLToPath(import.meta.url));
const types = {
  '.html': 'text/html',
  '.js': 'text/javascript',
  '.css': 'text/css',
  '.json': 'application/json',
  '.bin': 'application/octet-stream',
  '.svg': 'image/svg+xml',
};

/** Serves dist/ and the bundle. */
function serve(scene, state, dist) {
  return createServer((request, response) => {
    const path = decodeURIComponent(new URL(request.url, 'http://x').pathname);
    const reply = (code, type, body) => {
      response.writeHead(code, { 'content-type': type, 'cache-control': 'no-store' });
      response.end(body);
    };
    const bundle = /^\/bundle\/(\d+)\/([\w.-]+)$/.exec(path);
    if (bundle && bundle[1] === state.session.toString()) {
      if (bundle[2] === 'scene.json')
        return reply(200, 'application/json', JSON.stringify({ ...scene.json, session: Number(state.session) }));
      const data = scene.files.get(bundle[2]);
      return data ? reply(200, types[extname(bundle[2])], data) : reply(404, 'text/plain', 'not found');
    }
    // The picture for the overview of a room, which nobody looks at here.
    if (request.method === 'PUT' && path === '/api/station/picture') return reply(204, 'text/plain', '');
    const file = join(dist, normalize(path === '/' ? '/index.html' : path));
    if (!file.startsWith(dist) || !existsSync(file)) return reply(404, 'text/plain', 'not found');
    return reply(200, types[extname(file)] ?? 'application/octet-stream', readFileSync(file));
  });
}

/** What a page sends: commands and hand poses. */
function receive(lcm, state, data) {
  const bytes = new Uint8Array(data);
  const name = Buffer.from(bytes.subarray(1, 1 + bytes[0])).toString('latin1');
  const payload = bytes.subarray(1 + bytes[0]);
  if (name === 'USER_COMMAND') {
    const c = lcm.user_command_t.decode(payload);
    state.commands.push(c.argument ? `${c.command} ${c.argument}` : c.command);
    if (c.command === 'pause') state.paused = true;
    if (c.command === 'resume') state.paused = false;
    if (c.command === 'begin') Object.assign(state, { mode: c.argument, paused: false });
    if (c.command === 'release') state.held[c.argument === 'left' ? 0 : 1] = null;
    if (c.command === 'reset' || c.command === 'begin') {
      state.time = 0;
      state.held = [null, null];
      state.theatre.reset();
      state.theatre.say('reset', '', '');
    }
    if (['exchange', 'ask', 'message'].includes(c.command)) state.theatre.run(c.command, c.argument);
  } else if (name === 'HAND_INPUT') {
    const h = lcm.hand_input_t.decode(payload);
    state.inputs++;
    if (h.hand === 0 || h.hand === 1) state.held[h.hand] = h;
  }
}

const framePacket = (channel, payload) =>
  Buffer.concat([Buffer.from([channel.length]), Buffer.from(channel, 'latin1'), payload]);

/** Both arms where the tools of a frame are. */
const deviceState = (lcm, frame) => {
  const hand = frame.tool.slice(0, 2).map((t, k) => ({
    ...{ ...lcm.hand_state_t.make(), hand: k, device: 'simulated', connected: true },
    ...{ p_m: t.p_m, q: t.q },
  }));
  return lcm.device_state_t.encode({ ...lcm.device_state_t.make(), hands: hand.length, hand });
};

/** The engine's clock: events and frames sixty times a second, its state once. Returns the timer. */
function play(scene, lcm, state, sockets, sceneInfo) {
  const broadcast = (channel, payload) => {
    const packet = framePacket(channel, payload);
    for (const s of sockets.clients) if (s.readyState === 1 && s.bufferedAmount < 1e6) s.send(packet);
  };
  const { theatre } = state;
  let last = performance.now();
  let sinceStatus = 0;
  return setInterval(() => {
    const now = performance.now();
    const dt = (now - last) / 1000;
    last = now;
    if (state.mode === 'waiting') state.paused = true;
    if (!state.paused && !state.frozen) {
      state.time += dt;
      theatre.step(state.time, dt);
    }
    const at = { session: state.session, sequence: state.sequence, sim_time_s: state.time, value: 0 };
    for (const said of theatre.said.splice(0))
      broadcast('SIM_EVENT', lcm.sim_event_t.encode(Object.assign(lcm.sim_event_t.make(), said, at)));
    if (sockets.clients.size === 0) return;
    const f = makeFrame(scene, lcm, state.time, state.held, theatre, state);
    if (!state.held[0]) state.lastTool = [...f.tool[0].p_m];
    const { session, paused } = state;
    Object.assign(f, { session, paused, sequence: state.sequence++, time_us: BigInt(Math.round(now * 1000)) });
    if (!state.silent) broadcast('RENDER_FRAME', lcm.render_frame_t.encode(f));
    const metrics = { ...lcm.metrics_t.make(), session, time_us: f.time_us, sim_time_s: state.time };
    metrics.at_end = state.outcome !== '';
    metrics.json = JSON.stringify(theatre.metrics());
    if (!state.silent) broadcast('METRICS', lcm.metrics_t.encode(metrics));
    broadcast('DEVICE_STATE', deviceState(lcm, f));
    sinceStatus += dt;
    if (sinceStatus < 1) return;
    sinceStatus = 0;
    broadcast('SCENE_INFO', lcm.scene_info_t.encode(sceneInfo()));
    const fresh = Float64Array.from([988, 991]);
    const status = { ...lcm.haptic_status_t.make(), ticks_per_s: 1000, fresh_forces_per_s: fresh, rows: 120 };
    broadcast('HAPTIC_STATUS', lcm.haptic_status_t.encode(status));
  }, 1000 / 60);
}

/** samples: one drawable of each kind beside the usual ones. mode: of the session; "waiting" asks the page for one. */
export async function startMock({
  port = 8080,
  startS = 0,
  script = {},
  samples = false,
  mode = '',
  dist = join(here, '../dist'),
  meshes = join(here, '../../../meshes'),
} = {}) {
  const lcm = await loadLcm();
  const scene = makeScene(meshes, samples);
  const theatre = new Theatre(
    scene.clips.map((c) => c.id),
    script,
  );
  const state = { theatre, session: BigInt(Date.now()) * 1000n, time: startS, paused: false, sequence: 0n };
  Object.assign(state, {
    held: [null, null],
    commands: [],
    inputs: 0,
    malformed: false,
    silent: false,
    mode,
    outcome: '',
    report: '',
    recording: '',
    unrecorded: '',
  });
  const server = serve(scene, state, dist);
  const sockets = new WebSocketServer({ server, path: '/ws' });
  const sceneInfo = () => ({
    ...lcm.scene_info_t.make(),
    ...{ session: state.session, scene: 'mock', title: scene.json.title, bundle: '/mock' },
    state: state.paused ? 'paused' : 'running',
  });
  sockets.on('connection', (socket) => {
    socket.send(framePacket('SCENE_INFO', lcm.scene_info_t.encode(sceneInfo())));
    socket.on('message', (data) => receive(lcm, state, data));
  });
  theatre.step(state.time, 0);
  const timer = play(scene, lcm, state, sockets, sceneInfo);
  await new Promise((resolve, reject) => {
    server.once('error', reject);
    server.listen(port, '127.0.0.1', resolve);
  });
  const stop = () =>
    new Promise((resolve) => {
      clearInterval(timer);
      for (const s of sockets.clients) s.terminate();
      server.close(resolve);
      server.closeAllConnections();
    });
  return { url: `http://127.0.0.1:${server.address().port}/`, state, stop };
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const option = (name, otherwise) => {
    const i = process.argv.indexOf(name);
    return i < 0 ? otherwise : JSON.parse(process.argv[i + 1]);
  };
  const mock = await startMock({
    port: option('--port', 8080),
    startS: option('--start', 0),
    script: option('--script', {}),
  });
  console.log(mock.url);
}
