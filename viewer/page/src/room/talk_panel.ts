// SPDX-License-Identifier: GPL-3.0-or-later
// Words between the pages of a station, and the instructor's pencil.
import { el } from '../hud/dom';
import { text } from '../languages/text';
import type { Role } from '../options';
import { longestText, sayable } from './messages';
import type { PencilMode } from './pencil';

const mostLines = 60;

export interface TalkActions {
  say(text: string): void;
  pencil(mode: PencilMode): void;
  clear(): void;
}

export class TalkPanel {
  readonly root = el('section', { class: 'panel talk' });
  private readonly lines = el('ol', { class: 'talk-lines', 'aria-live': 'polite' });
  private readonly modes = new Map<PencilMode, HTMLButtonElement>();
  private mode: PencilMode = 'off';
  /** For what belongs to talking and is made elsewhere. */
  readonly below = el('div');

  constructor(
    private readonly role: Role,
    private readonly actions: TalkActions,
  ) {
    this.root.append(el('h2', {}, text('Talk')), this.lines);
    if (role !== 'observer') this.root.append(this.form());
    if (role === 'instructor') this.root.append(this.pencilRow());
    // A trainee who is alone needs none of it.
    this.root.hidden = role !== 'instructor';
    this.root.append(this.below);
  }

  add(from: string, said: string): void {
    this.show();
    this.lines.append(el('li', { 'data-from': from }, el('b', {}, nameOf(from)), ` ${said}`));
    while (this.lines.childElementCount > mostLines) this.lines.firstElementChild!.remove();
    this.lines.scrollTop = this.lines.scrollHeight;
  }

  /** When somebody is there to talk with. */
  show(): void {
    this.root.hidden = false;
  }

  private form(): HTMLElement {
    const input = el('input', {
      type: 'text',
      maxlength: String(longestText),
      'aria-label': text('what you say to the others'),
    });
    const form = el('form', { class: 'ask' }, input, el('button', {}, text('Say')));
    form.onsubmit = (e) => {
      e.preventDefault();
      const said = sayable(input.value);
      input.value = '';
      if (said === '') return;
      this.actions.say(said);
      this.add(this.role, said);
    };
    return form;
  }

  private pencilRow(): HTMLElement {
    const button = (mode: PencilMode, label: string) => {
      const b = el('button', { type: 'button', 'aria-pressed': 'false' }, label);
      b.onclick = () => this.choose(this.mode === mode ? 'off' : mode);
      this.modes.set(mode, b);
      return b;
    };
    const clear = el('button', { type: 'button' }, text('Clear'));
    clear.onclick = () => this.actions.clear();
    return el('div', { class: 'controls pencil' }, button('draw', text('Draw')), button('point', text('Point')), clear);
  }

  private choose(mode: PencilMode): void {
    this.mode = mode;
    for (const [each, b] of this.modes) b.setAttribute('aria-pressed', String(each === mode));
    this.actions.pencil(mode);
  }
}

/** Of a role, as a reader may see it. */
export function nameOf(role: string): string {
  if (role === 'instructor') return text('Instructor');
  return role === 'trainee' ? text('Trainee') : text('Observer');
}
