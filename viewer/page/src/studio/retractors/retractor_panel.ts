// SPDX-License-Identifier: GPL-3.0-or-later
// The retractors of a case: a list and a picture, in which they are added, moved, turned and removed. They are choices
// like any other, and are taken over by the next build.
import { Vector3 } from 'three';
import { el, setText } from '../../hud/dom';
import { text } from '../../languages/text';
import type { Choices, Project, StudioApi } from '../api';
import type { Asks } from '../editor';
import { replaceRows } from '../fields';
import { type Pose, placedAt, PoseAsker, type PoseFacts, type PoseState } from '../pose/pose';
import type { SurfaceView } from '../surface_view';
import { forThePage, reason } from '../wording';
import { type Field, placeFault, retractorRow } from './retractor_row';
import { RetractorView } from './retractor_view';
import { another, type Retractor, withRetractor } from './retractors';

export class RetractorPanel {
  readonly root: HTMLElement;
  /** Before its picture comes: others are to be put away. */
  onBegin = (): void => undefined;
  private readonly open = el('button', { type: 'button', class: 'retractors-open' });
  private readonly move = el('button', { type: 'button' }, text('Move'));
  private readonly turn = el('button', { type: 'button' }, text('Turn'));
  private readonly add = el('button', { type: 'button' }, text('Add a retractor'));
  private readonly proposed = el('button', { type: 'button' }, text('Retractors as proposed'));
  private readonly say = el('p', { class: 'say', role: 'status' });
  private readonly rows = el('div', { class: 'rules' });
  private asker: PoseAsker | null = null;
  private picture: RetractorView | null = null;
  private project: Project | null = null;
  private begun = '';
  private known: PoseFacts | null = null;
  private at = 0;
  private placing = false;

  constructor(
    private readonly asks: Asks,
    private readonly api: StudioApi,
    private readonly view: SurfaceView,
  ) {
    this.open.onclick = () => (this.begun === '' ? this.begin() : this.end());
    this.move.onclick = () => this.mode(false);
    this.turn.onclick = () => this.mode(true);
    this.add.onclick = () => this.another();
    this.proposed.onclick = () => void asks.choose({ retractors: null });
    this.root = el(
      'section',
      { class: 'retractors' },
      el('h3', {}, text('11. The retractors')),
      el(
        'p',
        { class: 'hint' },
        text('They hold the lobes apart. Move, turn, add or remove them, and build again afterwards.'),
      ),
      el('div', { class: 'buttons' }, this.open, this.move, this.turn, this.add, this.proposed),
      this.say,
      this.rows,
    );
    this.lay();
  }

  show(p: Project): void {
    this.project = p;
    this.root.hidden = !p.built;
    this.proposed.disabled = p.choices.retractors === null;
    if (this.begun !== '' && this.begun !== p.built?.number) this.end();
    this.fill();
  }

  /** Puts the picture away. */
  end(): void {
    this.asker?.end();
    this.picture?.end();
    this.asker = this.picture = this.known = null;
    this.begun = '';
    this.rows.replaceChildren();
    setText(this.say, '');
    this.lay();
  }

  private lay(): void {
    const on = this.begun !== '';
    setText(this.open, on ? text('Put the picture away') : text('Change the retractors'));
    this.move.hidden = this.turn.hidden = this.add.hidden = !on;
  }

  private mode(turns: boolean): void {
    if (this.picture) this.picture.turns = turns;
    this.move.setAttribute('aria-pressed', String(!turns));
    this.turn.setAttribute('aria-pressed', String(turns));
  }

  private begin(): void {
    const { project } = this;
    if (!project?.built) return;
    const { name } = project;
    this.onBegin();
    this.begun = project.built.number;
    this.asks.toSurface();
    setText(this.say, text('The fissure is being read …'));
    const now = new PoseAsker(
      () => this.api.pose(name, null),
      (state) => void this.told(state),
      (e) => setText(this.say, reason(e)),
    );
    this.asker = now;
    now.want(null);
    this.lay();
  }

  private async told(state: PoseState): Promise<void> {
    if (state.state === 'failed') return setText(this.say, forThePage(state.error));
    if (!state.facts?.retractors || this.known || !this.project) return;
    this.known = state.facts;
    const { name, choices } = this.project;
    const pose: Pose = choices.pose ?? state.facts.pose;
    const picture = new RetractorView(state.facts, pose, {
      moved: (_k, r) => setText(this.say, placeFault(r, this.field()) || this.howTo()),
      placed: (k, r) => void this.placed(k, r),
      chosen: (k) => this.take(k),
    });
    this.picture = picture;
    this.view.root.append(picture.root);
    this.mode(false);
    setText(this.say, this.howTo());
    this.fill();
    try {
      await picture.load((surface) => this.api.poseSurface(name, surface, this.begun), pose);
    } catch (e) {
      setText(this.say, reason(e));
    }
  }

  private readonly howTo = (): string =>
    text('Click a blade, then drag an arrow or a ring at its tip. Drag beside it to look from elsewhere.');

  private field(): Field {
    const known = this.known!;
    const pose = this.project?.choices.pose ?? known.pose;
    return { facts: known.retractors!, neck: placedAt(pose, known.neck) as Vector3, toSurgeon: known.toSurgeon };
  }

  /** As chosen, else as proposed. */
  private allOf(choices: Choices): Retractor[] {
    return choices.retractors ?? this.known?.retractors?.proposed ?? [];
  }

  private fill(): void {
    const { project, known } = this;
    if (!project || !known) return;
    const all = this.allOf(project.choices);
    this.at = Math.min(this.at, all.length - 1);
    const field = this.field();
    this.add.disabled = all.length >= field.facts.most;
    const rows = all.map((r, k) =>
      retractorRow(r, k, k === this.at, field, {
        choose: (changed) => this.choose((now) => withRetractor(now, k, changed)),
        take: () => this.take(k),
        remove: () => this.choose((now) => now.filter((_r, other) => other !== k)),
      }),
    );
    replaceRows(
      this.rows,
      rows.length > 0 ? rows : [el('p', { class: 'mended' }, text('No retractor holds the lobes.'))],
    );
    if (!this.placing) this.picture?.show(all, this.at);
  }

  private take(k: number): void {
    this.at = k;
    this.fill();
  }

  private choose(change: (now: Retractor[]) => Retractor[]): Promise<unknown> {
    return this.asks.choose((now) => ({ retractors: change(this.allOf(now)) }));
  }

  private another(): void {
    const facts = this.known?.retractors;
    if (!facts) return;
    this.at = facts.most; // the new one
    void this.choose((now) => [...now, another(now, facts)]);
  }

  /** After a release. What may not be goes back to where it was. */
  private async placed(k: number, r: Retractor): Promise<void> {
    const fault = placeFault(r, this.field());
    if (fault !== '') {
      this.fill();
      return setText(this.say, fault);
    }
    setText(this.say, this.howTo());
    this.placing = true;
    await this.choose((now) => withRetractor(now, k, r));
    this.placing = false;
    this.fill();
  }
}
