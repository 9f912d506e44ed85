// SPDX-License-Identifier: GPL-3.0-or-later
// A question over the field. It keeps the keys to itself until it is answered. Its content scrolls; its answers stay
// below it in view.
import { el } from './dom';

export interface Answer {
  text: string;
  /** What the answer means, below it in small letters. */
  detail?: string;
  /** Marks the button for tests and styles. */
  name: string;
  enabled?: boolean;
  run(): void;
}

export class Dialog {
  readonly root: HTMLElement;
  private readonly body = el('div', { class: 'dialog-body' });
  private before: Element | null = null;
  private cancel: (() => void) | null = null;

  /** The field gets the focus back when a dialog closes that was opened from nowhere else. */
  constructor(
    name: string,
    private readonly field: () => HTMLElement | null,
  ) {
    this.root = el('section', { class: `panel dialog ${name}`, role: 'dialog', 'aria-modal': 'true', tabindex: '-1' });
    this.root.append(this.body);
    this.root.hidden = true;
    this.root.addEventListener('keydown', (e) => this.key(e));
  }

  get open(): boolean {
    return !this.root.hidden;
  }

  /** cancel: what Escape does; none: it must be answered. */
  show(title: string, content: (Node | string)[], answers: readonly Answer[], cancel?: () => void): void {
    this.cancel = cancel ?? null;
    this.root.setAttribute('aria-label', title);
    const buttons = answers.map((a) => this.makeAnswer(a));
    this.body.replaceChildren(
      el('h2', {}, title),
      el('div', { class: 'dialog-content', tabindex: '0' }, ...content),
      el('div', { class: 'answers' }, ...buttons),
    );
    if (this.root.hidden) this.before = document.activeElement;
    this.root.hidden = false;
    (buttons.find((b) => !b.disabled) ?? this.root).focus({ preventScroll: true });
  }

  close(): void {
    if (this.root.hidden) return;
    const inside = this.root.contains(document.activeElement);
    this.root.hidden = true;
    if (!inside) return;
    const before = this.before instanceof HTMLElement && this.before !== document.body ? this.before : null;
    (before?.isConnected ? before : this.field())?.focus({ preventScroll: true });
  }

  private makeAnswer(a: Answer): HTMLButtonElement {
    const button = el(
      'button',
      { 'data-answer': a.name },
      el('b', {}, a.text),
      ...(a.detail ? [el('small', {}, a.detail)] : []),
    );
    button.disabled = a.enabled === false;
    button.onclick = () => {
      this.close();
      a.run();
    };
    return button;
  }

  private key(e: KeyboardEvent): void {
    // Keys of a dialog must not move a hand.
    e.stopPropagation();
    if (e.key === 'Escape' && this.cancel) {
      e.preventDefault();
      const cancel = this.cancel;
      this.close();
      cancel();
    } else if (e.key === 'Tab') this.keepFocus(e);
  }

  private keepFocus(e: KeyboardEvent): void {
    const stops = [...this.root.querySelectorAll<HTMLElement>('[tabindex="0"], button:enabled, a[href], summary')];
    const first = stops[0];
    const last = stops[stops.length - 1];
    if (!first || !last) return;
    if (e.shiftKey && document.activeElement === first) {
      e.preventDefault();
      last.focus();
    } else if (!e.shiftKey && document.activeElement === last) {
      e.preventDefault();
      first.focus();
    }
  }
}
