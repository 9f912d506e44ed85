// SPDX-License-Identifier: GPL-3.0-or-later
// Where the mock's instruments and clips are.
import { sac } from './artery.mjs';
import { add, cross, dot, ramp, scale, sub, unit } from './vec.mjs';

/** A clip across the neck: blades along the neck plane, opening across. */
export function clipSeat(scene, at) {
  const axis = unit(sub(scale(sac), at));
  // The shaft comes out of the wound.
  const z = unit(add(scene.out, axis, -dot(scene.out, axis) * 0.85));
  const x = unit(add(axis, z, -dot(axis, z)));
  return { across: x, p: add(at, z, -0.0042), q: frameQuaternion(z, x) };
}

export function toolFrame(scene, lcm, tool, { time, spread, held, left, theatre, seat }) {
  if (tool.kind !== 'clip') {
    const hand = tool.hand === 'left' ? 0 : 1;
    const t = toolPose(scene, lcm, hand, time, spread, held?.[hand], left);
    t.index = tool.index;
    t.state = theatre.inHand[tool.hand] === tool.id ? 1 : 0;
    return t;
  }
  const t = lcm.render_tool_t.make();
  Object.assign(t, { index: tool.index, hand: -1, state: 0 });
  t.q = Float64Array.from([1, 0, 0, 0]);
  if (theatre.free.includes(tool.id)) {
    t.state = 2;
    const parent = tool.id.includes('temporary');
    t.p_m = Float64Array.from(parent ? add(scale([43.4, 14.6, -14.4]), scene.out, -0.003) : seat.p);
    t.q = Float64Array.from(parent ? frameQuaternion(scene.out, scene.along) : seat.q);
    t.opening_rad = 0.06;
  } else if (theatre.loaded === tool.id && theatre.inHand.right === 'right_clip_applier') {
    const holder = toolPose(scene, lcm, 1, time, spread, held?.[1], left);
    Object.assign(t, { state: 1, hand: 1 });
    const z = rotate([...holder.q], [0, 0, 1]);
    t.p_m = Float64Array.from(add([...holder.p_m], z, -(tool.hinges[0].origin[2] + 0.002)));
    t.q = holder.q;
    t.opening_rad = holder.button1 ? 0.24 : 0.1 + 0.1 * Math.sin(time);
  }
  t.device_p_m = t.p_m;
  return t;
}

function rotate([w, x, y, z], v) {
  const u = [x, y, z];
  const c = cross(u, v).map((a, k) => a + w * v[k]);
  const d = cross(u, c);
  return v.map((a, k) => a + 2 * d[k]);
}

function toolPose(scene, lcm, hand, time, spread, held, left) {
  const { out, open, along } = scene;
  const t = lcm.render_tool_t.make();
  t.index = hand;
  t.hand = hand;
  let p;
  let q;
  if (held) {
    p = [...held.p_m];
    q = [...held.q];
  } else {
    const side = hand === 0 ? -1 : 1;
    const deep = hand === 0 ? -0.004 : -0.002 - 0.01 * ramp(time, 5, 22);
    p = add(
      add(add(scale(sac), out, deep + 0.008), along, side * 0.009 + (hand ? 0.006 * Math.sin(time * 0.9) : -0.002)),
      open,
      hand === 0 ? spread * 0.8 - 0.001 : 0.0006 * Math.sin(time * 7),
    );
    // Shaft: out of the wound, leaning to its own side and towards the surgeon.
    const z = unit(
      add(
        add(
          out.map((x) => x * 0.9),
          along,
          -along[0] * 0 + side * -0.42 * Math.sign(dot(along, [0, 1, 0])) * (hand === 0 ? 1 : 1),
        ),
        open,
        -0.35,
      ),
    );
    q = frameQuaternion(z, open);
  }
  t.p_m = Float64Array.from(p);
  t.q = Float64Array.from(q);
  t.device_p_m = Float64Array.from(p);
  t.force_N = Float64Array.from([
    0.05 + 0.04 * Math.sin(time * 2),
    hand === 0 ? 8 * spread : 0.05 * Math.abs(Math.sin(time * 5)),
    0,
  ]);
  t.button1 = held?.button1 ? 1 : 0;
  t.activity = left > 0 ? 1 : 0;
  return t;
}

/** w x y z of the rotation whose z axis is z and whose x axis is nearest to x. */
function frameQuaternion(z, x) {
  const xx = unit(add(x, z, -dot(x, z)));
  const y = cross(z, xx);
  const m = [xx, y, z]; // columns
  const [m00, m11, m22] = [xx[0], y[1], z[2]];
  const w = Math.sqrt(Math.max(0, 1 + m00 + m11 + m22)) / 2;
  if (w > 1e-3) return [w, (y[2] - z[1]) / (4 * w), (z[0] - xx[2]) / (4 * w), (xx[1] - y[0]) / (4 * w)];
  const i = m00 > m11 && m00 > m22 ? 0 : m11 > m22 ? 1 : 2;
  const j = (i + 1) % 3;
  const k = (i + 2) % 3;
  const r = Math.sqrt(1 + m[i][i] - m[j][j] - m[k][k]);
  const q = [0, 0, 0, 0];
  q[1 + i] = r / 2;
  q[0] = (m[j][k] - m[k][j]) / (2 * r);
  q[1 + j] = (m[i][j] + m[j][i]) / (2 * r);
  q[1 + k] = (m[i][k] + m[k][i]) / (2 * r);
  return q;
}
