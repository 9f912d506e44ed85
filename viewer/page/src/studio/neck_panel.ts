// SPDX-License-Identifier: GPL-3.0-or-later
// The neck: one of the proposals, or by clicks on the surface.
import { Vector3 } from 'three';
import { el, setText } from '../hud/dom';
import { fixed } from '../languages/numbers';
import { text } from '../languages/text';
import type { Choices, Facts, Project, Proposal } from './api';
import type { Asks } from './editor';
import { asPoint, chosenPlane, type NeckPlane, planeThrough, planeWithDome } from './neck_plane';
import type { SurfaceView } from './surface_view';
import { forThePage } from './wording';

const sure = 0.85; // as in the report

function methodText(method: string): string {
  switch (method) {
    case 'narrowest section':
      return text('narrowest section');
    case 'shortest line':
      return text('shortest line around the dome');
    case "vessels' tubes":
      return text('what lies outside of the vessels’ tubes');
    default:
      return method;
  }
}

export class NeckPanel {
  readonly root: HTMLElement;
  points: Vector3[] = [];
  private readonly list = el('fieldset', {}, el('legend', {}, text('Proposals')));
  private readonly told = el('p', {});
  private readonly click = el('button', { type: 'button', class: 'neck-click' });
  private readonly say = el('p', { class: 'say', role: 'status' });
  private facts: Facts | null = null;

  constructor(
    private readonly asks: Asks,
    private readonly view: SurfaceView,
    /** The points have changed. */
    private readonly changed: () => void,
  ) {
    this.click.onclick = () => (this.view.onPoint ? this.stop('') : this.begin());
    setText(this.click, text('Set the neck by clicks'));
    this.root = el('section', {}, el('h3', {}, text('2. The neck')), this.told, this.list, this.click, this.say);
  }

  show(p: Project): void {
    this.facts = p.facts;
    this.root.hidden = !p.facts;
    if (!p.facts) return this.stop('');
    const proposals = p.facts.proposals.filter((one) => one.planar);
    const unsure = p.facts.confidence < sure;
    this.told.className = proposals.length === 0 || unsure ? 'mended' : '';
    setText(this.told, this.confidence(p.facts));
    this.list.hidden = proposals.length === 0;
    const rows = proposals.map((one, k) => this.row(one, k, p.choices));
    if (p.choices.neck && 'points' in p.choices.neck)
      rows.push(this.radio(text('set by clicks'), true, () => undefined));
    this.list.replaceChildren(this.list.firstElementChild!, ...rows);
  }

  /** The one that is shown: of the clicks, else of the choices. */
  plane(choices: Choices, facts: Facts): NeckPlane | null {
    return this.points.length > 0 ? null : chosenPlane(choices, facts);
  }

  private confidence(facts: Facts): string {
    if (facts.proposals.length === 0)
      return text('No neck was found. Set it by clicks. ({why})', { why: forThePage(facts.problem) });
    const percent = Math.round(100 * facts.confidence);
    return facts.confidence < sure
      ? text('Three methods agree by {percent} % only: look whether the white disc stands in the neck.', { percent })
      : text('Three methods agree by {percent} % on this neck.', { percent });
  }

  private row(p: Proposal, k: number, { neck }: Choices): HTMLElement {
    const chosen = neck === null ? k === 0 : 'plane' in neck && Math.abs(neck.plane[0]! - p.centre[0]) < 1e-3;
    const words = text('{method}, {mm} mm wide', { method: methodText(p.method), mm: fixed(p.diameterMm, 1) });
    const choice = k === 0 ? null : { plane: [...p.centre, ...p.normal] };
    return this.radio(words, chosen, () => this.asks.choose({ neck: choice }));
  }

  private radio(words: string, checked: boolean, run: () => void): HTMLElement {
    const input = el('input', { type: 'radio', name: 'neck' });
    input.checked = checked;
    input.onchange = run;
    return el('label', { class: 'toggle' }, input, el('span', {}, words));
  }

  private begin(): void {
    this.points = [];
    this.asks.toSurface();
    this.view.onPoint = (p) => this.take(p);
    setText(this.click, text('Cancel'));
    setText(this.say, text('Click on one side of the neck.'));
    this.changed();
  }

  private take(p: Vector3): void {
    this.points.push(p);
    const proposed = this.facts?.proposals[0];
    const normal = proposed ? new Vector3(...proposed.normal) : null;
    const needed = normal ? 2 : 3;
    if (this.points.length < needed) {
      const next = this.points.length === 1 ? text('Now on the opposite side.') : text('Now on the top of the dome.');
      setText(this.say, next);
      return this.changed();
    }
    const [a, b] = this.points;
    const plane = normal ? planeThrough(a!, b!, normal) : planeWithDome(this.points);
    if (!plane) return this.stop(text('These are no opposite sides of the neck. Try again.'));
    const neck = normal
      ? { points: [...asPoint(a!), ...asPoint(b!)] }
      : { plane: [...asPoint(plane.centre), ...asPoint(plane.normal)] };
    this.stop('');
    this.asks.choose({ neck });
  }

  private stop(words: string): void {
    this.view.onPoint = null;
    this.points = [];
    setText(this.click, text('Set the neck by clicks'));
    setText(this.say, words);
    this.changed();
  }
}
