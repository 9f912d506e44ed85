// SPDX-License-Identifier: GPL-3.0-or-later
// How the field is looked at: quality, stereo and its angle, infrared, headset.
import { sentence, spoken } from '../bundle';
import type { CommandData } from '../bundle_types';
import type { RulerMode } from '../depth_ruler';
import { levels } from '../quality';
import { angleRangeDeg, stereoModes, type StereoMode } from '../stereo';
import { ask, type UserCommand } from './commands';
import { el, setText } from './dom';

export interface ViewActions {
  quality(name: string): void;
  stereo(mode: StereoMode): void;
  angle(deg: number): void;
  infrared(on: boolean): void;
  nextRuler(): void;
  /** Asks for a command of the scene. */
  run(command: UserCommand): void;
}

const stereoNames: Record<StereoMode, string> = {
  off: 'One eye',
  sbs: 'Side by side',
  anaglyph: 'Red-cyan',
  xr: 'Headset',
};

const rulerNames: Record<RulerMode, string> = { off: 'Ruler', tool: 'Ruler: along the tool', sight: 'Ruler: in depth' };

export class ViewMenu {
  readonly root = el('div', { class: 'controls view' });
  readonly quality = el('select', { title: 'picture quality', 'aria-label': 'picture quality' });
  private readonly stereo = el('select', { title: 'stereo (O)', 'aria-label': 'stereo' });
  private readonly angle = el('input', {
    type: 'range',
    min: String(angleRangeDeg[0]),
    max: String(angleRangeDeg[1]),
    step: '0.25',
    title: 'angle between the eyes at the focus ([ and ])',
    'aria-label': 'stereo angle',
  });
  private readonly infrared = el(
    'button',
    { title: 'infrared picture: what fluoresces (I)', 'aria-pressed': 'false' },
    'Infrared',
  );
  private readonly ruler = el('button', {
    title: 'scale from the tip to the tissue: along the tool, along the line of sight, off (K)',
    'data-ruler': 'off',
  });
  private readonly glow = el('span', { class: 'glow' });
  private readonly enter = el('button', { title: 'show the picture in the headset' }, 'Enter headset');

  constructor(private readonly actions: ViewActions) {
    this.quality.append(
      el('option', { value: '' }, 'Auto'),
      ...levels.map((l) => el('option', { value: l.name }, l.name[0]!.toUpperCase() + l.name.slice(1))),
    );
    this.quality.onchange = () => {
      actions.quality(this.quality.value);
    };
    this.stereo.append(...stereoModes.map((m) => el('option', { value: m }, stereoNames[m])));
    this.stereo.onchange = () => {
      actions.stereo(this.stereo.value as StereoMode);
    };
    this.angle.oninput = () => actions.angle(Number(this.angle.value));
    this.infrared.onclick = () => {
      actions.infrared(this.infrared.getAttribute('aria-pressed') !== 'true');
    };
    this.enter.onclick = () => {
      actions.stereo('xr');
    };
    this.ruler.onclick = () => actions.nextRuler();
    this.root.append(this.quality, this.stereo, this.angle, this.enter, this.ruler, this.infrared, this.glow);
    this.showStereo('off', 5, false, false);
    this.showRuler('off');
    this.showGlow(false, []);
  }

  showRuler(mode: RulerMode): void {
    this.ruler.dataset.ruler = mode;
    this.ruler.setAttribute('aria-pressed', String(mode !== 'off'));
    setText(this.ruler, rulerNames[mode]);
  }

  showStereo(mode: StereoMode, angleDeg: number, headset: boolean, presenting: boolean): void {
    this.stereo.value = mode;
    this.angle.value = String(angleDeg);
    this.angle.hidden = mode === 'off';
    const xr = this.stereo.querySelector<HTMLOptionElement>('option[value=xr]')!;
    xr.disabled = !headset;
    xr.textContent = headset ? stereoNames.xr : 'Headset (none found)';
    this.enter.hidden = mode !== 'xr' || presenting;
    this.enter.disabled = !headset;
  }

  showInfrared(on: boolean): void {
    this.infrared.setAttribute('aria-pressed', String(on));
  }

  /** seen: the scene has walls that shine; commands: what makes them shine, and this page may ask for. */
  showGlow(seen: boolean, commands: readonly { id: string; command: CommandData }[]): void {
    this.infrared.hidden = !seen;
    this.glow.replaceChildren(
      ...commands.map(({ id, command }, k) => {
        const button = el(
          'button',
          { title: `${command.doc}${k === 0 ? ' (J)' : ''}`, 'data-glow': command.name },
          sentence(spoken(command.name)),
        );
        button.onclick = () => {
          this.actions.run(ask(id, command.name));
        };
        return button;
      }),
    );
  }

  /** The first command that makes walls shine. */
  askGlow(): void {
    this.glow.querySelector('button')?.click();
  }
}
