// SPDX-License-Identifier: GPL-3.0-or-later
// A scene: its elements as a tree, its text, the properties of the chosen element, its problems, and a running picture.
// The text is checked soon after the last key. A scene without errors is saved at once; one with errors is kept beside
// it until it has none.
import { el, setText } from '../../hud/dom';
import { text } from '../../languages/text';
import { isRefusal, preconditionFailed } from '../../start/api';
import { select } from '../fields';
import { undoKeys } from '../undo_keys';
import { reason } from '../wording';
import type { Problem, SceneCopy, ScenesApi, SceneText } from './api';
import type { Declarations, ElementKind } from './declarations';
import { type Change, changedAttribute, withChild, withoutElement } from './edits';
import { LiveView } from './live_view';
import { OpenedFile } from './opened_file';
import {
  attribute,
  elementAt,
  elementOfPath,
  type OutlineElement,
  outlineOf,
  pathOf,
  withDescendants,
} from './outline';
import { OvertakenNotice } from './overtaken_notice';
import { PointPlacing } from './point_placing';
import { ProblemList } from './problems';
import { meshesFrom, PropertyPanel } from './property_panel';
import type { Seen } from './seen';
import { startAttributes } from './start_values';
import { takenView } from './taken_view';
import { TextPanel } from './text_panel';
import { TreePanel } from './tree_panel';
import { VersionSelect } from './version_select';

const quietMs = 300;

export class SceneEditor {
  readonly root = el('div', { class: 'scene-editor' });
  private readonly say = el('p', { class: 'say', role: 'alert' });
  private readonly state = el('p', { class: 'state', role: 'status' });
  private readonly placing = new PointPlacing(
    (at) => this.live.place(at),
    (words) => setText(this.say, words),
  );
  private readonly overtaken = new OvertakenNotice(
    () => void this.trying(this.showTheirs()),
    () => void this.trying(this.keepMine()),
  );
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
  private on: OpenedFile;
  private saved = '';
  private timer = 0;
  private choosing = false;

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
    this.on = new OpenedFile(api, copy.name, '', '');
    this.content = new TextPanel(declarations, { changed: () => this.changed(), moved: (at) => this.moved(at) });
    this.properties = new PropertyPanel(
      declarations,
      meshesFrom(copy.meshes, () => this.opened),
      {
        set: (e, name, value) => this.change(changedAttribute(this.content.content, e, name, value)),
        place: (e, p) => this.placing.begin(e, p),
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
      placed: (at) => this.change(this.placing.placed(at, this.outline, this.content.content)),
      shown: (on) => this.root.classList.toggle('looking', on),
    });
    this.fileChoice();
    this.undo.onclick = () => this.content.undo();
    this.redo.onclick = () => this.content.redo();
    this.endKeys = undoKeys((what) => this.content[what]());
    window.addEventListener('focus', this.lookAgain);
    this.build();
  }

  private build(): void {
    const bar = el(
      'div',
      { class: 'bar' },
      ...[el('h2', {}, this.copy.name), this.file, this.undo, this.redo, this.versions.root, this.live.open],
      ...[this.state, this.say, this.overtaken.root],
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
    window.removeEventListener('focus', this.lookAgain);
    this.keep();
    this.content.end();
    this.live.end();
  }

  /** What was typed last is kept by the gateway before the text goes. */
  private keep(): void {
    window.clearTimeout(this.timer);
    const { content } = this.content;
    if (content === this.saved) return;
    void this.on.check(this.scene, content).catch(() => undefined);
  }

  private async trying(work: Promise<unknown>): Promise<void> {
    try {
      await work;
      setText(this.say, '');
    } catch (e) {
      const overtaken = isRefusal(e, preconditionFailed);
      this.overtaken.show(overtaken);
      setText(this.say, overtaken ? '' : reason(e));
      if (overtaken) setText(this.state, '');
    }
  }

  /** What is done next is done to the file as it is now. */
  private begin(file: string, got: SceneText): void {
    this.on = new OpenedFile(this.api, this.copy.name, file, got.revision);
    this.saved = got.text;
    this.versions.show(got.versions);
    this.overtaken.show(false);
  }

  /** The own text is one step back. */
  private async showTheirs(): Promise<void> {
    const got = await this.api.file(this.copy.name, this.opened);
    this.begin(this.opened, got);
    this.content.replace(got.draft ?? got.text);
  }

  private async keepMine(): Promise<void> {
    this.begin(this.opened, await this.api.file(this.copy.name, this.opened));
    this.changed();
  }

  /** Whoever comes back to this window sees what was changed in another one, unless both have changed something. */
  private readonly lookAgain = (): void => {
    const { on } = this;
    const untouched = (): boolean => on === this.on && this.saved === this.content.content;
    const look = async (): Promise<void> => {
      const { revision } = await this.api.file(this.copy.name, on.file);
      if (revision !== on.revision && untouched()) await this.showTheirs();
    };
    if (untouched()) void this.trying(look());
  };

  /** Puts another text of a file in place, as one step that can be taken back. */
  private readonly writer = async (file: string, change: (doc: string) => Change | null): Promise<void> => {
    if (file !== this.opened) await this.load(file);
    const made = change(this.content.content);
    if (made) this.content.change(made);
  };

  private async load(file: string): Promise<void> {
    const got = await this.api.file(this.copy.name, file);
    this.keep();
    this.begin(file, got);
    this.placing.end();
    this.file.value = file;
    if (this.copy.scenes.includes(file)) this.scene = file;
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
    this.checkSoon(quietMs);
  }

  private checkSoon(waitMs: number): void {
    window.clearTimeout(this.timer);
    this.timer = window.setTimeout(() => void this.trying(this.check()), waitMs);
  }

  private get opened(): string {
    return this.on.file;
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
    const { on } = this;
    const { content } = this.content;
    const checked = await on.check(this.scene, content);
    if (on !== this.on || content !== this.content.content) return;
    if (!checked) return this.checkSoon(quietMs + 1000 * Math.random()); // another window has asked for the same file
    this.found = checked.problems;
    this.problems.show(this.found);
    this.content.mark(this.ofThisFile());
    this.showElements();
    if (!checked.ok) {
      setText(this.state, text('Not saved: the scene has errors. The one before stays.'));
      return;
    }
    const versions = await on.write(content);
    if (on !== this.on) return;
    this.versions.show(versions);
    this.saved = content;
    if (this.content.content === this.saved) setText(this.state, text('Saved'));
  }

  private take(seen: Seen): Promise<void> {
    return takenView(this.api, this.copy, this.opened, this.content.content, seen, this.writer);
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
    this.placing.end();
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
