// SPDX-License-Identifier: GPL-3.0-or-later
// The tools of one hand: a button each; the one in hand is marked, the others lie on the tray.
import type { HandData, ToolData } from '../bundle_types';
import { el } from './dom';
import { exchange, type UserCommand } from './commands';
import { ToolHistory } from './tool_history';
import { said } from '../languages/said';
import { text } from '../languages/text';

export class Tray {
  readonly root = el('div', { class: 'tray', role: 'group' });
  private buttons: { tool: ToolData; button: HTMLButtonElement }[] = [];
  private hand: HandData | null = null;
  private readonly history = new ToolHistory();

  constructor(
    private readonly run: (c: UserCommand) => void,
    private readonly mayDrive: boolean,
  ) {}

  showScene(hand: HandData | null): void {
    this.hand = hand;
    this.forget();
    this.root.setAttribute(
      'aria-label',
      hand?.hand === 'left' ? text('tools of the left hand') : text('tools of the right hand'),
    );
    this.buttons = (hand && hand.tools.length > 1 ? hand.tools : []).map((tool) => {
      const button = el(
        'button',
        { title: said(tool.title), 'data-tool': tool.id },
        ...(tool.picture ? [el('img', { src: tool.picture, alt: '' })] : []),
        el('span', {}, short(tool, hand!.hand)),
      );
      button.onclick = () => {
        this.run(exchange(hand!.hand, tool.id));
      };
      return { tool, button };
    });
    this.root.replaceChildren(...this.buttons.map((b) => b.button));
    this.root.hidden = this.buttons.length === 0;
    this.show('');
  }

  /** id of the tool in hand. */
  show(held: string): void {
    this.history.see(held);
    for (const { tool, button } of this.buttons) {
      button.setAttribute('aria-pressed', String(tool.id === held));
      button.disabled = !this.mayDrive || tool.id === held;
    }
  }

  /** What an exchange would be undone to; null: nothing. */
  get undone(): ToolData | null {
    if (!this.mayDrive) return null;
    return this.hand?.tools.find((t) => t.id === this.history.before) ?? null;
  }

  /** Reverses the last exchange of the hand. */
  undo(): void {
    if (this.undone) this.run(exchange(this.hand!.hand, this.undone.id));
  }

  /** The hand begins anew. */
  forget(): void {
    this.history.forget();
  }

  /** Asks for the next (or previous) tool of the hand. */
  next(step: 1 | -1): void {
    const tools = this.hand?.tools ?? [];
    if (!this.mayDrive || !this.hand || tools.length < 2) return;
    const at = tools.findIndex((t) => t.id === this.history.held);
    this.run(exchange(this.hand.hand, tools[(Math.max(0, at) + step + tools.length) % tools.length]!.id));
  }
}

/** The hand need not be said again in its own list. */
export function short(tool: ToolData, hand: string): string {
  const name = tool.title.startsWith(`${hand} `) ? tool.title.slice(hand.length + 1) : tool.title;
  return said(name || tool.kind.replace(/_/g, ' '));
}

export function toolLabel(tool: ToolData | undefined, hand: number): string {
  return tool ? short(tool, hand === 0 ? 'left' : 'right') : '';
}
