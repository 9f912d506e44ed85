// SPDX-License-Identifier: GPL-3.0-or-later
// The place in the fissure: the vessel of the built case is moved and turned by a gizmo. What it overlaps and how its
// neck is seen is told while it moves.
import { el, setText } from '../../hud/dom';
import { fixed } from '../../languages/numbers';
import { text } from '../../languages/text';
import type { Project, StudioApi } from '../api';
import type { Asks } from '../editor';
import { partText } from '../part_words';
import type { SurfaceView } from '../surface_view';
import { forThePage, reason } from '../wording';
import { type Pose, type PoseAnswer, PoseAsker, type PoseFacts, type PoseState, samePose } from './pose';
import { PoseView } from './pose_view';

const howTo = () => text('Drag an arrow, a square or a ring at the neck. Drag beside it to look from elsewhere.');

export class PosePanel {
  readonly root: HTMLElement;
  /** Before its picture comes: others are to be put away. */
  onBegin = (): void => undefined;
  private readonly open = el('button', { type: 'button', class: 'pose-open' });
  private readonly move = el('button', { type: 'button' }, text('Move'));
  private readonly turn = el('button', { type: 'button' }, text('Turn'));
  private readonly proposed = el('button', { type: 'button' }, text('Place as proposed'));
  private readonly say = el('p', { class: 'say', role: 'status' });
  private readonly facts = el('table', { class: 'pose-facts' });
  private readonly asker: { now: PoseAsker | null } = { now: null };
  private picture: PoseView | null = null;
  private project: Project | null = null;
  private begun = '';
  private known: PoseFacts | null = null;
  private placing = false;
  /** The answer that the picture shows. */
  private pictured = '';

  constructor(
    private readonly asks: Asks,
    private readonly api: StudioApi,
    private readonly view: SurfaceView,
  ) {
    this.open.onclick = () => (this.begun === '' ? this.begin() : this.end());
    this.move.onclick = () => this.mode(false);
    this.turn.onclick = () => this.mode(true);
    this.proposed.onclick = () => this.asks.choose({ pose: null });
    this.root = el(
      'section',
      { class: 'pose' },
      el('h3', {}, text('10. The place')),
      el(
        'p',
        { class: 'hint' },
        text('Move and turn the vessel between the lobes. Build again afterwards: the lobes are then parted for it.'),
      ),
      el('div', { class: 'buttons' }, this.open, this.move, this.turn, this.proposed),
      this.say,
    );
    this.lay();
  }

  show(p: Project): void {
    this.project = p;
    this.root.hidden = !p.built;
    this.proposed.disabled = p.choices.pose === null;
    if (this.begun !== '' && this.begun !== p.built?.number) this.end();
    const wanted = p.choices.pose ?? this.known?.pose;
    if (!this.picture || this.placing || this.picture.dragging || !wanted) return;
    if (samePose(this.picture.pose, wanted)) return;
    this.picture.pose = wanted;
    this.asker.now?.want({ pose: wanted, parted: true });
  }

  /** Puts the picture away. */
  end(): void {
    this.asker.now?.end();
    this.picture?.end();
    this.asker.now = this.picture = this.known = null;
    this.begun = this.pictured = '';
    this.facts.replaceChildren();
    setText(this.say, '');
    this.lay();
  }

  private lay(): void {
    const on = this.begun !== '';
    setText(this.open, on ? text('Put the picture away') : text('Move the vessel'));
    this.move.hidden = this.turn.hidden = !on;
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
      (question) => this.api.pose(name, question),
      (state) => void this.told(state, now),
      (e) => setText(this.say, reason(e)),
    );
    this.asker.now = now;
    now.want(null);
    this.lay();
  }

  private async told(state: PoseState, from: PoseAsker): Promise<void> {
    if (state.state === 'failed') return setText(this.say, forThePage(state.error));
    if (state.answer) this.tell(state.answer, this.project!.name);
    if (!state.facts || this.known) return;
    this.known = state.facts;
    const moved = (pose: Pose) => from.want({ pose, parted: false });
    const picture = new PoseView(state.facts, moved, (pose) => void this.placed(pose, from));
    this.picture = picture;
    const { name } = this.project!;
    const pose = this.project!.choices.pose ?? state.facts.pose;
    picture.pose = pose;
    // The numbers are read while a hand drags in the picture.
    picture.root.append(this.facts);
    this.view.root.append(picture.root);
    this.mode(false);
    setText(this.say, howTo());
    try {
      await picture.load((surface) => this.api.poseSurface(name, surface, this.begun));
    } catch (e) {
      setText(this.say, reason(e));
    }
    from.want({ pose, parted: true });
  }

  private showLobes(a: PoseAnswer, name: string): void {
    const { picture } = this;
    const answer = JSON.stringify(a);
    if (!picture || answer === this.pictured) return;
    this.pictured = answer;
    if (!a.parted || !a.sound || !samePose(a.pose, picture.pose)) return picture.showWhole();
    const url = (surface: string) => this.api.poseSurface(name, surface, this.begun);
    picture.showParted(a.surfaces, url).catch((e: unknown) => setText(this.say, reason(e)));
  }

  /** After a release. What comes meanwhile tells of the place before. */
  private async placed(pose: Pose, from: PoseAsker): Promise<void> {
    from.want({ pose, parted: true });
    this.placing = true;
    await this.asks.choose({ pose });
    this.placing = false;
    if (this.project) this.show(this.project);
  }

  private tell(a: PoseAnswer, name: string): void {
    this.showLobes(a, name);
    if (!a.sound) {
      // Numbers of crushed lobes would tell nothing.
      const words = text('The lobes would be crushed here. Move the vessel to where it fits.');
      return this.facts.replaceChildren(el('caption', { class: 'bad', 'data-parted': 'true' }, words));
    }
    const row = (what: string, value: string, good: boolean, id: string) =>
      el('tr', { 'data-what': id }, el('th', { scope: 'row' }, what), el('td', { class: good ? '' : 'bad' }, value));
    const mm = (value: number) => `${fixed(value, 2)} mm`;
    const overlaps = a.overlapMm.map(([what, value]) => row(partText(what), mm(value), value < 0.005, what));
    const hidden = a.hiddenPct.map(([what, pct]) =>
      row(text('Hidden by: {what}', { what: partText(what) }), `${fixed(pct, 0)} %`, true, `hidden-${what}`),
    );
    const words = a.parted ? text('Overlap with the lobes parted') : text('Overlap before the lobes are parted');
    this.facts.replaceChildren(
      el('caption', { 'data-parted': String(a.parted) }, words),
      el(
        'tbody',
        {},
        ...overlaps,
        row(text('Near side of the neck that is seen'), `${fixed(a.seenPct, 0)} %`, a.seenPct >= 50, 'seen'),
        ...hidden,
      ),
    );
  }
}
