// SPDX-License-Identifier: GPL-3.0-or-later
// How the field is looked at: quality, stereo and its angle, infrared, headset.
import { sentence, spoken } from '../bundle';
import type { CommandData } from '../bundle_types';
import type { RulerMode } from '../depth_ruler';
import { levels } from '../quality';
import { angleRangeDeg, stereoModes, type StereoMode } from '../stereo_modes';
import { ask, type UserCommand } from './commands';
import { el, setText } from './dom';
import { languageSelect } from '../languages/language_select';
import { said } from '../languages/said';
import { text } from '../languages/text';
import type { QualityName } from '../options';

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
  off: text('One eye'),
  sbs: text('Side by side'),
  anaglyph: text('Red-cyan'),
  xr: text('Headset'),
};

/** Names of the levels as the reader has them. */
export const levelNames: Readonly<Record<string, string>> & Record<QualityName, string> = {
  draft: text('Draft'),
  low: text('Low'),
  medium: text('Medium'),
  high: text('High'),
  ultra: text('Ultra'),
};

const rulerNames: Record<RulerMode, string> = {
  off: text('Ruler'),
  tool: text('Ruler: along the tool'),
  sight: text('Ruler: in depth'),
};

export class ViewMenu {
  readonly root = el('div', { class: 'controls view' });
  readonly quality = el('select', { title: text('picture quality'), 'aria-label': text('picture quality') });
  private readonly stereo = el('select', { title: text('stereo (O)'), 'aria-label': text('stereo') });
  private readonly angle = el('input', {
    type: 'range',
    min: String(angleRangeDeg[0]),
    max: String(angleRangeDeg[1]),
    step: '0.25',
    title: text('angle between the eyes at the focus ([ and ])'),
    'aria-label': text('stereo angle'),
  });
  private readonly infrared = el(
    'button',
    { title: text('infrared picture: what fluoresces (I)'), 'aria-pressed': 'false' },
    text('Infrared'),
  );
  private readonly ruler = el('button', {
    title: text('scale from the tip to the tissue: along the tool, along the line of sight, off (K)'),
    'data-ruler': 'off',
  });
  private readonly glow = el('span', { class: 'glow' });
  private readonly enter = el('button', { title: text('show the picture in the headset') }, text('Enter headset'));

  constructor(private readonly actions: ViewActions) {
    this.quality.append(
      el('option', { value: '' }, text('Auto')),
      ...levels.map((l) => el('option', { value: l.name }, levelNames[l.name])),
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
    this.root.append(
      this.quality,
      this.stereo,
      this.angle,
      this.enter,
      this.ruler,
      this.infrared,
      this.glow,
      languageSelect(),
    );
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
    xr.textContent = headset ? stereoNames.xr : text('Headset (none found)');
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
          { title: `${said(command.doc)}${k === 0 ? ' (J)' : ''}`, 'data-glow': command.name },
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
