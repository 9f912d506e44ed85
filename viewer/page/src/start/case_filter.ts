// SPDX-License-Identifier: GPL-3.0-or-later
// Cases by the site of the aneurysm and by difficulty: their order, and a choice of those that are shown.
import { el } from '../hud/dom';
import { text } from '../languages/text';
import type { Exercise } from './api';

/** Name of a site as Exercise of core/sim/exercise.h declares it; others are shown as they are. */
export function siteText(site: string): string {
  switch (site) {
    case 'ophthalmic':
      return text('Ophthalmic artery');
    case 'posterior communicating':
      return text('Posterior communicating artery');
    case 'anterior choroidal':
      return text('Anterior choroidal artery');
    case 'carotid bifurcation':
      return text('Carotid bifurcation');
    case 'middle cerebral':
      return text('Middle cerebral artery');
    case 'anterior communicating':
      return text('Anterior communicating artery');
    case 'pericallosal':
      return text('Pericallosal artery');
    case 'basilar tip':
      return text('Basilar tip');
    case 'superior cerebellar':
      return text('Superior cerebellar artery');
    case 'posterior inferior cerebellar':
      return text('Posterior inferior cerebellar artery');
    case 'other':
      return text('Other site');
    case '':
      return text('Site not said');
    default:
      return site;
  }
}

export const difficultyText = (difficulty: number): string =>
  difficulty === 0 ? '' : text('Difficulty {difficulty} of 5', { difficulty });

export interface SiteGroup {
  site: string;
  cases: Exercise[][];
}

/** The exercises of each case, in the order of the list. */
export function byCase(exercises: readonly Exercise[]): Exercise[][] {
  const out: Exercise[][] = [];
  for (const e of exercises) {
    const same = e.ofCase === '' ? undefined : out.find((c) => c[0]?.ofCase === e.ofCase);
    if (same) same.push(e);
    else out.push([e]);
  }
  return out;
}

/** By site in order of its name, those without one last; in a site the easiest first. */
export function bySite(cases: readonly Exercise[]): SiteGroup[] {
  const sites = [...new Set(cases.map((c) => c.site))];
  sites.sort((a, b) => Number(a === '') - Number(b === '') || siteText(a).localeCompare(siteText(b)));
  const last = (c: readonly Exercise[]) => Math.min(...c.map((e) => (e.difficulty === 0 ? 6 : e.difficulty)));
  return sites.map((site) => ({
    site,
    cases: byCase(cases.filter((c) => c.site === site)).sort((a, b) => last(a) - last(b)),
  }));
}

/** The cases of a site, or of all if it is null, that are no more difficult; 0: of any difficulty. */
export const chosen = (cases: readonly Exercise[], site: string | null, most: number): Exercise[] =>
  cases.filter((c) => (site === null || c.site === site) && (most === 0 || (c.difficulty > 0 && c.difficulty <= most)));

const all = '*';

export class CaseFilter {
  readonly root = el('div', { class: 'row case-filter' });
  private readonly site = el('select', { 'aria-label': text('site of the aneurysm') });
  private readonly most = el('select', { 'aria-label': text('difficulty') });
  private known = '';

  constructor(changed: () => void) {
    this.most.append(
      el('option', { value: '0' }, text('Any difficulty')),
      ...[1, 2, 3, 4].map((d) =>
        el('option', { value: String(d) }, text('At most difficulty {difficulty}', { difficulty: d })),
      ),
    );
    this.site.onchange = changed;
    this.most.onchange = changed;
    this.root.append(this.site, this.most);
  }

  /** Those of the cases that are to be shown. A single site and no difficulty leave nothing to choose. */
  apply(cases: readonly Exercise[]): Exercise[] {
    const groups = bySite(cases);
    this.offer(groups.map((g) => g.site));
    this.site.hidden = groups.length < 2;
    this.most.hidden = cases.every((c) => c.difficulty === 0);
    const site = this.site.hidden || this.site.value === all ? null : this.site.value;
    return chosen(cases, site, this.most.hidden ? 0 : Number(this.most.value));
  }

  private offer(sites: readonly string[]): void {
    if (sites.join('\n') === this.known) return;
    this.known = sites.join('\n');
    const before = this.site.value;
    this.site.replaceChildren(
      el('option', { value: all }, text('All sites')),
      ...sites.map((s) => el('option', { value: s }, siteText(s))),
    );
    this.site.value = sites.includes(before) ? before : all;
  }
}
