// SPDX-License-Identifier: GPL-3.0-or-later
// The question which recording to look at: one of this machine's, or a file.
import { el } from '../hud/dom';
import type { ListedSession } from './source';
import { languageSelect } from '../languages/language_select';
import { fixed } from '../languages/numbers';
import { text } from '../languages/text';

export interface Opening {
  title: string;
  /** A recording of the gateway. */
  named(name: string): void;
  file(file: File): void;
  cancel?(): void;
}

const sizeText = (bytes: number): string => `${fixed(bytes / 1e6, 1)} MB`;

export function openingPanel(sessions: readonly ListedSession[], problem: string, actions: Opening): HTMLElement {
  const input = el('input', { type: 'file', accept: '.insula,.mcap', 'aria-label': text('a file') });
  input.onchange = () => {
    const file = input.files?.[0];
    if (file) actions.file(file);
  };
  const items = sessions.map((s) => {
    const button = el('button', { 'data-session': s.name }, s.name, el('small', {}, sizeText(s.bytes)));
    button.onclick = () => actions.named(s.name);
    return el('li', {}, button);
  });
  const none = items.length === 0 ? [el('p', { class: 'quiet' }, text('No recordings are offered here.'))] : [];
  const cancel = actions.cancel;
  const away = el('button', {}, text('Cancel'));
  away.onclick = () => cancel?.();
  return el(
    'section',
    { class: 'panel opening', role: 'dialog', 'aria-label': actions.title },
    el('h2', {}, actions.title),
    ...(problem ? [el('p', { class: 'bad', role: 'alert' }, problem)] : []),
    el('ul', {}, ...items),
    ...none,
    el('label', {}, text('Or a file:'), ' ', input),
    ...(cancel ? [away] : []),
    languageSelect(),
  );
}
