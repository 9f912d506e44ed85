// SPDX-License-Identifier: GPL-3.0-or-later
// The list of projects, and the place to drop a file for a new one.
import { el } from '../hud/dom';
import { text } from '../languages/text';
import type { Listed, StudioApi } from './api';
import { NewCase } from './new_case';
import { reason } from './wording';

export class ProjectList {
  readonly root = el('div', { class: 'projects' });
  private readonly say = el('p', { class: 'say', role: 'alert' });
  private readonly rows = el('ul', {});
  private readonly none = el('p', { class: 'hint' }, text('There are no projects yet.'));
  private readonly fresh: NewCase;

  constructor(private readonly api: StudioApi) {
    this.fresh = new NewCase(api);
    this.root.append(
      this.fresh.root,
      el('section', {}, el('h2', {}, text('Projects')), this.none, this.rows, this.say),
    );
    void this.load();
  }

  private async load(): Promise<void> {
    try {
      const { projects, mostBytes } = await this.api.projects();
      this.fresh.mostBytes = mostBytes;
      this.none.hidden = projects.length > 0;
      this.rows.replaceChildren(...projects.map((p) => this.row(p)));
    } catch (e) {
      this.say.textContent = reason(e);
    }
  }

  private row(p: Listed): HTMLElement {
    const remove = el(
      'button',
      { type: 'button', 'aria-label': text('Remove {name}', { name: p.name }) },
      text('Remove'),
    );
    remove.onclick = () => void this.remove(p.name);
    return el(
      'li',
      {},
      el('a', { href: `#${p.name}` }, p.name),
      el('span', { class: 'hint' }, p.file),
      el('span', { class: 'hint' }, p.built ? text('built') : text('not built yet')),
      remove,
    );
  }

  private async remove(name: string): Promise<void> {
    if (!window.confirm(text('Remove the project {name} with its file?', { name }))) return;
    try {
      await this.api.remove(name);
      this.say.textContent = '';
    } catch (e) {
      this.say.textContent = reason(e);
    }
    await this.load();
  }
}
