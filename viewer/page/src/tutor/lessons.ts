// SPDX-License-Identifier: GPL-3.0-or-later
// What helps a trainee on the page: the cues of the tutor with their menu, and the first-use tour.
import type * as THREE from 'three';
import type { Bundle } from '../bundle_types';
import type { Microscope } from '../camera';
import { softGuide, type UserCommand } from '../hud/commands';
import type { Hud } from '../hud/hud';
import type { HudState } from '../hud/state';
import type { RenderFrame, SimEvent } from '../lcm';
import type { Sound } from '../sound/sound';
import { status } from '../status';
import { Tutorial } from '../tutorial/tutorial';
import { TutorCues } from './tutor';
import { TutorMenu } from './tutor_menu';

interface Place {
  hud: Hud;
  canvas: HTMLElement;
  scene: THREE.Scene;
  scope: Microscope;
  sound: Sound;
  mayDrive: boolean;
  run: (c: UserCommand) => void;
}

export class Lessons {
  private readonly cues: TutorCues;
  private readonly menu: TutorMenu;
  private readonly tutorial: Tutorial;
  private bundle: Bundle | null = null;

  constructor(private readonly place: Place) {
    const { hud, canvas, scene, scope, sound } = place;
    this.cues = new TutorCues((now) => sound.hint(now));
    this.menu = new TutorMenu({
      cues: (c) => this.cues.choose(c),
      sound: (c) => sound.choose(c),
      softGuide: (on) => place.run(softGuide(on)),
    });
    this.tutorial = new Tutorial(scope, canvas);
    this.menu.root.append(this.tutorial.panel.button);
    this.menu.root.hidden = !place.mayDrive;
    hud.beside.append(this.menu.root);
    hud.toasts.root.append(this.cues.line.root);
    hud.under.prepend(this.tutorial.panel.root);
    scene.add(this.cues.arrow.root);
  }

  hear(e: Pick<SimEvent, 'kind'>): void {
    this.tutorial.hear(e);
  }

  update(frame: RenderFrame | null, bundle: Bundle | null, state: HudState | null, nowMs: number): void {
    const { mayDrive, scope, sound } = this.place;
    if (bundle && bundle !== this.bundle) this.tutorial.begin(bundle);
    this.bundle = bundle;
    const tutor = mayDrive ? (state?.tutor ?? null) : null;
    this.cues.update({ frame, bundle, tutor, sight: scope.sight, nowMs });
    this.menu.show(this.cues.choice, sound.settings);
    this.menu.showForce(state?.mode === 'practice' ? state.tutor.softGuide : null);
    const practises = mayDrive && state?.mode === 'practice' && state.state === 'running';
    this.tutorial.update(frame, practises, nowMs);
    status.cue = this.cues.shown?.id ?? '';
    status.tour = this.tutorial.panel.root.hidden ? '' : (this.tutorial.panel.root.dataset.step ?? '');
  }
}
