// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes that are edited, and the choice of one to be copied.
import { el } from '../../hud/dom';
import { said } from '../../languages/said';
import { text } from '../../languages/text';
import { reason } from '../wording';
import { NewScene } from './new_scene';
import { copied, sceneAddress } from './scene_copy';
import type { SceneCopy, ScenesApi, Source } from './api';

export class SceneList {
  readonly root = el('section', { class: 'scenes projects' });
  private readonly say = el('p', { class: 'say', role: 'alert' });
  private readonly rows = el('ul', {});
  private readonly source = el('select', { 'aria-label': text('Scene to be copied') });
  private readonly open = el('button', { type: 'button' }, text('Edit a copy'));

  constructor(private readonly api: ScenesApi) {
    this.open.onclick = () => void this.begin();
    this.open.disabled = true;
    this.root.append(
      el('h2', {}, text('Scenes')),
      el(
        'p',
        { class: 'hint' },
        text('A scene is edited as a copy with all of its files. The original stays as it is.'),
      ),
      el('div', { class: 'buttons' }, this.source, this.open),
      new NewScene(this.api).root,
      this.say,
      this.rows,
    );
    void this.load();
  }

  private async trying(work: () => Promise<unknown>): Promise<void> {
    try {
      await work();
    } catch (e) {
      this.say.textContent = reason(e);
    }
  }

  private async load(): Promise<void> {
    await this.trying(async () => {
      this.rows.replaceChildren(...(await this.api.scenes()).map((s) => this.row(s)));
      const sources = await this.api.sources();
      const option = (s: Source) => el('option', { value: s.scene }, said(s.title) || s.scene);
      this.source.replaceChildren(...sources.map(option));
      this.open.disabled = sources.length === 0;
    });
  }

  private row({ name, error }: SceneCopy): HTMLElement {
    const remove = el('button', { type: 'button', 'aria-label': text('Remove {name}', { name }) }, text('Remove'));
    remove.onclick = () => {
      if (!window.confirm(text('Remove the scene {name} with all of its versions?', { name }))) return;
      void this.trying(() => this.api.remove(name).then(() => this.load()));
    };
    return el('li', {}, el('a', { href: sceneAddress(name) }, name), el('span', { class: 'hint' }, error), remove);
  }

  private async begin(): Promise<void> {
    this.open.disabled = true;
    this.say.textContent = text('Copying …');
    await this.trying(async () => {
      window.location.hash = sceneAddress((await copied(this.api, await this.api.open(this.source.value))).name);
    });
    this.open.disabled = false;
  }
}
