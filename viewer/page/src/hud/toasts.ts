// SPDX-License-Identifier: GPL-3.0-or-later
// What must be noticed: refusals in passing, and the instructor's words and advice, which stay until they are read.
import { el } from './dom';
import { text } from '../languages/text';

const refusalMs = 4500;

export class Toasts {
  readonly root = el('div', { class: 'toasts', role: 'status' });
  private readonly shown: { line: HTMLElement; until: number }[] = [];

  refuse(why: string, nowMs: number): void {
    this.add(el('div', { class: 'toast refused' }, why), nowMs + refusalMs);
  }

  /** read: called when the trainee has said that it was understood. */
  instruct(words: string, read: () => void): void {
    this.stay('instruction', text('Instructor'), words, read);
  }

  /** About this machine; once. */
  advise(words: string): void {
    this.stay('advice', text('Advice'), words, () => undefined);
  }

  private stay(kind: string, who: string, words: string, read: () => void): void {
    const close = el('button', {}, text('✓ Read'));
    const line = el('div', { class: `toast ${kind}` }, el('b', {}, who), el('span', {}, words), close);
    close.onclick = () => {
      line.remove();
      read();
    };
    this.add(line, Infinity);
  }

  tick(nowMs: number): void {
    while (this.shown.length > 0 && this.shown.some((s) => s.until < nowMs)) {
      const i = this.shown.findIndex((s) => s.until < nowMs);
      this.shown[i]!.line.remove();
      this.shown.splice(i, 1);
    }
  }

  private add(line: HTMLElement, until: number): void {
    // The same refusal again only lasts longer.
    const same = this.shown.find(
      (s) => s.line.isConnected && s.line.textContent === line.textContent && s.line.className === line.className,
    );
    if (same) {
      same.until = until;
      return;
    }
    this.shown.push({ line, until });
    this.root.append(line);
    // What has not been read is never pushed out.
    const passing = [...this.root.querySelectorAll('.refused')];
    while (passing.length > 3) passing.shift()!.remove();
  }
}
