// SPDX-License-Identifier: GPL-3.0-or-later
// What a suction tube draws where its tip is: fluid below the surface of a pool, tissue that closes its opening, or
// air.
import * as THREE from 'three';
import type { Bundle } from '../bundle_types';
import { toolState } from '../hand_tool';
import type { RenderFrame } from '../lcm';
import { isPool, suctionKinds } from './table';
import type { Drawn } from './voices/suction';

/** Tissue this near closes the opening, m. */
const closedM = 0.0006;
/** The search for tissue takes a while: it is asked so seldom, s of the simulation. */
const everyS = 0.05;
/** Whether tissue lies within a reach of a place, m. */
export type TissueNear = (place: THREE.Vector3, reach: number) => boolean;

/** Whether a place lies in a pool: origin, normal and radius of its surface, eight numbers with its value. */
export function below(pool: Float32Array, place: THREE.Vector3): boolean {
  const radius = pool[6] ?? 0;
  if (!(radius > 0)) return false;
  const from = new THREE.Vector3(place.x - pool[0]!, place.y - pool[1]!, place.z - pool[2]!);
  const height = from.x * pool[3]! + from.y * pool[4]! + from.z * pool[5]!;
  return height < 0 && from.lengthSq() - height * height < radius * radius;
}

export class Surroundings {
  private readonly tubes: ReadonlySet<number>;
  private readonly pools: ReadonlySet<number>;
  private askedS = -Infinity;
  private last: Drawn | null = null;

  constructor(
    bundle: Pick<Bundle, 'tools' | 'drawables' | 'materials'>,
    private readonly tissue: TissueNear,
  ) {
    this.tubes = new Set(bundle.tools.filter((t) => suctionKinds.has(t.kind)).map((t) => t.index));
    const pools = bundle.drawables.filter((d) => isPool(d.declared, bundle.materials));
    this.pools = new Set(pools.map((d) => d.declared.index));
  }

  /** What the tubes that suck draw. A tube in fluid is heard over one in air, and closed ones are the quietest. */
  drawn(frame: Pick<RenderFrame, 'tool' | 'drawable' | 'sim_time_s'>): Drawn | null {
    const sucking = frame.tool.filter((t) => this.tubes.has(t.index) && t.state === toolState.inHand && t.activity > 0);
    const sinceS = frame.sim_time_s - this.askedS;
    if (sucking.length > 0 && this.last && sinceS >= 0 && sinceS < everyS) return this.last;
    this.askedS = frame.sim_time_s;
    const each = sucking.map((t) => this.at(frame, new THREE.Vector3(t.p_m[0], t.p_m[1], t.p_m[2])));
    return (this.last = (['fluid', 'air', 'tissue'] as const).find((d) => each.includes(d)) ?? null);
  }

  private at(frame: Pick<RenderFrame, 'drawable'>, tip: THREE.Vector3): Drawn {
    // A tube in a pool empties it, whatever it touches there.
    if (frame.drawable.some((d) => this.pools.has(d.index) && below(d.data, tip))) return 'fluid';
    return this.tissue(tip, closedM) ? 'tissue' : 'air';
  }
}
