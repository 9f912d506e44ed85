// SPDX-License-Identifier: GPL-3.0-or-later
// Who is here: a choice among those who are known, a guest, and a form for somebody new.
import { browserStore } from '../browser_store';
import { el } from '../hud/dom';
import type { Api, Person } from './api';
import { listed } from '../languages/lists';
import { text } from '../languages/text';

/** What is kept and what is read. */
const roles: Record<string, string> = {
  student: text('student'),
  resident: text('resident'),
  fellow: text('fellow'),
  specialist: text('specialist'),
  instructor: text('instructor'),
  other: text('other'),
};
const hands: Record<string, string> = {
  right: text('right'),
  left: text('left'),
  both: text('both'),
  'not said': text('not said'),
};
const kept = 'insula.person';

const options = (values: Readonly<Record<string, string>>, chosen: string): HTMLOptionElement[] =>
  Object.entries(values).map(([v, read]) => {
    const o = el('option', { value: v }, read);
    o.selected = v === chosen;
    return o;
  });

export class People {
  readonly root = el('section', { class: 'people', 'aria-labelledby': 'people-title' });
  private readonly select = el('select', { id: 'person', 'aria-label': text('who you are') });
  private readonly add = el('button', { type: 'button', class: 'plain' }, text('Add a person'));
  private readonly form = el('form', { class: 'add-person' });
  private readonly pseudonym = el('input', { id: 'pseudonym', maxlength: '40', required: '', autocomplete: 'off' });
  private readonly role = el('select', { id: 'role' }, ...options(roles, 'resident'));
  private readonly hand = el('select', { id: 'handedness' }, ...options(hands, 'right'));
  private readonly year = el('input', { id: 'year', type: 'number', min: '1', max: '60', step: '1' });
  private readonly wrong = el('p', { class: 'wrong', role: 'alert' });
  private people: Person[] = [];

  /** changed: called with the pseudonym of whoever is chosen; empty: a guest. */
  constructor(
    private readonly api: Api,
    private readonly changed: (person: string) => void,
  ) {
    const field = (label: string, input: HTMLElement) => el('label', {}, el('span', {}, label), input);
    const cancel = el('button', { type: 'button', class: 'plain' }, text('Cancel'));
    this.form.append(
      field(text('Pseudonym'), this.pseudonym),
      field(text('Role'), this.role),
      field(text('Better hand'), this.hand),
      field(text('Year of training'), this.year),
      el('div', { class: 'row' }, el('button', { type: 'submit' }, text('Add')), cancel),
      this.wrong,
    );
    this.form.hidden = true;
    this.root.append(
      el('h2', { id: 'people-title' }, text('Who are you?')),
      el('div', { class: 'row' }, this.select, this.add),
      this.form,
      el(
        'p',
        { class: 'hint' },
        text('Your runs are kept on this machine under a pseudonym of yours. A guest needs nothing.'),
      ),
    );
    this.select.onchange = () => this.choose(this.select.value);
    this.add.onclick = () => this.open(true);
    cancel.onclick = () => this.open(false);
    this.form.onkeydown = (e) => {
      if (e.key === 'Escape') this.open(false);
    };
    this.form.onsubmit = (e) => {
      e.preventDefault();
      void this.submit();
    };
  }

  get person(): string {
    return this.select.value;
  }

  async load(preferred: string): Promise<void> {
    this.people = await this.api.people();
    const names = this.people.map((p) => p.pseudonym);
    const wanted = [preferred, browserStore()?.getItem(kept) ?? ''].find((n) => names.includes(n)) ?? '';
    this.show(wanted);
  }

  private show(chosen: string): void {
    const guest = el('option', { value: '' }, text('Guest'));
    const others = this.people.map((p) => {
      const more = [
        p.role === 'other' ? '' : (roles[p.role] ?? p.role),
        p.year > 0 ? text('year {year}', { year: p.year }) : '',
      ].filter((t) => t !== '');
      return el('option', { value: p.pseudonym }, more.length > 0 ? `${p.pseudonym} (${listed(more)})` : p.pseudonym);
    });
    this.select.replaceChildren(guest, ...others);
    this.select.value = chosen;
    this.choose(chosen);
  }

  private choose(person: string): void {
    browserStore()?.setItem(kept, person);
    this.changed(person);
  }

  private open(shown: boolean): void {
    this.form.hidden = !shown;
    this.wrong.textContent = '';
    (shown ? this.pseudonym : this.add).focus();
  }

  private async submit(): Promise<void> {
    const pseudonym = this.pseudonym.value.trim();
    const person = {
      pseudonym,
      role: this.role.value,
      handedness: this.hand.value,
      year: Number(this.year.value) || 0,
    };
    try {
      await this.api.addPerson(person);
      this.people = await this.api.people();
      this.form.reset();
      this.open(false);
      this.show(pseudonym);
    } catch (e) {
      this.wrong.textContent = e instanceof Error ? e.message : String(e);
    }
  }
}
