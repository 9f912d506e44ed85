// SPDX-License-Identifier: GPL-3.0-or-later
// Ends of vessels that are cut straight: by a line drawn across the vessel, of which the author says which part goes.
import { Vector3 } from 'three';
import { el, setText } from '../../hud/dom';
import { text } from '../../languages/text';
import type { Project } from '../api';
import type { Asks } from '../editor';
import { asPoint } from '../neck_plane';
import type { SurfaceView } from '../surface_view';
import { type Cut, otherSide, smallerSide } from './cut_plane';
import { LineDrawing, type Place } from './line_drawing';

const mostCuts = 12;

export class CutPanel {
  readonly root: HTMLElement;
  private readonly begin = el('button', { type: 'button' });
  private readonly cut = el('button', { type: 'button', class: 'main' }, text('Cut'));
  private readonly other = el('button', { type: 'button' }, text('The other part goes'));
  private readonly say = el('p', { class: 'say', role: 'status' });
  private readonly list = el('ul', { class: 'cuts' });
  private readonly drawing = new LineDrawing((a, b) => this.drawn(a, b));
  private planned: Cut | null = null;
  private project: Project | null = null;

  constructor(
    private readonly asks: Asks,
    private readonly view: SurfaceView,
  ) {
    view.root.append(this.drawing.root);
    this.begin.onclick = () => (this.drawing.root.hidden && !this.planned ? this.start() : this.stop(''));
    this.cut.onclick = () => this.make();
    this.other.onclick = () => this.plan(this.planned && otherSide(this.planned));
    this.root = el(
      'section',
      {},
      el('h3', {}, text('Ends of the vessel')),
      el('p', { class: 'hint' }, text('A vessel needs flat ends: one where blood comes in, and one or more others.')),
      this.list,
      el('div', { class: 'buttons' }, this.begin, this.cut, this.other),
      this.say,
    );
    this.stop('');
  }

  show(p: Project): void {
    this.project = p;
    this.root.hidden = !p.facts && p.choices.cuts.length === 0;
    this.stop('');
    const { cuts } = p.choices;
    this.begin.disabled = cuts.length >= mostCuts || !p.facts;
    this.list.replaceChildren(
      ...cuts.map((cut, k) => {
        const remove = el('button', { type: 'button' }, text('Remove cut {n}', { n: k + 1 }));
        remove.onclick = () =>
          void this.asks.choose((now) => ({ cuts: now.cuts.filter((c) => String(c) !== String(cut)) }));
        return el('li', {}, remove);
      }),
    );
  }

  private start(): void {
    this.asks.toSurface();
    this.drawing.on = true;
    setText(this.begin, text('Cancel'));
    setText(this.say, text('Draw a line across the vessel. Turn the vessel first if need be.'));
  }

  private stop(words: string): void {
    this.drawing.on = false;
    this.plan(null);
    setText(this.begin, text('Cut an end'));
    setText(this.say, words);
  }

  private drawn(from: Place, to: Place): void {
    const { surface } = this.view;
    const cut = surface && this.view.cutAlong(from, to);
    if (!cut) return setText(this.say, text('This line is not across a vessel. Draw it again.'));
    const neck = this.project?.facts?.proposals[0];
    const turned = smallerSide(surface.positions, surface.triangles, cut, neck ? new Vector3(...neck.centre) : null);
    this.drawing.on = false;
    this.plan(turned);
    setText(this.say, text('The blue part goes.'));
  }

  private plan(cut: Cut | null): void {
    this.planned = cut;
    this.view.showCut(cut);
    this.cut.hidden = this.other.hidden = !cut;
  }

  private make(): void {
    const { planned } = this;
    if (!planned) return;
    this.stop('');
    const cut = [...asPoint(planned.point), ...asPoint(planned.normal)];
    void this.asks.choose((now) => ({ cuts: [...now.cuts, cut] }));
  }
}
