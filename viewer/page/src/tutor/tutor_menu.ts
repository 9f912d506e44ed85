// SPDX-License-Identifier: GPL-3.0-or-later
// How hints are given: in words, by an arrow at the tool, by a sound, and by a soft force if it is chosen. The engine
// keeps that last choice, so nobody meets a force that somebody else has chosen in this browser.
import { el } from '../hud/dom';
import { text } from '../languages/text';
import type { SoundSettings } from '../sound/settings';
import type { CueChoice } from './choice';

export interface TutorActions {
  cues(change: Partial<CueChoice>): void;
  sound(change: Partial<SoundSettings>): void;
  softGuide(on: boolean): void;
}

export class TutorMenu {
  readonly root = el('div', { class: 'controls tutor', role: 'group' });
  private readonly words = el('button');
  private readonly arrow = el('button');
  private readonly tone = el('button');
  private readonly force = el('button');
  private choice: CueChoice | null = null;
  private settings: SoundSettings | null = null;

  constructor(actions: TutorActions) {
    this.root.setAttribute('aria-label', text('hints'));
    const label = el('span', { class: 'label' }, text('Hints'));
    const name = (b: HTMLButtonElement, cue: string, short: string, whole: string) => {
      b.textContent = short;
      b.title = whole;
      b.dataset.cue = cue;
    };
    name(this.words, 'words', text('Words'), text('say hints in words while you practise'));
    name(this.arrow, 'arrow', text('Arrow'), text('point at the tool that a hint is about'));
    name(this.tone, 'sound', text('Sound'), text('a short sound with each hint'));
    name(this.force, 'force', text('Force'), text('a soft force at the hand with each hint, away from the fault'));
    this.words.onclick = () => this.choice && actions.cues({ words: !this.choice.words });
    this.arrow.onclick = () => this.choice && actions.cues({ arrow: !this.choice.arrow });
    this.tone.onclick = () => {
      if (!this.settings) return;
      const hints = !this.heard(this.settings);
      const on = this.settings.on || hints;
      actions.sound({ on, groups: { ...this.settings.groups, hints } });
    };
    this.force.onclick = () => actions.softGuide(this.force.getAttribute('aria-pressed') !== 'true');
    this.root.append(label, this.words, this.arrow, this.tone, this.force);
  }

  /** on: null where there is none to choose, as in a test. */
  showForce(on: boolean | null): void {
    this.force.hidden = on === null;
    const pressed = String(on === true);
    if (this.force.getAttribute('aria-pressed') !== pressed) this.force.setAttribute('aria-pressed', pressed);
  }

  show(choice: CueChoice, settings: SoundSettings): void {
    if (choice === this.choice && settings === this.settings) return;
    this.choice = choice;
    this.settings = settings;
    this.words.setAttribute('aria-pressed', String(choice.words));
    this.arrow.setAttribute('aria-pressed', String(choice.arrow));
    this.tone.setAttribute('aria-pressed', String(this.heard(settings)));
  }

  private heard({ on, groups }: SoundSettings): boolean {
    return on && groups.hints;
  }
}
