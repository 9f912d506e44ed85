// SPDX-License-Identifier: GPL-3.0-or-later
// The list of what is in a scene that is looked at: by name, with size and unit; a click highlights it.
import type { InventoryItem } from '../inventory';
import { el } from './dom';
import { sentence } from '../bundle';
import { said } from '../languages/said';
import { text } from '../languages/text';

/** "contact pair" -> "Contact pair". */
const heading = (group: string): string => sentence(said(group));

export class InventoryPanel {
  readonly root = el('section', { class: 'panel inventory', 'aria-label': text('what is in the scene') });
  private chosen: HTMLButtonElement | null = null;

  constructor(private readonly choose: (item: InventoryItem | null) => void) {
    this.root.hidden = true;
  }

  /** null: a scene that is played. */
  showScene(title: string, items: InventoryItem[] | null): void {
    this.root.hidden = items === null;
    this.chosen = null;
    this.choose(null);
    const parts: HTMLElement[] = [el('header', {}, el('h1', {}, title))];
    for (const group of new Set((items ?? []).map((i) => i.group))) {
      const members = (items ?? []).filter((i) => i.group === group);
      parts.push(
        el(
          'details',
          members.length <= 12 ? { open: '' } : {},
          el('summary', {}, heading(group), el('small', {}, String(members.length))),
          ...members.map((i) => this.entry(i)),
        ),
      );
    }
    this.root.replaceChildren(...parts);
  }

  private entry(item: InventoryItem): HTMLElement {
    const details = el(
      'div',
      { class: 'values' },
      el('code', {}, `<${item.element}>  ${item.file}`),
      ...item.values.map(([name, value]) => el('div', {}, el('span', {}, name), el('span', {}, value))),
    );
    details.hidden = true;
    const button = el('button', { 'aria-pressed': 'false' }, el('b', {}, item.name), el('small', {}, item.size));
    button.onclick = () => {
      const on = this.chosen !== button;
      if (this.chosen) {
        this.chosen.setAttribute('aria-pressed', 'false');
        (this.chosen.nextElementSibling as HTMLElement).hidden = true;
      }
      this.chosen = on ? button : null;
      button.setAttribute('aria-pressed', String(on));
      details.hidden = !on;
      if (on) details.parentElement?.scrollIntoView({ block: 'nearest' });
      this.choose(on ? item : null);
    };
    return el('div', { class: 'item' }, button, details);
  }
}
