// SPDX-License-Identifier: GPL-3.0-or-later
// Notes of those who watch a recording, each at a time. They are kept beside the file, or given to the person to keep.
import { el } from '../hud/dom';
import { clockText } from '../hud/state';
import { download, fetchNotes, type Note, notesJson, storeNotes } from './source';
import { text } from '../languages/text';

export class Notes {
  all: Note[] = [];
  readonly root = el('form', { class: 'panel note-form' });
  private readonly words = el('input', { type: 'text', maxlength: '500', 'aria-label': text('note') });
  private readonly label = el('label');
  private timeS = 0;

  /** kept: the gateway keeps notes beside this recording. */
  constructor(
    private readonly name: string,
    private readonly kept: boolean,
    private readonly changed: () => void,
    private readonly fail: (why: string) => void,
  ) {
    const away = el('button', { type: 'button' }, text('Cancel'));
    away.onclick = () => this.close();
    this.root.append(this.label, this.words, el('button', { type: 'submit' }, text('Keep')), away);
    this.root.hidden = true;
    this.root.onsubmit = (e) => {
      e.preventDefault();
      const written = this.words.value.trim();
      if (written !== '') void this.keep([...this.all, { timeS: this.timeS, text: written }]);
      this.close();
    };
    this.root.addEventListener('keydown', (e) => {
      e.stopPropagation();
      if (e.key === 'Escape') this.close();
    });
  }

  async load(): Promise<void> {
    if (!this.kept) return;
    try {
      this.all = await fetchNotes(this.name);
      this.changed();
    } catch (e) {
      this.fail(text('Notes cannot be read: {why}', { why: e instanceof Error ? e.message : String(e) }));
    }
  }

  ask(timeS: number): void {
    this.timeS = timeS;
    this.label.textContent = text('Note at {time}', { time: clockText(timeS) });
    this.words.value = '';
    this.root.hidden = false;
    this.words.focus();
  }

  remove(timeS: number, note: string): void {
    void this.keep(this.all.filter((n) => n.timeS !== timeS || n.text !== note));
  }

  private close(): void {
    this.root.hidden = true;
    this.words.blur();
  }

  /** The page shows only what is kept. */
  private async keep(notes: Note[]): Promise<void> {
    notes.sort((a, b) => a.timeS - b.timeS);
    try {
      if (this.kept) await storeNotes(this.name, notes);
      else download(`${this.name}.notes.json`, new Blob([notesJson(notes)], { type: 'application/json' }));
      this.all = notes;
      this.changed();
    } catch (e) {
      this.fail(text('The note is not kept: {why}', { why: e instanceof Error ? e.message : String(e) }));
    }
  }
}
