// SPDX-License-Identifier: GPL-3.0-or-later
// How the field is looked at: quality, stereo and its angle, infrared, dye, headset.
import { levels } from '../quality';
import { angle_range_deg, stereo_modes, type StereoMode } from '../stereo';
import { el } from './dom';

export interface ViewActions {
  quality(name: string): void;
  stereo(mode: StereoMode): void;
  angle(deg: number): void;
  infrared(on: boolean): void;
  inject_dye(): void;
}

const stereo_names: Record<StereoMode, string> = { off: 'One eye', sbs: 'Side by side', anaglyph: 'Red-cyan', xr: 'Headset' };

export class ViewMenu {
  readonly root = el('div', { class: 'controls view' });
  readonly quality = el('select', { title: 'picture quality', 'aria-label': 'picture quality' });
  private readonly stereo = el('select', { title: 'stereo (O)', 'aria-label': 'stereo' });
  private readonly angle = el('input', { type: 'range', min: String(angle_range_deg[0]), max: String(angle_range_deg[1]), step: '0.25', title: 'angle between the eyes at the focus ([ and ])', 'aria-label': 'stereo angle' });
  private readonly infrared = el('button', { title: 'indocyanine green picture (I)', 'aria-pressed': 'false' }, 'ICG');
  private readonly dye = el('button', { title: 'inject the dye (J)' }, 'Inject dye');
  private readonly enter = el('button', { title: 'show the picture in the headset' }, 'Enter headset');

  constructor(actions: ViewActions) {
    this.quality.append(el('option', { value: '' }, 'Auto'), ...levels.map((l) => el('option', { value: l.name }, l.name[0]!.toUpperCase() + l.name.slice(1))));
    this.quality.onchange = () => { actions.quality(this.quality.value); this.quality.blur(); };
    this.stereo.append(...stereo_modes.map((m) => el('option', { value: m }, stereo_names[m])));
    this.stereo.onchange = () => { actions.stereo(this.stereo.value as StereoMode); this.stereo.blur(); };
    this.angle.oninput = () => actions.angle(Number(this.angle.value));
    this.angle.onchange = () => this.angle.blur();
    this.infrared.onclick = () => { actions.infrared(this.infrared.getAttribute('aria-pressed') !== 'true'); this.infrared.blur(); };
    this.dye.onclick = () => { actions.inject_dye(); this.dye.blur(); };
    this.enter.onclick = () => { actions.stereo('xr'); this.enter.blur(); };
    this.root.append(this.quality, this.stereo, this.angle, this.enter, this.infrared, this.dye);
    this.show_stereo('off', 5, false, false);
    this.show_dye(false, false);
  }

  show_stereo(mode: StereoMode, angle_deg: number, headset: boolean, presenting: boolean): void {
    this.stereo.value = mode;
    this.angle.value = String(angle_deg);
    this.angle.hidden = mode === 'off';
    const xr = this.stereo.querySelector<HTMLOptionElement>('option[value=xr]')!;
    xr.disabled = !headset;
    xr.textContent = headset ? stereo_names.xr : 'Headset (none found)';
    this.enter.hidden = mode !== 'xr' || presenting;
    this.enter.disabled = !headset;
  }

  show_infrared(on: boolean): void { this.infrared.setAttribute('aria-pressed', String(on)); }

  /** vessels: there is something to see; may_inject: a component offers the dye and this page may ask for it. */
  show_dye(vessels: boolean, may_inject: boolean): void {
    this.infrared.hidden = !vessels;
    this.dye.hidden = !vessels || !may_inject;
  }
}
