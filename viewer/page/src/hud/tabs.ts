// SPDX-License-Identifier: GPL-3.0-or-later
// Tabs below the field on a narrow screen: each opens one column of panels over the field, and closes it again.
import { el } from './dom';

export interface Tab {
  name: string;
  text: string;
}

export class Tabs {
  readonly root = el('div', { class: 'tabs' });
  private readonly buttons: { name: string; button: HTMLButtonElement }[];

  /** The open column is named by data-open of the root; styles do the rest. */
  constructor(
    private readonly hud: HTMLElement,
    tabs: readonly Tab[],
  ) {
    this.buttons = tabs.map(({ name, text }) => {
      const button = el('button', { 'data-tab': name, 'aria-expanded': 'false' }, text);
      button.onclick = () => this.open(this.hud.dataset.open === name ? '' : name);
      return { name, button };
    });
    this.root.append(...this.buttons.map((b) => b.button));
    this.open('');
  }

  open(name: string): void {
    this.hud.dataset.open = name;
    for (const b of this.buttons) b.button.setAttribute('aria-expanded', String(b.name === name));
  }
}
