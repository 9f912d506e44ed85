// SPDX-License-Identifier: GPL-3.0-or-later
// What a suction tube draws where its tip is: fluid below the surface of a pool, what closes its opening, or air. What
// it has sucked on lies on its rim, so a contact there says that it is closed.
import * as THREE from 'three';
import type { Bundle } from '../bundle_types';
import { toolState } from '../hand_tool';
import type { RenderFrame } from '../lcm';
import { isPool, suctionKinds } from './table';
import type { Drawn } from './voices/suction';

/** A contact this near to the tip closes the opening: its radius and a little more, m. */
const rimM = 0.0018;
/** Weaker contacts do not count, N. */
const leastN = 0.005;
/** Contacts flicker from step to step: without one it is closed for so long, s. */
const holdS = 0.15;

type Field = Pick<RenderFrame, 'sim_time_s' | 'drawable' | 'contact_N' | 'contact_x_m'>;

/** Whether a place lies in a pool: origin, normal and radius of its surface, eight numbers with its value. */
export function below(pool: Float32Array, place: THREE.Vector3): boolean {
  const radius = pool[6] ?? 0;
  if (!(radius > 0)) return false;
  const from = new THREE.Vector3(place.x - pool[0]!, place.y - pool[1]!, place.z - pool[2]!);
  const height = from.x * pool[3]! + from.y * pool[4]! + from.z * pool[5]!;
  return height < 0 && from.lengthSq() - height * height < radius * radius;
}

function touched({ contact_N: force, contact_x_m: x }: Field, tip: THREE.Vector3): boolean {
  return force.some(
    (f, i) => f >= leastN && Math.hypot(x[3 * i]! - tip.x, x[3 * i + 1]! - tip.y, x[3 * i + 2]! - tip.z) < rimM,
  );
}

export class Surroundings {
  private readonly tubes: ReadonlySet<number>;
  private readonly pools: ReadonlySet<number>;
  /** By tube, when its opening was closed last, s. */
  private readonly closedS = new Map<number, number>();

  constructor(bundle: Pick<Bundle, 'tools' | 'drawables' | 'materials'>) {
    this.tubes = new Set(bundle.tools.filter((t) => suctionKinds.has(t.kind)).map((t) => t.index));
    const pools = bundle.drawables.filter((d) => isPool(d.declared, bundle.materials));
    this.pools = new Set(pools.map((d) => d.declared.index));
  }

  /** What the tubes that suck draw. A tube in fluid is heard over one in air, and closed ones are the quietest. */
  drawn(frame: Field & Pick<RenderFrame, 'tool'>): Drawn | null {
    const sucking = frame.tool.filter((t) => this.tubes.has(t.index) && t.state === toolState.inHand && t.activity > 0);
    const each = sucking.map((t) => this.at(frame, t.index, new THREE.Vector3(t.p_m[0], t.p_m[1], t.p_m[2])));
    return (['fluid', 'air', 'tissue'] as const).find((d) => each.includes(d)) ?? null;
  }

  private at(frame: Field, tube: number, tip: THREE.Vector3): Drawn {
    // A tube in a pool empties it, whatever it touches there.
    if (frame.drawable.some((d) => this.pools.has(d.index) && below(d.data, tip))) return 'fluid';
    const now = frame.sim_time_s;
    if (touched(frame, tip)) this.closedS.set(tube, now);
    const sinceS = now - (this.closedS.get(tube) ?? -Infinity);
    return sinceS >= 0 && sinceS < holdS ? 'tissue' : 'air';
  }
}
