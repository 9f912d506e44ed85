// SPDX-License-Identifier: GPL-3.0-or-later
// The curriculum that somebody follows: what is next as one button, and all modules with their tasks and gates.
import { el } from '../hud/dom';
import { listed } from '../languages/lists';
import { momentText } from '../languages/numbers';
import { languageTag, text } from '../languages/text';
import type { Api } from './api';
import { askCourse, askCurricula, follow } from './course_api';
import type { Course, CourseModule, CourseTask, Curricula, Gate, Next, Standing, Terms } from './course_api';
import { gateText } from './gate_words';
import { resultText } from './wording';

const againMs = 700;

export interface CourseActions {
  /** Begins an attempt that counts. */
  begin(terms: Terms): void;
  /** Shows the certificate of the curriculum that was passed. */
  certificate(curriculum: string): void;
  tell(text: string): void;
}

export function standingText(standing: Standing): string {
  switch (standing) {
    case 'locked':
      return text('locked');
    case 'open':
      return text('not passed yet');
    case 'passed':
      return text('✓ passed');
    case 'due':
      return text('due again');
    case 'lapsed':
      return text('lapsed: pass it again');
  }
}

export const dayText = (ms: number): string => new Date(ms).toLocaleDateString(languageTag());

function gateLine(gate: Gate): HTMLElement {
  const done = gate.needed > 1 ? ` (${text('{done} of {needed}', { done: gate.inARow, needed: gate.needed })})` : '';
  return el('li', { 'data-met': String(gate.met) }, `${gate.met ? '✓' : '○'} ${gateText(gate.condition)}${done}`);
}

/** Why this comes next. */
export function whyText({ why, left }: Next): string {
  switch (why) {
    case 'warm_up':
      return text('Warm up before the first work of the day: {left, plural, one {once} other {# times}}.', { left });
    case 'open':
      return text('Its gates are still to be met.');
    case 'repetition_due':
      return text('A repetition is due.');
    case 'repetition_failed':
      return text('A repetition was not passed.');
    case 'repetition_missed':
      return text('A repetition was missed.');
    case 'nothing':
      return text('Nothing is left to do now.');
    default:
      return '';
  }
}

/** Titles of modules and tasks by their ids. */
function titlesOf(course: Course): Map<string, string> {
  const out = new Map<string, string>();
  for (const m of course.modules) {
    out.set(m.id, m.title);
    for (const t of m.tasks) out.set(t.id, t.title);
  }
  return out;
}

function whenText(task: CourseTask): string {
  if (task.passedMs === null) return '';
  const passed = text('Passed on {day}.', { day: dayText(task.passedMs) });
  return task.dueMs === null ? passed : `${passed} ${text('Next repetition: {day}.', { day: dayText(task.dueMs) })}`;
}

export class CoursePanel {
  readonly root = el('section', { class: 'course', 'aria-labelledby': 'course-title' });
  private person = '';
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(
    private readonly api: Api,
    private readonly actions: CourseActions,
  ) {
    this.root.hidden = true;
  }

  /** The one whose way is shown; '': a guest, who has none. */
  async show(person: string): Promise<void> {
    clearTimeout(this.timer);
    this.person = person;
    this.root.hidden = person === '';
    if (person === '') return;
    const course = await askCourse(this.api, person);
    if (person !== this.person) return;
    if (course.state === 'loading' || course.id === '') return this.choose(course.id);
    if (course.state !== 'ready') return this.fill(el('p', { class: 'hint' }, course.problem));
    this.fill(this.head(course), this.next(course), this.modules(course));
  }

  private fill(...parts: HTMLElement[]): void {
    this.root.replaceChildren(el('h2', { id: 'course-title' }, text('Your curriculum')), ...parts);
  }

  /** Nothing is followed yet, or the curricula are still being read. */
  private async choose(followed: string): Promise<void> {
    const person = this.person;
    const known = await askCurricula(this.api);
    if (person !== this.person) return;
    if (known.state === 'loading') {
      this.fill(el('p', { class: 'hint' }, text('The curricula are being read …')));
      this.timer = setTimeout(() => void this.refresh(), againMs);
    } else if (followed === '') this.fill(...this.choice(known));
    else await this.show(this.person);
  }

  private async refresh(): Promise<void> {
    try {
      await this.show(this.person);
    } catch (e) {
      this.actions.tell(e instanceof Error ? e.message : String(e));
    }
  }

  private choice(known: Curricula): HTMLElement[] {
    const good = known.curricula.filter((c) => c.problem === '');
    const problems: HTMLElement[] = known.curricula
      .filter((c) => c.problem !== '')
      .map((c) => el('pre', { class: 'wrong' }, c.problem));
    if (known.problem !== '') problems.push(el('p', { class: 'wrong' }, known.problem));
    if (good.length === 0) return [el('p', { class: 'hint' }, text('No curriculum was found.')), ...problems];
    const select = el(
      'select',
      { id: 'curriculum', 'aria-label': text('curriculum') },
      ...good.map((c) => el('option', { value: c.id }, c.title)),
    );
    const about = el('p', { class: 'hint' });
    select.onchange = () => (about.textContent = good.find((c) => c.id === select.value)?.text ?? '');
    select.onchange(new Event('change'));
    const take = el('button', { type: 'button' }, text('Follow it'));
    take.onclick = () => void this.follow(select.value);
    return [
      el('p', {}, text('A curriculum leads from exercise to exercise, and says when each is learnt.')),
      el('div', { class: 'row' }, select, take),
      about,
      ...problems,
    ];
  }

  private async follow(id: string): Promise<void> {
    try {
      await follow(this.api, this.person, id);
      await this.show(this.person);
    } catch (e) {
      this.actions.tell(e instanceof Error ? e.message : String(e));
    }
  }

  private head(course: Course): HTMLElement {
    const other = el('button', { type: 'button', class: 'plain' }, text('Another curriculum'));
    other.onclick = () => void this.follow('');
    const tasks = course.modules.flatMap((m) => m.tasks);
    const passed = tasks.filter((t) => t.standing === 'passed' || t.standing === 'due').length;
    const progress = el('progress', { max: String(tasks.length), value: String(passed), 'aria-hidden': 'true' });
    return el(
      'div',
      { class: 'row course-head' },
      el('strong', {}, course.title),
      progress,
      el('span', { class: 'hint' }, text('{passed} of {all} tasks passed', { passed, all: tasks.length })),
      other,
    );
  }

  private next(course: Course): HTMLElement {
    const box = el('div', { class: 'next', 'data-kind': course.next.kind });
    if (course.passed) {
      const show = el('button', { type: 'button', class: 'certificate' }, text('Certificate'));
      show.onclick = () => this.actions.certificate(course.id);
      box.append(el('p', {}, el('strong', {}, text('You have passed this curriculum.'))), show);
    }
    if (course.next.kind === 'nothing') {
      box.append(el('p', { class: 'hint' }, whyText(course.next)));
      return box;
    }
    const go = el('button', { type: 'button', class: 'continue' }, text('Continue'));
    go.onclick = () => this.actions.begin(course.next.terms);
    const task = titlesOf(course).get(course.next.task) ?? course.next.terms.sceneTitle;
    const what = course.next.kind === 'warm_up' ? text('Warm-up: {task}', { task }) : task;
    const mode = this.modeText(course.next.terms);
    box.append(
      go,
      el('div', {}, el('strong', {}, what), el('p', { class: 'hint' }, `${mode}. ${whyText(course.next)}`)),
    );
    go.disabled = course.next.terms.scene === '';
    return box;
  }

  private modeText(terms: Terms): string {
    return terms.mode === 'test' ? text('As a test, without help') : text('Practice');
  }

  private modules(course: Course): HTMLElement {
    const titles = titlesOf(course);
    return el('ol', { class: 'modules' }, ...course.modules.map((m) => this.module(m, titles)));
  }

  private module(m: CourseModule, titles: ReadonlyMap<string, string>): HTMLElement {
    const box = el('details', {});
    box.open = m.standing === 'open' || m.standing === 'due' || m.standing === 'lapsed';
    const state = el('span', { class: 'standing', 'data-standing': m.standing }, standingText(m.standing));
    box.append(
      el('summary', {}, el('span', { class: 'title' }, m.title), state),
      ...(m.text === '' ? [] : [el('p', { class: 'hint' }, m.text)]),
      ...(m.lockedBy.length === 0 ? [] : [el('p', { class: 'hint' }, this.lockText(m.lockedBy, titles))]),
      el('ul', { class: 'tasks' }, ...m.tasks.map((t) => this.task(t, titles))),
    );
    return el('li', { 'data-module': m.id, 'data-standing': m.standing }, box);
  }

  private lockText(by: readonly string[], titles: ReadonlyMap<string, string>): string {
    return text('Opens when these have been passed: {titles}', {
      titles: listed(by.map((id) => titles.get(id) ?? id)),
    });
  }

  private task(t: CourseTask, titles: ReadonlyMap<string, string>): HTMLElement {
    const state = el('span', { class: 'standing', 'data-standing': t.standing }, standingText(t.standing));
    const begin = el('button', { type: 'button', class: 'plain' }, text('Begin'));
    begin.setAttribute('aria-label', text('Begin {task}', { task: t.title }));
    begin.onclick = () => this.actions.begin(t.terms);
    begin.disabled = t.standing === 'locked' || t.terms.scene === '';
    const counted = text('{attempts, plural, =0 {No attempt yet} one {# attempt} other {# attempts}}', {
      attempts: t.attempts,
    });
    return el(
      'li',
      { class: 'task', 'data-task': t.id, 'data-standing': t.standing },
      el('div', { class: 'row' }, el('span', { class: 'title' }, t.title), state, begin),
      ...(t.text === '' ? [] : [el('p', { class: 'hint' }, t.text)]),
      ...(t.lockedBy.length === 0 ? [] : [el('p', { class: 'hint' }, this.lockText(t.lockedBy, titles))]),
      el('ul', { class: 'gates' }, ...t.gates.map(gateLine)),
      el('p', { class: 'hint' }, [this.modeText(t.terms), counted, whenText(t)].filter((s) => s !== '').join('. ')),
      ...this.counted(t),
    );
  }

  /** The attempts behind the gates, the newest first. */
  private counted(t: CourseTask): HTMLElement[] {
    if (t.runs.length === 0) return [];
    const rows = [...t.runs].reverse().map((r) => el('li', {}, `${momentText(new Date(r.beganMs))}: ${resultText(r)}`));
    return [
      el('details', { class: 'counted' }, el('summary', {}, text('Attempts that counted')), el('ul', {}, ...rows)),
    ];
  }
}
