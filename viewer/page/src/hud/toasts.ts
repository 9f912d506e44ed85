// SPDX-License-Identifier: GPL-3.0-or-later
// What must be noticed: refusals in passing, and the instructor's words, which stay until they are read.
import { el } from './dom';

const refusal_ms = 4500;
const instruction_ms = 15000;

export class Toasts {
  readonly root = el('div', { class: 'toasts', role: 'status' });
  private readonly shown: { line: HTMLElement; until: number }[] = [];

  refuse(why: string, now_ms: number): void { this.add(el('div', { class: 'toast refused' }, why), now_ms + refusal_ms); }

  instruct(text: string, now_ms: number): void {
    const close = el('button', { 'aria-label': 'understood' }, '✓');
    const line = el('div', { class: 'toast instruction' }, el('b', {}, 'Instructor'), el('span', {}, text), close);
    close.onclick = () => line.remove();
    this.add(line, now_ms + instruction_ms);
  }

  tick(now_ms: number): void {
    while (this.shown.length > 0 && this.shown.some((s) => s.until < now_ms)) {
      const i = this.shown.findIndex((s) => s.until < now_ms);
      this.shown[i]!.line.remove();
      this.shown.splice(i, 1);
    }
  }

  private add(line: HTMLElement, until: number): void {
    // The same refusal again only lasts longer.
    const same = this.shown.find((s) => s.line.isConnected && s.line.textContent === line.textContent && s.line.className === line.className);
    if (same) { same.until = until; return; }
    this.shown.push({ line, until });
    this.root.append(line);
    while (this.root.childElementCount > 4) this.root.firstElementChild!.remove();
  }
}
