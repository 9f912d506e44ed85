// SPDX-License-Identifier: GPL-3.0-or-later
// What the case is, and how it is made.
import { el } from '../hud/dom';
import { fixed } from '../languages/numbers';
import { text } from '../languages/text';
import { siteText } from '../start/case_filter';
import type { Choices, Facts, Project } from './api';
import type { Asks } from './editor';
import { field, select, toggle } from './fields';

/** As core/sim/exercise.h declares them. */
const sites = [
  'ophthalmic',
  'posterior communicating',
  'anterior choroidal',
  'carotid bifurcation',
  'middle cerebral',
  'anterior communicating',
  'pericallosal',
  'basilar tip',
  'superior cerebellar',
  'posterior inferior cerebellar',
  'other',
];
const sizes = [1200, 1650, 2000, 2500];

export class CasePanel {
  readonly root: HTMLElement;
  private readonly inlet = el('select', {});
  private readonly site = select([['', text('not said')], ...sites.map((s) => [s, siteText(s)] as const)]);
  private readonly difficulty = select([
    ['0', text('not said')],
    ...[1, 2, 3, 4, 5].map((n) => [String(n), text('{n} of 5', { n })] as const),
  ]);
  private readonly vertices = select(sizes.map((n) => [String(n), text('{n} vertices', { n })] as const));
  private readonly rehearse = toggle(text('Play the exercises until scripted hands succeed (some minutes more)'));
  private facts: Facts | null = null;

  constructor(asks: Asks) {
    this.inlet.onchange = () => {
      const k = Number(this.inlet.value);
      asks.choose({ inlet: k === 0 ? null : (this.facts?.openings[k]?.centre ?? null) });
    };
    this.site.onchange = () => asks.choose({ site: this.site.value });
    this.difficulty.onchange = () => asks.choose({ difficulty: Number(this.difficulty.value) });
    this.vertices.onchange = () => asks.choose({ vertices: Number(this.vertices.value) });
    this.rehearse.input.onchange = () => asks.choose({ rehearse: this.rehearse.input.checked });
    this.root = el(
      'section',
      {},
      el('h3', {}, text('3. The case')),
      field(text('Blood comes in at'), this.inlet),
      field(text('Site of the aneurysm'), this.site),
      field(text('Difficulty'), this.difficulty),
      field(text('Fineness of the wall'), this.vertices),
      this.rehearse.root,
    );
  }

  /** Index of the inlet: the opening nearest to the chosen point, else the widest, which is the first. */
  static inletOf(facts: Facts, { inlet }: Choices): number {
    if (!inlet) return 0;
    const away = facts.openings.map((o) => Math.hypot(...o.centre.map((x, k) => x - inlet[k]!)));
    return Math.max(0, away.indexOf(Math.min(...away)));
  }

  show({ facts, choices }: Project): void {
    this.facts = facts;
    this.root.hidden = !facts;
    if (!facts) return;
    const openings = facts.openings.map((o, k) =>
      el('option', { value: String(k) }, text('opening {n}, {mm} mm wide', { n: k + 1, mm: fixed(o.calibreMm, 1) })),
    );
    this.inlet.replaceChildren(...openings);
    this.inlet.value = String(CasePanel.inletOf(facts, choices));
    this.site.value = choices.site;
    this.difficulty.value = String(choices.difficulty);
    this.vertices.value = String(choices.vertices);
    this.rehearse.input.checked = choices.rehearse;
  }
}
