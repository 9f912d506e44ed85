// SPDX-License-Identifier: GPL-3.0-or-later
// What is heard: sound on or off, how loud, and each group of sounds by itself. While it is off, only that is said.
import type { SoundSettings } from '../sound/settings';
import { groupNames, groups } from '../sound/table';
import { el, setText } from './dom';
import { text } from '../languages/text';

export interface SoundActions {
  /** Changes what is heard. */
  sound(change: Partial<SoundSettings>): void;
}

/** The key or the click that the sound has waited for comes here too, within this time, ms. */
const sameGestureMs = 600;

export class SoundPanel {
  readonly root = el('div', { class: 'controls sound', role: 'group', 'aria-label': text('sound') });
  private readonly toggle = el('button');
  private readonly volume = el('input', {
    ...{ type: 'range', min: '0', max: '1', step: '0.05' },
    ...{ title: text('volume'), 'aria-label': text('volume of the sound') },
  });
  private readonly groups = groups.map((group) => ({
    group,
    button: el(
      'button',
      {
        title: groupNames[group].whole,
        'aria-label': groupNames[group].whole,
        'data-group': group,
      },
      groupNames[group].short,
    ),
  }));
  private settings: SoundSettings | null = null;
  private waits = false;
  private beganMs = -Infinity;

  /** key: that switches sound on and off; '': none does. */
  constructor(
    private readonly actions: SoundActions,
    key: string,
  ) {
    this.toggle.title = key === '' ? text('sound on or off') : text('sound on or off ({key})', { key });
    this.toggle.onclick = () => this.toggleSound();
    this.volume.oninput = () => actions.sound({ volume: Number(this.volume.value) });
    for (const { group, button } of this.groups)
      button.onclick = () => {
        if (!this.settings) return;
        actions.sound({ groups: { ...this.settings.groups, [group]: !this.settings.groups[group] } });
      };
    this.root.append(this.toggle, this.volume, ...this.groups.map((g) => g.button));
  }

  /** What begins the sound that has waited does not end it. */
  toggleSound(): void {
    const begins = this.waits || performance.now() - this.beganMs < sameGestureMs;
    if (this.settings) this.actions.sound({ on: begins || !this.settings.on });
  }

  /** waits: it is on, and the browser waits for a key or a click on the page. */
  show(settings: SoundSettings, waits: boolean): void {
    if (this.waits && !waits) this.beganMs = performance.now();
    this.settings = settings;
    this.waits = waits;
    const { on } = settings;
    setText(this.toggle, !on ? text('♪ Sound off') : waits ? text('♪ Sound: press a key') : text('♪ Sound on'));
    this.toggle.setAttribute('aria-pressed', String(on));
    this.volume.hidden = !on;
    if (Number(this.volume.value) !== settings.volume) this.volume.value = String(settings.volume);
    for (const { group, button } of this.groups) {
      button.hidden = !on;
      button.setAttribute('aria-pressed', String(settings.groups[group]));
    }
  }
}
