// SPDX-License-Identifier: GPL-3.0-or-later
// A scene from nothing: its name, and the declared components that it begins with.
import { el, setText } from '../../hud/dom';
import { text } from '../../languages/text';
import { field } from '../fields';
import { reason } from '../wording';
import type { ScenesApi } from './api';
import type { Declarations, ElementKind } from './declarations';
import { OpenedFile } from './opened_file';
import { copied, sceneAddress } from './scene_copy';

/** Those that a scene may begin with, by their kind, in the order of the declarations. */
export function componentsOf(all: Declarations): Map<string, ElementKind[]> {
  const out = new Map<string, ElementKind[]>();
  for (const name of all.get('scene')?.children ?? []) {
    const kind = all.get(name);
    if (kind && kind.kind !== '') out.set(kind.kind, [...(out.get(kind.kind) ?? []), kind]);
  }
  return out;
}

export class NewScene {
  readonly root = el('details', { class: 'new-scene' });
  private readonly name = el('input', { type: 'text', autocomplete: 'off', maxlength: '64' });
  private readonly list = el('div', { class: 'components' });
  private readonly start = el('button', { type: 'button', class: 'main' }, text('Begin the scene'));
  private readonly say = el('p', { class: 'say', role: 'status' });
  private all: Declarations | null = null;
  private readonly ticked = new Map<ElementKind, HTMLInputElement>();

  constructor(private readonly api: ScenesApi) {
    this.start.onclick = () => void this.begin();
    this.root.append(
      el('summary', {}, text('A new scene from nothing')),
      field(text('Name: letters, digits, _ and -'), this.name),
      el('p', { class: 'hint' }, text('Tick what it begins with. Everything can be added and removed later.')),
      this.list,
      el('div', { class: 'buttons' }, this.start),
      this.say,
    );
    this.root.ontoggle = () => void this.fill();
  }

  /** The declarations are asked for when the list is first opened. */
  private async fill(): Promise<void> {
    if (!this.root.open || this.all) return;
    setText(this.say, text('Loading …'));
    try {
      this.all = await this.api.declarations();
      setText(this.say, '');
    } catch (e) {
      return setText(this.say, reason(e));
    }
    const groups = [...componentsOf(this.all)].map(([kind, elements]) =>
      el('fieldset', {}, el('legend', { lang: 'en' }, kind), ...elements.map((e) => this.row(e))),
    );
    this.list.replaceChildren(...groups);
  }

  private row(kind: ElementKind): HTMLElement {
    const input = el('input', { type: 'checkbox', 'data-element': kind.name });
    this.ticked.set(kind, input);
    const words = el('span', { lang: 'en' }, el('strong', {}, kind.name), ` ${kind.doc}`);
    return el('label', { class: 'toggle' }, input, words);
  }

  private async begin(): Promise<void> {
    const { all } = this;
    if (!all) return;
    this.start.disabled = true;
    setText(this.say, text('The scene is begun …'));
    try {
      const scene = await copied(this.api, await this.api.begin(this.name.value.trim()));
      const file = scene.scenes[0]!;
      const kinds = [...this.ticked].filter(([, input]) => input.checked).map(([kind]) => kind);
      // With the parser of the editor, which is loaded when it is first wanted.
      const { withComponents } = await import('./components');
      const empty = await this.api.file(scene.name, file);
      // What is checked is kept, with its problems.
      const opened = new OpenedFile(this.api, scene.name, file, empty.revision);
      await opened.check(file, withComponents(empty.text, kinds, all));
      window.location.hash = sceneAddress(scene.name);
    } catch (e) {
      setText(this.say, reason(e));
    }
    this.start.disabled = false;
  }
}
