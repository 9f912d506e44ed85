// SPDX-License-Identifier: GPL-3.0-or-later
// Notes of those who watch a recording, each at a time. They are kept beside the file, or given to the person to keep.
import { el } from '../hud/dom';
import { clockText } from '../hud/state';
import { download, fetchNotes, type Note, notesJson, storeNotes } from './source';

export class Notes {
  all: Note[] = [];
  readonly root = el('form', { class: 'panel note-form' });
  private readonly text = el('input', { type: 'text', maxlength: '500', 'aria-label': 'note' });
  private readonly label = el('label');
  private timeS = 0;

  /** kept: the gateway keeps notes beside this recording. */
  constructor(
    private readonly name: string,
    private readonly kept: boolean,
    private readonly changed: () => void,
    private readonly fail: (why: string) => void,
  ) {
    const away = el('button', { type: 'button' }, 'Cancel');
    away.onclick = () => this.close();
    this.root.append(this.label, this.text, el('button', { type: 'submit' }, 'Keep'), away);
    this.root.hidden = true;
    this.root.onsubmit = (e) => {
      e.preventDefault();
      const text = this.text.value.trim();
      if (text !== '') void this.keep([...this.all, { timeS: this.timeS, text }]);
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
      this.fail(`Notes cannot be read: ${e instanceof Error ? e.message : String(e)}`);
    }
  }

  ask(timeS: number): void {
    this.timeS = timeS;
    this.label.textContent = `Note at ${clockText(timeS)}`;
    this.text.value = '';
    this.root.hidden = false;
    this.text.focus();
  }

  remove(timeS: number, text: string): void {
    void this.keep(this.all.filter((n) => n.timeS !== timeS || n.text !== text));
  }

  private close(): void {
    this.root.hidden = true;
    this.text.blur();
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
      this.fail(`The note is not kept: ${e instanceof Error ? e.message : String(e)}`);
    }
  }
}
