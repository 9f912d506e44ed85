// SPDX-License-Identifier: GPL-3.0-or-later
// Tells that the file was changed in another window, and asks which text is to stay.
import { el } from '../../hud/dom';
import { text } from '../../languages/text';

export class OvertakenNotice {
  readonly root = el('p', { class: 'overtaken', role: 'alert', hidden: '' });

  constructor(showTheirs: () => void, keepMine: () => void) {
    const theirs = el('button', { type: 'button' }, text('Show the other text'));
    const mine = el('button', { type: 'button' }, text('Keep my text'));
    theirs.onclick = showTheirs;
    mine.onclick = keepMine;
    const words = text('This file was changed in another window. What you see is not saved.');
    this.root.append(words, ' ', theirs, ' ', mine);
  }

  show(on: boolean): void {
    this.root.hidden = !on;
  }
}
