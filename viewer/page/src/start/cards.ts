// SPDX-License-Identifier: GPL-3.0-or-later
// The exercises as cards, by group: picture, title, what is to be done, and how the last run went.
import { el } from '../hud/dom';
import { said } from '../languages/said';
import { text } from '../languages/text';
import type { Api, Exercise, History } from './api';
import { bySite, CaseFilter, difficultyText, siteText } from './case_filter';
import { groupTitles, resultText, stateOf, stateText } from './wording';

export interface CardActions {
  begin: (exercise: Exercise) => void;
  progress: (exercise: Exercise) => void;
}

export class Cards {
  readonly root = el('div', { class: 'groups' });

  private readonly filter = new CaseFilter(() => this.again());
  private again: () => void = () => undefined;

  constructor(
    private readonly api: Api,
    private readonly actions: CardActions,
  ) {}

  private lists(group: string, of: readonly Exercise[], card: (e: Exercise) => HTMLElement): HTMLElement[] {
    const cards = (some: readonly Exercise[]) => el('ul', { class: 'cards' }, ...some.map(card));
    if (group !== 'cases') return [cards(of)];
    const sites = bySite(this.filter.apply(of));
    if (sites.length === 0) return [this.filter.root, el('p', { class: 'hint' }, text('No case is like that.'))];
    return [
      this.filter.root,
      ...sites.map((s) => el('div', { class: 'site' }, el('h3', {}, siteText(s.site)), cards(s.cases))),
    ];
  }

  /** running: the scene that the engine has now. */
  show(exercises: readonly Exercise[], history: ReadonlyMap<string, History>, running: string): void {
    this.again = () => this.show(exercises, history, running);
    this.fill(exercises, history, running);
  }

  private fill(exercises: readonly Exercise[], history: ReadonlyMap<string, History>, running: string): void {
    const groups = [...new Set(exercises.map((e) => e.group))];
    this.root.replaceChildren(
      ...groups.map((group) =>
        el(
          'section',
          { class: 'group' },
          el('h2', {}, groupTitles[group] ?? said(group)),
          ...this.lists(
            group,
            exercises.filter((e) => e.group === group),
            (e) => this.card(e, history.get(e.scene), e.scene === running),
          ),
        ),
      ),
    );
    if (exercises.length === 0)
      this.root.replaceChildren(el('p', { class: 'hint' }, text('No exercises were found beside this program.')));
  }

  private card(e: Exercise, history: History | undefined, running: boolean): HTMLElement {
    const state = stateOf(history);
    const begin = el('button', { type: 'button' }, running ? text('Continue') : text('Begin'));
    begin.setAttribute(
      'aria-label',
      running ? text('Continue: {exercise}', { exercise: e.title }) : text('Begin: {exercise}', { exercise: e.title }),
    );
    begin.onclick = () => this.actions.begin(e);
    const buttons = [begin];
    if (history) {
      const progress = el('button', { type: 'button', class: 'plain' }, text('Progress'));
      progress.setAttribute('aria-label', text('Progress in {exercise}', { exercise: e.title }));
      progress.onclick = () => this.actions.progress(e);
      buttons.push(progress);
    }
    const picture = e.picture
      ? el('img', { src: this.api.picture(e.scene), alt: '', loading: 'lazy', width: '480', height: '270' })
      : el('div', { class: 'no-picture', 'aria-hidden': 'true' }, e.title.slice(0, 1));
    const results = history?.last
      ? [
          el('p', { class: 'result' }, text('Last: {result}', { result: resultText(history.last) })),
          ...(history.best && history.best.uuid !== history.last.uuid
            ? [el('p', { class: 'result' }, text('Best: {result}', { result: resultText(history.best) }))]
            : []),
        ]
      : [];
    return el(
      'li',
      { class: 'card', 'data-scene': e.scene, 'data-state': state },
      picture,
      el(
        'div',
        { class: 'body' },
        el('h3', {}, e.title),
        el('p', { class: 'state', 'data-state': state }, stateText[state]),
        ...(e.difficulty === 0 ? [] : [el('p', { class: 'state' }, difficultyText(e.difficulty))]),
        el('p', { class: 'text' }, e.text),
        ...results,
        el('div', { class: 'row' }, ...buttons),
      ),
    );
  }
}
