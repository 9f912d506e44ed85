// SPDX-License-Identifier: GPL-3.0-or-later
// Recorded sessions of the one who is here, to look at again.
import { el } from '../hud/dom';
import { languageTag, text } from '../languages/text';
import { listSessions } from '../replay/source';
import { list, runOf } from './api';
import type { Api, Run } from './api';
import { resultText } from './wording';

const most = 30;

/** One line for each recording that is still there, with its newest run. runs: the newest first. */
export function recorded(runs: readonly Run[], names: ReadonlySet<string>): { name: string; runs: Run[] }[] {
  const out = new Map<string, Run[]>();
  for (const run of runs)
    if (names.has(run.recording)) out.set(run.recording, [...(out.get(run.recording) ?? []), run]);
  return [...out].map(([name, of]) => ({ name, runs: of }));
}

export class Recordings {
  readonly root = el('details', { class: 'recordings' });

  constructor(private readonly api: Api) {
    this.root.hidden = true;
  }

  /** person: '' shows those of guests. */
  async show(person: string): Promise<void> {
    const [runs, sessions] = await Promise.all([this.api.ask('runs', { person }), listSessions()]);
    const known = new Set(sessions.map((s) => s.name));
    const rows = recorded(
      list(runs)
        .map(runOf)
        .filter((r) => r !== null),
      known,
    ).slice(0, most);
    this.root.hidden = known.size === 0;
    this.root.replaceChildren(
      el('summary', {}, text('Recordings ({count})', { count: rows.length })),
      el('ul', {}, ...rows.map(({ name, runs: of }) => this.row(name, of))),
      el('a', { href: 'replay.html' }, text('All recordings on this machine')),
    );
  }

  private row(name: string, runs: readonly Run[]): HTMLElement {
    const newest = runs[0]!;
    const when = new Date(newest.beganMs).toLocaleString(languageTag());
    const link = el('a', { href: `replay.html?session=${encodeURIComponent(name)}` }, text('Replay'));
    link.setAttribute('aria-label', text('Replay {title} of {when}', { title: newest.title, when }));
    const more = text('{count, plural, one {# run} other {# runs}}', { count: runs.length });
    return el(
      'li',
      { class: 'row' },
      el('span', { class: 'when' }, when),
      el('span', { class: 'title' }, newest.title),
      el('span', { class: 'hint' }, `${resultText(newest)}${runs.length > 1 ? ` (${more})` : ''}`),
      link,
    );
  }
}
