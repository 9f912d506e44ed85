// SPDX-License-Identifier: GPL-3.0-or-later
// A log of a made-up engine, as lcm-logger would write it, which `insula replay` plays to a bus; with its bundle.
import { mkdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { makeFrame } from '../scripts/mock/frame.mjs';
import { loadLcm } from '../scripts/mock/lcm.mjs';
import { makeScene } from '../scripts/mock/scene.mjs';
import { Theatre } from '../scripts/mock/theatre.mjs';

const meshes = fileURLToPath(new URL('../../../meshes', import.meta.url));
const sync = 0xeda1da01;

/** An event of the log; timeUs: since 1970. */
function event(number, timeUs, channel, message) {
  const head = Buffer.alloc(28);
  head.writeUInt32BE(sync, 0);
  head.writeBigInt64BE(BigInt(number), 4);
  head.writeBigInt64BE(BigInt(timeUs), 12);
  head.writeInt32BE(channel.length, 20);
  head.writeInt32BE(message.length, 24);
  return Buffer.concat([head, Buffer.from(channel, 'latin1'), message]);
}

/** Writes `seconds` of an engine with a fault in the middle, `rate` frames a second. Gives a function of a title. */
export async function recorder({ folder, seconds, rate }) {
  const lcm = await loadLcm();
  const scene = makeScene(meshes);
  const bundle = join(folder, 'bundle');
  mkdirSync(bundle);
  for (const [name, bytes] of scene.files) writeFileSync(join(bundle, name), bytes);
  const session = 7n;
  writeFileSync(join(bundle, 'scene.json'), JSON.stringify({ ...scene.json, session: Number(session) }));
  const theatre = new Theatre(
    scene.clips.map((c) => c.id),
    {},
  );
  theatre.step(0, 0);
  const state = {
    mode: '',
    outcome: '',
    report: '',
    recording: '',
    unrecorded: '',
    malformed: false,
    held: [null, null],
  };
  const frames = Array.from({ length: seconds * rate }, (_, k) => {
    const f = makeFrame(scene, lcm, k / rate, [null, null], theatre, state);
    return Object.assign(f, { session, sequence: BigInt(k), sim_time_s: k / rate, time_us: BigInt(k) });
  });
  return (title) => {
    const events = [];
    const put = (atS, channel, bytes) =>
      events.push(event(events.length, 1e15 + Math.round(atS * 1e6), channel, Buffer.from(bytes)));
    const info = { ...lcm.scene_info_t.make(), session, scene: 'recorded', title, bundle, state: 'running' };
    frames.forEach((f, k) => {
      if (k % rate === 0) put(k / rate, 'SCENE_INFO', lcm.scene_info_t.encode(info));
      put(k / rate, 'RENDER_FRAME', lcm.render_frame_t.encode(f));
      if (k !== Math.floor(frames.length / 2)) return;
      const fault = { session, sim_time_s: k / rate, kind: 'fault', id: 'torn', text: `torn at ${title}` };
      put(k / rate, 'SIM_EVENT', lcm.sim_event_t.encode({ ...lcm.sim_event_t.make(), ...fault }));
    });
    const file = join(folder, `${title.replaceAll(' ', '_')}.log`);
    writeFileSync(file, Buffer.concat(events));
    return file;
  };
}
