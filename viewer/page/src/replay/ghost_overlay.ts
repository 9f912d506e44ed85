// SPDX-License-Identifier: GPL-3.0-or-later
// The tools of a recorded run over the live exercise, if a page names such a run. Its code is loaded only then.
import type { Scene } from 'three';
import type { Bundle } from '../bundle_types';
import { text } from '../languages/text';
import type { RenderFrame } from '../lcm';
import type { RunGhost } from './run_ghost';

export class GhostOverlay {
  private ghost: RunGhost | null = null;

  /** name: the recorded run; '' for none. refuse: gets the reason in words when it cannot be shown. */
  constructor(name: string, scene: Scene, refuse: (why: string) => void) {
    if (name === '') return;
    import('./live_ghost')
      .then((m) => m.openGhost(name))
      .then((run) => scene.add((this.ghost = run).root))
      .catch((e: unknown) => refuse(text('No ghost of {name}: {why}', { name, why: String(e) })));
  }

  /** Moves the tools to the frame's time. Returns how many of them are shown. */
  show(bundle: Bundle | null, frame: RenderFrame | null): number {
    if (bundle && frame) this.ghost?.show(bundle, frame.sim_time_s);
    return this.ghost?.shown ?? 0;
  }
}
