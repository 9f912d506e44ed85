// SPDX-License-Identifier: GPL-3.0-or-later
// A scene: its elements as a tree, its text, the properties of the chosen element, its problems, and a running picture.
// The text is checked soon after the last key. A scene without errors is saved at once; one with errors is kept beside
// it until it has none.
import { el, setText } from '../../hud/dom';
import { text } from '../../languages/text';
import { select } from '../fields';
import { undoKeys } from '../undo_keys';
import { reason } from '../wording';
import type { Problem, SceneCopy, ScenesApi, SceneText } from './api';
import type { Declarations, ElementKind, Parameter } from './declarations';
import { type Change, changedAttribute, withChild, withoutElement } from './edits';
import { LiveView } from './live_view';
import {
  attribute,
  elementAt,
  elementOfPath,
  type OutlineElement,
  outlineOf,
  pathOf,
  withDescendants,
} from './outline';
import { ProblemList } from './problems';
import { meshesFrom, PropertyPanel } from './property_panel';
import type { Seen } from './seen';
import { startAttributes } from './start_values';
import { TextPanel } from './text_panel';
import { TreePanel } from './tree_panel';
import { VersionSelect } from './version_select';
import { takenView } from './taken_view';
import { pointOf, pointText } from './values';

const quietMs = 300;

export class SceneEditor {
  readonly root = el('div', { class: 'scene-editor' });
  private readonly say = el('p', { class: 'say', role: 'alert' });
  private readonly state = el('p', { class: 'state', role: 'status' });
  private readonly file = el('select', { 'aria-label': text('File') });
  private readonly endKeys: () => void;
  private readonly undo = el('button', { type: 'button' }, text('Undo'));
  private readonly redo = el('button', { type: 'button' }, text('Redo'));
  private readonly content: TextPanel;
  private readonly tree = new TreePanel((e) => this.choose(e));
  private readonly properties: PropertyPanel;
  private readonly problems = new ProblemList((p) => void this.goTo(p));
  private readonly versions: VersionSelect;
  private readonly live: LiveView;
  private found: readonly Problem[] = [];
  private outline: OutlineElement | null = null;
  private selected: number[] = [];
  private scene: string;
  /** File whose text is shown. */
  private opened = '';
  private saved = '';
  private timer = 0;
  private choosing = false;
  private placing: { path: number[]; element: string; parameter: Parameter } | null = null;

  static async open(api: ScenesApi, name: string): Promise<SceneEditor> {
    const [copy, declarations] = await Promise.all([api.scene(name), api.declarations()]);
    const editor = new SceneEditor(api, copy, declarations);
    await editor.load(editor.scene);
    return editor;
  }

  private constructor(
    private readonly api: ScenesApi,
    private readonly copy: SceneCopy,
    private readonly declarations: Declarations,
  ) {
    this.scene = copy.scenes[0] ?? '';
    this.content = new TextPanel(declarations, { changed: () => this.changed(), moved: (at) => this.moved(at) });
    this.properties = new PropertyPanel(
      declarations,
      meshesFrom(copy.meshes, () => this.opened),
      {
        set: (e, name, value) => this.change(changedAttribute(this.content.content, e, name, value)),
        place: (e, p) => this.place(e, p),
        add: (e, child) => this.add(e, child),
        remove: (e) => {
          this.selected = e.parent ? pathOf(e.parent) : [];
          this.change(withoutElement(this.content.content, e));
        },
      },
    );
    this.versions = new VersionSelect(async (n) => this.content.replace(await api.version(copy.name, this.opened, n)));
    this.live = new LiveView(api, copy.name, () => this.scene, {
      taken: (seen) => void this.trying(this.take(seen)),
      placed: (at) => this.placed(at),
      shown: (on) => this.root.classList.toggle('looking', on),
    });
    this.fileChoice();
    this.undo.onclick = () => this.content.undo();
    this.redo.onclick = () => this.content.redo();
    this.endKeys = undoKeys((what) => this.content[what]());
    this.build();
  }

  private build(): void {
    const bar = el(
      'div',
      { class: 'bar' },
      ...[el('h2', {}, this.copy.name), this.file, this.undo, this.redo, this.versions.root, this.live.open],
      ...[this.state, this.say],
    );
    const middle = el('div', { class: 'middle' }, this.live.root, this.content.root, this.problems.root);
    this.root.append(bar, el('div', { class: 'panels' }, this.tree.root, middle, this.properties.root));
  }

  private fileChoice(): void {
    const { scenes, files } = this.copy;
    const parts = files.filter((f) => !scenes.includes(f));
    const options = select([...scenes, ...parts].map((f) => [f, f.split('/').slice(-2).join('/')] as const));
    this.file.append(...options.childNodes);
    this.file.onchange = () => void this.trying(this.load(this.file.value));
  }

  end(): void {
    this.endKeys();
    this.keep();
    this.content.end();
    this.live.end();
  }

  /** What was typed last is kept by the gateway before the text goes. */
  private keep(): void {
    window.clearTimeout(this.timer);
    const { content } = this.content;
    if (content === this.saved) return;
    void this.api.check(this.copy.name, this.scene, this.opened, content).catch(() => undefined);
  }

  private async trying(work: Promise<unknown>): Promise<void> {
    try {
      await work;
      setText(this.say, '');
    } catch (e) {
      setText(this.say, reason(e));
    }
  }

  /** Puts another text of a file in place, as one step that can be taken back. */
  private readonly writer = async (file: string, change: (doc: string) => Change | null): Promise<void> => {
    if (file !== this.opened) await this.load(file);
    const made = change(this.content.content);
    if (made) this.content.change(made);
  };

  private async load(file: string): Promise<void> {
    const got: SceneText = await this.api.file(this.copy.name, file);
    this.keep();
    this.noPlacing();
    this.file.value = this.opened = file;
    if (this.copy.scenes.includes(file)) this.scene = file;
    this.saved = got.text;
    this.versions.show(got.versions);
    this.selected = [];
    this.content.open(got.draft ?? got.text);
    this.changed();
  }

  /** The text is another one. */
  private changed(): void {
    this.outline = outlineOf(this.content.content);
    this.undo.disabled = !this.content.canUndo;
    this.redo.disabled = !this.content.canRedo;
    this.showElements();
    setText(this.state, text('Checking …'));
    window.clearTimeout(this.timer);
    this.timer = window.setTimeout(() => void this.trying(this.check()), quietMs);
  }

  private get chosen(): OutlineElement | null {
    return this.outline && (elementOfPath(this.outline, this.selected) ?? this.outline);
  }

  private showElements(): void {
    const all = this.outline ? withDescendants(this.outline) : [];
    const wrong = this.outline
      ? this.ofThisFile().map((p) => elementAt(this.outline!, this.content.placeOf(p.line, p.column)))
      : [];
    this.tree.show(this.outline, this.chosen, wrong);
    const ids = all.map((e) => attribute(e, 'id')?.value ?? '').filter(Boolean);
    this.properties.show(this.chosen, ids);
  }

  private ofThisFile(): Problem[] {
    return this.found.filter((p) => p.file === this.opened && p.line > 0);
  }

  private async check(): Promise<void> {
    const [file, content] = [this.opened, this.content.content];
    const checked = await this.api.check(this.copy.name, this.scene, file, content);
    if (!checked || file !== this.opened || content !== this.content.content) return;
    this.found = checked.problems;
    this.problems.show(this.found);
    this.content.mark(this.ofThisFile());
    this.showElements();
    if (!checked.ok) {
      setText(this.state, text('Not saved: the scene has errors. The one before stays.'));
      return;
    }
    const versions = await this.api.write(this.copy.name, file, content);
    if (file !== this.opened) return;
    this.versions.show(versions);
    this.saved = content;
    if (this.content.content === this.saved) setText(this.state, text('Saved'));
  }

  private take(seen: Seen): Promise<void> {
    return takenView(this.api, this.copy, this.opened, this.content.content, seen, this.writer);
  }

  private place(e: OutlineElement, parameter: Parameter): void {
    const value = attribute(e, parameter.name)?.value ?? parameter.fallback;
    const at = value === '' ? [0, 0, 0] : pointOf(parameter, value);
    setText(this.say, at ? '' : text('This value is no point: write numbers and a unit first.'));
    this.placing = at && { path: pathOf(e), element: e.name, parameter };
    this.live.place(at);
  }

  /** Of the element whose point is placed, wherever its tag is now. */
  private placed(at: readonly number[]): void {
    const e = this.placing && this.outline && elementOfPath(this.outline, this.placing.path);
    if (!e || !this.placing || e.name !== this.placing.element) return;
    const { parameter } = this.placing;
    const before = attribute(e, parameter.name)?.value ?? parameter.fallback;
    this.change(changedAttribute(this.content.content, e, parameter.name, pointText(parameter, at, before)));
  }

  private noPlacing(): void {
    if (this.placing) this.live.place(null);
    this.placing = null;
  }

  private change(change: Change | null): void {
    if (change) this.content.change(change);
  }

  private add(e: OutlineElement, child: ElementKind): void {
    const begins = this.outline ? startAttributes(this.declarations, child, this.outline) : [];
    const change = withChild(this.content.content, e, child, begins);
    this.selected = [...pathOf(e), e.children.length];
    this.content.change(change);
    if (this.chosen) this.choose(this.chosen);
  }

  private choose(e: OutlineElement): void {
    this.noPlacing();
    this.selected = pathOf(e);
    this.choosing = true;
    this.content.select(e.from, e.tagTo);
    this.choosing = false;
    this.showElements();
  }

  /** The cursor of the text is elsewhere. */
  private moved(at: number): void {
    if (this.choosing || !this.outline) return;
    this.selected = pathOf(elementAt(this.outline, at));
    this.showElements();
  }

  private async goTo(p: Problem): Promise<void> {
    if (!this.copy.files.includes(p.file)) return;
    if (p.file !== this.opened) await this.trying(this.load(p.file));
    const at = this.content.placeOf(p.line, p.column);
    this.content.select(at, at, true);
    this.moved(at);
  }
}
