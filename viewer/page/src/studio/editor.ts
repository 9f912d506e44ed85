// SPDX-License-Identifier: GPL-3.0-or-later
// One project: the surface on the left, the steps from the file to the exercises on the right. Every choice goes to the
// gateway at once, which keeps it.
import { el, setText } from '../hud/dom';
import { text } from '../languages/text';
import { isRefusal, notFound } from '../start/api';
import type { Act, Project, StudioApi } from './api';
import { BuildPanel } from './build_panel';
import { CasePanel } from './case_panel';
import { type Change, Deeds } from './deeds';
import { FilePanel } from './file_panel';
import { GoalsPanel } from './goals/goals_panel';
import { handsAtWork } from './hands_at_work';
import { NeckPanel } from './neck_panel';
import { chosenPlane } from './neck_plane';
import { PosePanel } from './pose/pose_panel';
import { ResultPanel } from './result_panel';
import { RetractorPanel } from './retractors/retractor_panel';
import { ClipPanel } from './clip/clip_panel';
import { CutPanel } from './scan/cut_panel';
import { ScanStep } from './scan/scan_step';
import { Views } from './scan/views';
import type { ScenesApi } from './scene_editor/api';
import { SurfaceView } from './surface_view';
import { undoKeys } from './undo_keys';
import { PaintPanel } from './wall_paint/paint_panel';
import { WallPanel } from './wall_panel';
import { reason } from './wording';

const everyMs = 600;

/** What the panels ask for. */
export interface Asks {
  /** Changes choices. What depends on the present ones is a function of them. */
  choose(change: Change): Promise<Project | null>;
  act(act: Act, more?: object): Promise<Project | null>;
  /** Shows the surface, to be worked on. */
  toSurface(): void;
}

export class Editor {
  readonly root = el('div', { class: 'editor' });
  private readonly say = el('p', { class: 'say', role: 'alert' });
  private readonly again = el('button', { type: 'button', hidden: '' }, text('Make my change all the same'));
  private readonly undo = el('button', { type: 'button' }, text('Undo'));
  private readonly redo = el('button', { type: 'button' }, text('Redo'));
  private readonly title = el('h2', {});
  private readonly columns: HTMLElement;
  private readonly view = new SurfaceView();
  private readonly panels: { root: HTMLElement; show(p: Project): void }[];
  private readonly neck: NeckPanel;
  private readonly scan: ScanStep;
  private readonly pose: PosePanel;
  private readonly retractors: RetractorPanel;
  private readonly views: Views;
  private shown = '';
  private surface = 0;
  private timer = 0;
  private ended = false;
  private project: Project | null = null;
  private readonly endKeys: () => void;
  private readonly endHands: () => void;
  private readonly deeds: Deeds;

  constructor(
    private readonly api: StudioApi,
    name: string,
    scenes: ScenesApi,
  ) {
    const gateway = {
      project: () => api.project(name),
      act: (act: Act, more: object) => api.act(name, act, more),
    };
    this.deeds = new Deeds(gateway, (project, ofDeed) => this.told(project, ofDeed), {
      failed: (e) => (isRefusal(e, notFound) ? this.removed() : this.tell(reason(e))),
      overtaken: (again) => this.overtaken(again),
    });
    const asks: Asks = {
      choose: (change) => this.deeds.choose(change),
      act: (act, more) => this.deeds.act(act, more),
      toSurface: () => this.views.choose(true),
    };
    this.scan = new ScanStep(asks, api);
    this.views = new Views(this.scan.view, this.view.root);
    this.neck = new NeckPanel(asks, this.view, () => this.project && this.mark(this.project));
    this.pose = new PosePanel(asks, api, this.view);
    this.retractors = new RetractorPanel(asks, api, this.view);
    this.pose.onBegin = () => this.retractors.end();
    this.retractors.onBegin = () => this.pose.end();
    this.panels = [
      new FilePanel(asks),
      this.scan,
      new CutPanel(asks, this.view),
      this.neck,
      new CasePanel(asks),
      new BuildPanel(asks),
      new ResultPanel(asks, api),
      new GoalsPanel(asks, scenes),
      new ClipPanel(asks, this.view),
      new WallPanel(asks, scenes),
      new PaintPanel(asks, this.view, scenes),
      this.pose,
      this.retractors,
    ];
    this.undo.onclick = () => void this.deeds.act('undo');
    this.redo.onclick = () => void this.deeds.act('redo');
    setText(this.title, name);
    const bar = el('div', { class: 'bar' }, this.title, this.undo, this.redo, this.say, this.again);
    const side = el('div', { class: 'steps' }, ...this.panels.map((p) => p.root));
    this.columns = el('div', { class: 'columns' }, this.views.root, side);
    this.root.append(bar, this.columns);
    this.endKeys = undoKeys((what) => void this.deeds.act(what));
    this.endHands = handsAtWork(
      this.root,
      () => this.deeds.begin(),
      () => this.deeds.end(),
    );
    void this.follow();
  }

  end(): void {
    this.ended = true;
    window.clearTimeout(this.timer);
    this.endKeys();
    this.endHands();
    this.scan.end();
    this.pose.end();
    this.retractors.end();
    this.view.end();
  }

  /** What was typed stays readable, and nothing is asked any more. */
  private removed(): void {
    this.end();
    this.undo.disabled = this.redo.disabled = true;
    this.columns.inert = true;
    this.tell(text('This case is not there any more: it was removed in another window.'));
  }

  /** A refusal stands until something has been done. */
  private told(project: Project, ofDeed: boolean): void {
    if (this.ended) return;
    if (ofDeed) this.tell('');
    this.show(project);
  }

  private tell(words: string): void {
    setText(this.say, words);
    this.again.hidden = true;
  }

  /** Fields are written anew: they may show what was not applied. */
  private overtaken(again: (() => void) | null): void {
    this.shown = '';
    if (this.project) this.show(this.project);
    this.tell(
      again
        ? text('The case was changed in another window. You see it as it is now. Your last change was not applied.')
        : text('The case was changed in another window. You see it as it is now. What you pressed was not done.'),
    );
    this.again.hidden = again === null;
    this.again.onclick = again;
  }

  private async follow(): Promise<void> {
    await this.deeds.follow();
    if (!this.ended) this.timer = window.setTimeout(() => void this.follow(), everyMs);
  }

  /** Panels are written anew only when something has changed, so that they keep the focus. */
  private show(project: Project): void {
    const now = JSON.stringify(project);
    if (now === this.shown) return;
    this.shown = now;
    this.project = project;
    this.undo.disabled = !project.undo;
    this.redo.disabled = !project.redo;
    for (const panel of this.panels) panel.show(project);
    this.views.show(project);
    void this.showSurface(project);
  }

  private async showSurface(project: Project): Promise<void> {
    if (!project.facts) return;
    const { number } = project.inspect;
    if (number !== this.surface) {
      this.surface = number;
      const url = this.api.file(project.name, 'surface', number);
      await this.view.load(url, chosenPlane(project.choices, project.facts)).catch((e: unknown) => {
        setText(this.say, reason(e));
      });
    }
    if (!this.ended) this.mark(this.project ?? project);
  }

  private mark({ facts, choices }: Project): void {
    if (!facts) return;
    this.view.mark(facts, CasePanel.inletOf(facts, choices), this.neck.plane(choices, facts), this.neck.points);
  }
}
