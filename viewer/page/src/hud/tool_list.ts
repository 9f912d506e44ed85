// SPDX-License-Identifier: GPL-3.0-or-later
// The drop-down beside an instrument that takes up other tools of the scene: pictures, properties, what it holds,
// what is already in the field.
import { toolState } from '../hand_tool';
import { spoken } from '../bundle';
import type { Bundle, ToolData } from '../bundle_types';
import type { RenderFrame } from '../lcm';
import { ask, type ToolCommand, toolCommands, type UserCommand } from './commands';
import { el, setText } from './dom';
import { said } from '../languages/said';
import { text } from '../languages/text';

interface Entry {
  tool: ToolData;
  button: HTMLButtonElement;
  badge: HTMLElement;
}

/** "permanent · 7 mm · 1.5 N". */
export const toolFacts = (tool: ToolData): string =>
  [...tool.tags, ...tool.properties.map((p) => p.text)]
    .filter((x) => x !== '')
    .map(said)
    .join(' · ');

type ToolState = Pick<RenderFrame['tool'][number], 'state' | 'hand'>;

/** What stands beside a tool, and whether it may be asked for; hand: of the instrument. */
export function toolBadge(tool: ToolState | undefined, hand: number): { text: string; free: boolean } {
  if (!tool || tool.state === toolState.onTray) return { text: '', free: true };
  if (tool.state === toolState.inField) return { text: 'in the field', free: false };
  return { text: tool.hand === hand ? 'loaded' : 'taken', free: false };
}

const badgeTexts: Record<string, string> = {
  'in the field': text('in the field'),
  loaded: text('loaded'),
  taken: text('taken'),
};

export class ToolList {
  readonly root = el('div', { class: 'tool-list' });
  private readonly head = el('button', {
    class: 'tool-list-head',
    'aria-haspopup': 'listbox',
    'aria-expanded': 'false',
  });
  private readonly list = el('div', { class: 'tool-list-entries', role: 'listbox' });
  private entries: Entry[] = [];
  private offer: ToolCommand | null = null;
  private shown = '?';

  private before: Element | null = null;

  constructor(
    private readonly run: (c: UserCommand) => void,
    private readonly mayDrive: boolean,
  ) {
    this.root.append(this.head, this.list);
    this.head.onclick = () => this.toggle();
    // Keys in the list choose a tool; they must not move the hand.
    this.root.addEventListener('keydown', (e) => this.key(e));
    window.addEventListener('pointerdown', (e) => {
      if (!this.root.contains(e.target as Node)) this.close();
    });
    this.close();
  }

  /** Of several instruments that take up tools the first has the list. */
  showScene(bundle: Bundle): void {
    this.offer = toolCommands(bundle)[0] ?? null;
    this.entries = (this.offer?.tools ?? []).map((tool) => this.makeEntry(tool));
    this.list.replaceChildren(...this.entries.map((e) => e.button));
    this.root.hidden = this.entries.length === 0;
    if (this.offer) {
      const { holder, command } = this.offer;
      this.head.title = `${said(command.doc) || spoken(command.name)}: ${said(holder.title)} (L)`;
      this.list.setAttribute('aria-label', said(holder.title));
    }
    this.shown = '?';
    this.close();
    this.show([]);
  }

  /** Tools of the newest frame. */
  show(tools: readonly (ToolState & { index: number })[]): void {
    if (!this.offer) return;
    const hand = this.offer.holder.hand === 'left' ? 0 : 1;
    const states = this.entries.map((e) =>
      toolBadge(
        tools.find((t) => t.index === e.tool.index),
        hand,
      ),
    );
    const key = states.map((s) => s.text).join();
    if (key === this.shown) return;
    this.shown = key;
    this.entries.forEach(({ button, badge }, k) => {
      const state = states[k]!;
      setText(badge, badgeTexts[state.text] ?? '');
      badge.dataset.state = state.text;
      button.disabled = !this.mayDrive || !state.free;
      button.setAttribute('aria-selected', String(state.text === 'loaded'));
    });
    this.showHead(this.entries[states.findIndex((s) => s.text === 'loaded')]?.tool ?? null);
  }

  toggle(): void {
    if (this.root.hidden) return;
    if (!this.list.hidden) {
      this.close(true);
      return;
    }
    this.before = document.activeElement;
    this.list.hidden = false;
    this.head.setAttribute('aria-expanded', 'true');
    this.usable()[0]?.focus();
  }

  private makeEntry(tool: ToolData): Entry {
    const badge = el('span', { class: 'badge' });
    const button = el(
      'button',
      { role: 'option', 'data-choice': tool.id },
      tool.picture ? el('img', { src: tool.picture, alt: '' }) : el('span', { class: 'no-picture' }),
      el('span', { class: 'what' }, el('b', {}, said(tool.title)), el('small', {}, toolFacts(tool))),
      badge,
    );
    button.onclick = (e) => {
      if (this.offer) this.run(ask(this.offer.holder.id, this.offer.command.name, tool.id));
      // A click without a pointer is one by key.
      this.close(e.detail === 0);
    };
    return { tool, button, badge };
  }

  private showHead(loaded: ToolData | null): void {
    const kind = spoken(this.offer?.tools[0]?.kind ?? 'tool');
    const title = loaded ? said(loaded.title) : text('No {kind} loaded', { kind });
    this.head.replaceChildren(
      ...(loaded?.picture ? [el('img', { src: loaded.picture, alt: '' })] : []),
      el(
        'span',
        { class: 'what' },
        el('b', {}, title),
        el('small', {}, loaded ? toolFacts(loaded) : text('choose one')),
      ),
      el('span', { class: 'arrow' }, '▾'),
    );
  }

  /** byKey: the focus goes back to where it was before. Who uses the mouse goes on in the field. */
  private close(byKey = false): void {
    const within = document.activeElement;
    const hadFocus = this.root.contains(within);
    this.list.hidden = true;
    this.head.setAttribute('aria-expanded', 'false');
    if (!hadFocus || !(within instanceof HTMLElement)) return;
    if (byKey && this.before instanceof HTMLElement) this.before.focus({ preventScroll: true });
    else within.blur();
  }

  private usable(): HTMLButtonElement[] {
    return this.entries.map((e) => e.button).filter((b) => !b.disabled);
  }

  private key(e: KeyboardEvent): void {
    if (e.ctrlKey || e.metaKey || e.altKey || this.list.hidden) return;
    e.stopPropagation();
    const usable = this.usable();
    const at = usable.findIndex((b) => b === document.activeElement);
    const go = (step: number) => {
      e.preventDefault();
      usable[(at + step + usable.length) % usable.length]!.focus();
    };
    if (e.code === 'ArrowDown' && usable.length > 0) go(1);
    else if (e.code === 'ArrowUp' && usable.length > 0) go(-1);
    else if (e.code === 'Escape' || e.code === 'KeyL') {
      e.preventDefault();
      this.close(true);
    } else if (/^Digit[1-9]$/.test(e.code)) this.entries[Number(e.code.slice(5)) - 1]?.button.click();
  }
}
