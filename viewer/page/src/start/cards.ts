// SPDX-License-Identifier: GPL-3.0-or-later
// The exercises as cards, by group: picture, title, what is to be done, and how the last run went. A case with several
// exercises is one card.
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

/** What the page knows of runs; running: the scene that the engine has now. */
interface Runs {
  history: ReadonlyMap<string, History>;
  running: string;
}

export class Cards {
  readonly root = el('div', { class: 'groups' });

  private readonly filter = new CaseFilter(() => this.again());
  private again: () => void = () => undefined;

  constructor(
    private readonly api: Api,
    private readonly actions: CardActions,
  ) {}

  show(exercises: readonly Exercise[], history: ReadonlyMap<string, History>, running: string): void {
    this.again = () => this.fill(exercises, { history, running });
    this.again();
  }

  private lists(group: string, of: readonly Exercise[], runs: Runs): HTMLElement[] {
    const cards = (some: readonly Exercise[][]) =>
      el('ul', { class: 'cards' }, ...some.map((exercises) => this.card(exercises, runs)));
    if (group !== 'cases') return [cards(of.map((e) => [e]))];
    const sites = bySite(this.filter.apply(of));
    if (sites.length === 0) return [this.filter.root, el('p', { class: 'hint' }, text('No case is like that.'))];
    return [
      this.filter.root,
      ...sites.map((s) => el('div', { class: 'site' }, el('h3', {}, siteText(s.site)), cards(s.cases))),
    ];
  }

  private fill(exercises: readonly Exercise[], runs: Runs): void {
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
            runs,
          ),
        ),
      ),
    );
    if (exercises.length === 0)
      this.root.replaceChildren(el('p', { class: 'hint' }, text('No exercises were found beside this program.')));
  }

  /** The first exercise names the card; each has its own state and its own buttons. */
  private card(exercises: readonly Exercise[], runs: Runs): HTMLElement {
    const [first, ...more] = exercises as [Exercise, ...Exercise[]];
    const pictured = exercises.find((e) => e.picture);
    const picture = pictured
      ? el('img', { src: this.api.picture(pictured.scene), alt: '', loading: 'lazy', width: '480', height: '270' })
      : el('div', { class: 'no-picture', 'aria-hidden': 'true' }, first.title.slice(0, 1));
    const body = el('div', { class: 'body' }, el('h3', {}, first.title), ...this.exercise(first, runs));
    return el(
      'li',
      { class: 'card', 'data-scene': first.scene, 'data-state': stateOf(runs.history.get(first.scene)) },
      picture,
      body,
      ...more.map((e) =>
        el(
          'section',
          { class: 'body more', 'data-scene': e.scene },
          el('h4', {}, e.name === '' ? e.title : e.name),
          ...this.exercise(e, runs),
        ),
      ),
    );
  }

  /** What is said of an exercise below its title, with its buttons. */
  private exercise(e: Exercise, { history, running }: Runs): HTMLElement[] {
    const known = history.get(e.scene);
    const state = stateOf(known);
    const results = known?.last
      ? [
          el('p', { class: 'result' }, text('Last: {result}', { result: resultText(known.last) })),
          ...(known.best && known.best.uuid !== known.last.uuid
            ? [el('p', { class: 'result' }, text('Best: {result}', { result: resultText(known.best) }))]
            : []),
        ]
      : [];
    return [
      el('p', { class: 'state', 'data-state': state }, stateText[state]),
      ...(e.difficulty === 0 ? [] : [el('p', { class: 'state' }, difficultyText(e.difficulty))]),
      el('p', { class: 'text' }, e.text),
      ...results,
      el('div', { class: 'row' }, ...this.buttons(e, known !== undefined, e.scene === running)),
    ];
  }

  private buttons(e: Exercise, known: boolean, running: boolean): HTMLElement[] {
    const begin = el('button', { type: 'button' }, running ? text('Continue') : text('Begin'));
    begin.setAttribute(
      'aria-label',
      running ? text('Continue: {exercise}', { exercise: e.title }) : text('Begin: {exercise}', { exercise: e.title }),
    );
    begin.onclick = () => this.actions.begin(e);
    if (!known) return [begin];
    const progress = el('button', { type: 'button', class: 'plain' }, text('Progress'));
    progress.setAttribute('aria-label', text('Progress in {exercise}', { exercise: e.title }));
    progress.onclick = () => this.actions.progress(e);
    return [begin, progress];
  }
}
