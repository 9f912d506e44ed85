// SPDX-License-Identifier: GPL-3.0-or-later
// The tour beside the field: what is to be done now, and how. It offers itself on the first visit.
import { el, setText } from '../hud/dom';
import { text } from '../languages/text';
import type { Tour } from './tour';

/** For which a step that is done is praised. */
const praiseMs = 1200;

export class TourPanel {
  readonly root = el('section', { class: 'panel tour' });
  /** Begins the tour at any time. */
  readonly button = el('button', { 'data-tour': 'begin' }, text('Tour'));
  private readonly title = el('b');
  private readonly how = el('p');
  private readonly go = el('button', { 'data-tour': 'go' });
  private readonly leave = el('button', { 'data-tour': 'leave' });
  private praiseUntilMs = -Infinity;

  constructor(
    private readonly tour: Tour,
    private readonly field: HTMLElement,
  ) {
    this.root.setAttribute('aria-label', text('tour'));
    this.root.setAttribute('aria-live', 'polite');
    this.button.title = text('microscope, hands, buttons, tools: a walk through all of them');
    this.button.onclick = () => this.enter();
    this.go.onclick = () => this.enter();
    this.leave.onclick = () => {
      tour.leave();
      field.focus({ preventScroll: true });
    };
    this.root.append(this.title, this.how, el('div', { class: 'answers' }, this.go, this.leave));
    this.root.hidden = true;
  }

  /** A step has just ended. */
  praise(nowMs: number): void {
    this.praiseUntilMs = nowMs + praiseMs;
  }

  /** asks: a first visit may be asked now. */
  show(asks: boolean, nowMs: number): void {
    const { tour } = this;
    const offers = !tour.running && asks && tour.fresh;
    this.root.hidden = !tour.running && !offers;
    if (this.root.hidden) return;
    this.go.hidden = tour.running;
    setText(this.go, text('Begin the tour'));
    if (offers) {
      this.say('offer', text('First time here?'), text('A short tour shows microscope, hands, buttons and tools.'));
      setText(this.leave, text('Not now'));
      return;
    }
    setText(this.leave, tour.step ? text('Leave the tour') : text('Close'));
    if (nowMs < this.praiseUntilMs) this.say('done', text('✓ Done'), '');
    else if (tour.step) {
      const where = { at: tour.at + 1, of: tour.of, title: tour.step.title() };
      this.say(tour.step.id, text('{at} of {of}: {title}', where), tour.step.how());
    } else this.say('end', text('✓ You know it all'), text('H shows every key. Good luck with the exercises.'));
  }

  private enter(): void {
    this.tour.enter();
    this.field.focus({ preventScroll: true });
  }

  private say(step: string, title: string, how: string): void {
    this.root.dataset.step = step;
    setText(this.title, title);
    setText(this.how, how);
  }
}
