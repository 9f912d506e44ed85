// SPDX-License-Identifier: GPL-3.0-or-later
// The parameters of the chosen element with units, ranges and help, and what may be added to it.
import { el } from '../../hud/dom';
import { text } from '../../languages/text';
import { select } from '../fields';
import type { Declarations, ElementKind, Parameter } from './declarations';
import { attribute, type OutlineElement, pathOf } from './outline';
import { PropertyRow } from './property_row';

/** What is asked of the text. */
export interface Edits {
  /** null: back to the default. */
  set(e: OutlineElement, name: string, value: string | null): void;
  /** Lets a point be placed with the mouse. */
  place(e: OutlineElement, p: Parameter): void;
  add(e: OutlineElement, child: ElementKind): void;
  remove(e: OutlineElement): void;
}

/** Files of a copy as its open file names them. */
export const meshesFrom = (meshes: readonly string[], opened: () => string) => (): string[] => {
  const up = '../'.repeat(opened().split('/').length - 1);
  return meshes.map((file) => up + file);
};

export class PropertyPanel {
  readonly root = el('section', { class: 'properties', 'aria-label': text('Properties') });
  private readonly ids = el('datalist', { id: 'scene-ids' });
  private readonly files = el('datalist', { id: 'scene-files' });
  private rows: PropertyRow[] = [];
  private shown = '';
  private element: OutlineElement | null = null;

  constructor(
    private readonly declarations: Declarations,
    private readonly meshes: () => string[],
    private readonly edits: Edits,
  ) {}

  /** ids: names of components of the file. */
  show(e: OutlineElement | null, ids: readonly string[]): void {
    this.element = e;
    const now = e ? `${pathOf(e).join('.')} ${e.name}` : '';
    this.ids.replaceChildren(...ids.map((value) => el('option', { value })));
    this.files.replaceChildren(...this.meshes().map((value) => el('option', { value })));
    if (now !== this.shown) {
      this.shown = now;
      this.write(e);
    }
    for (const row of this.rows) row.show(e ? (attribute(e, row.parameter.name)?.value ?? null) : null);
  }

  private write(e: OutlineElement | null): void {
    this.rows = [];
    if (!e) {
      this.root.replaceChildren(el('p', { class: 'hint' }, text('Choose an element of the tree.')));
      return;
    }
    const kind = this.declarations.get(e.name);
    this.root.replaceChildren(el('h3', {}, `<${e.name}>`));
    if (!kind) {
      this.root.append(el('p', { class: 'bad' }, text('There is no such element.')));
    } else {
      this.rows = kind.parameters.map(
        (p) =>
          new PropertyRow(p, {
            set: (value) => this.element && this.edits.set(this.element, p.name, value),
            place: () => this.element && this.edits.place(this.element, p),
          }),
      );
      this.root.append(el('p', { lang: 'en' }, kind.doc), ...this.rows.map((r) => r.root), this.ids, this.files);
    }
    this.root.append(...this.buttons(e, kind));
  }

  private buttons(e: OutlineElement, kind: ElementKind | undefined): HTMLElement[] {
    const out: HTMLElement[] = [];
    const children = (kind?.children ?? []).map((name) => this.declarations.get(name)).filter((c) => c !== undefined);
    if (children.length > 0) {
      const which = select(children.map((c) => [c.name, c.name] as const));
      which.setAttribute('aria-label', text('Element to be added'));
      const about = el('p', { class: 'hint', lang: 'en' }, children[0]!.doc);
      which.onchange = () => (about.textContent = this.declarations.get(which.value)?.doc ?? '');
      const add = el('button', { type: 'button', class: 'add' }, text('Add'));
      add.onclick = () => {
        const child = this.declarations.get(which.value);
        if (child && this.element) this.edits.add(this.element, child);
      };
      out.push(el('h4', {}, text('Add inside of it')), el('div', { class: 'buttons' }, which, add), about);
    }
    if (e.parent) {
      const remove = el('button', { type: 'button', class: 'remove' }, text('Remove <{name}>', { name: e.name }));
      remove.onclick = () => this.element && this.edits.remove(this.element);
      out.push(el('div', { class: 'buttons' }, remove));
    }
    return out;
  }
}
