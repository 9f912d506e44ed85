// SPDX-License-Identifier: GPL-3.0-or-later
// Earlier texts of the open file, also of other days. Taking one is a change like any other.
import { el } from '../../hud/dom';
import { momentText } from '../../languages/numbers';
import { text } from '../../languages/text';
import type { Version } from './api';

export class VersionSelect {
  readonly root = el('select', { 'aria-label': text('Earlier versions') });

  constructor(take: (version: number) => Promise<void>) {
    this.root.onchange = () => {
      const chosen = Number(this.root.value);
      this.root.value = '';
      if (chosen > 0) void take(chosen);
    };
  }

  show(versions: readonly Version[]): void {
    this.root.replaceChildren(
      el('option', { value: '' }, text('Earlier versions')),
      ...versions.map((v) =>
        el('option', { value: String(v.number) }, `${v.number}: ${momentText(new Date(v.timeMs))}`),
      ),
    );
    this.root.disabled = versions.length === 0;
  }
}
