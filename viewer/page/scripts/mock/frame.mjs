// SPDX-License-Identifier: GPL-3.0-or-later
// One frame of the made-up session: lobes drawn apart, a beating artery, fibres that part, tools, channels and
// drawables.
import { moveArtery, neck, sac } from './artery.mjs';
import { channelNumbers, drawableNumbers } from './step_data.mjs';
import { clipSeat, toolFrame } from './tool_frames.mjs';
import { dot, ramp, scale, sub } from './vec.mjs';

/** The lobes' nodes: the fissure opens, over the aneurysm wider. */
function moveLobe(scene, b, time, spread) {
  const { centre, out, open, along } = scene;
  const over = scale(sac);
  const wide = 0.013 * ramp(time, 1.5, 14);
  const upper = b.id === 'frontal';
  const x = Float32Array.from(b.rest);
  const bell = (v, width) => Math.exp(-(v * v) / (2 * width ** 2));
  for (let i = 0; i < x.length; i += 3) {
    const p = [b.rest[i], b.rest[i + 1], b.rest[i + 2]];
    const d = sub(p, centre);
    const e = sub(p, over);
    const fall = bell(dot(d, along), 0.012) * bell(dot(d, open), 0.011) * ramp(dot(d, out), -0.03, 0.004);
    const near = bell(dot(e, along), 0.011) * bell(dot(e, open), 0.012) * ramp(dot(e, out), -0.016, -0.004);
    const by = (upper ? 1 : -0.75) * spread * fall + (upper ? 1 : -1) * wide * near;
    for (let k = 0; k < 3; k++) x[i + k] += open[k] * by - out[k] * 0.25 * spread * fall;
  }
  return x;
}

/** Both ends and the wholeness (below 0: parted) of each fibre. */
function fibresAt(scene, moved, time) {
  const at = (b, v) => {
    const { nodes, weights } = scene.bodies[b].skin;
    return [0, 1, 2].map((j) =>
      [0, 1, 2, 3].reduce((sum, k) => sum + weights[v * 4 + k] * moved[b][nodes[v * 4 + k] * 3 + j], 0),
    );
  };
  return scene.fibres.map((s) => {
    const whole = time >= s.cutAt ? -1 : 1 - ramp(time, s.cutAt - 1.2, s.cutAt);
    return { p: at(0, s.va), q: at(1, s.vb), whole, rest: s.length };
  });
}

/**
 * `held` are poses asked for by a page, `theatre` knows what geometry does not. malformed: drawables that no page can
 * draw.
 */
export function makeFrame(
  scene,
  lcm,
  time,
  held,
  theatre,
  { malformed = false, mode = '', outcome = '', report = '', recording = '', unrecorded = '' } = {},
) {
  const { bodies, artery } = scene;
  const spread = 0.0085 * ramp(time, 1.5, 14) + 0.0004 * Math.sin(time * 6.3);
  const moved = bodies.map((b) => moveLobe(scene, b, time, spread));
  const squeeze = theatre.placedAt === null ? 0 : ramp(time, theatre.placedAt - 0.3, theatre.placedAt + 0.1);
  const seat = clipSeat(scene, scale(neck));
  moved.push(moveArtery(artery, theatre.pulse, theatre.tension, squeeze, seat.across));
  const fibres = fibresAt(scene, moved, time);
  const left = fibres.filter((s) => s.whole >= 0).length;
  const n = fibres.length;
  const f = lcm.render_frame_t.make();
  f.sim_time_s = time;
  f.bodies = bodies.length + 1;
  f.body = [...bodies, artery].map((b, k) => ({ index: b.index, nodes: moved[k].length / 3, x_m: moved[k] }));
  f.channel = Float32Array.from(channelNumbers(scene, theatre, { time, fibres }));
  f.channels = f.channel.length;
  f.drawable = drawableNumbers(scene, theatre, { time, fibres }).map((data, index) => {
    const numbers = malformed ? [...data, NaN] : data;
    return { index, floats: numbers.length, data: Float32Array.from(numbers) };
  });
  f.drawables = f.drawable.length;
  f.tool = scene.tools.map((tool) => toolFrame(scene, lcm, tool, { time, spread, held, left, theatre, seat }));
  f.tools = f.tool.length;
  f.step_ms = 4.2 + Math.sin(time);
  f.step_period_ms = 1000 / 60;
  f.rows = 120;
  f.sweeps = 12;
  f.body_force_N = Float64Array.from([0.1, 0.08, 0]);
  f.hud_json = JSON.stringify({
    goals: scene.goals.map((g, k) => ({ ...g, done: [left < n * 0.7, left < n * 0.3, left < n * 0.1][k] })),
    faults: scene.faults.map((x, k) => ({
      ...x,
      ...(k === 0 && time > 10 ? { count: 1, times_s: [10], advice: 'Hold more gently' } : { count: 0 }),
    })),
    message: '',
    state: outcome || (left < n * 0.1 && theatre.placedAt !== null ? 'done' : 'running'),
    mode,
    report,
    recording,
    unrecorded,
    elapsed_s: time,
    ...theatre.hud(),
  });
  return f;
}
