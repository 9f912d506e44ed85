// SPDX-License-Identifier: GPL-3.0-or-later
// The drop-down of clips beside an applier: pictures, sizes, what is loaded, what is already placed.
import type { Bundle, ToolData } from '../bundle';
import { appliers, ask, type UserCommand } from './commands';
import { el, set_text } from './dom';
import type { ClipView } from './state';

interface Entry {
  tool: ToolData;
  button: HTMLButtonElement;
  badge: HTMLElement;
}

export function clip_facts(tool: ToolData): string {
  const c = tool.clip;
  if (!c) return '';
  return [c.kind, c.blade_length_m === null ? '' : `${(c.blade_length_m * 1000).toFixed(0)} mm`, c.closing_force_N === null ? '' : `${c.closing_force_N.toFixed(1)} N`].filter((x) => x !== '').join(' · ');
}

/** "", "loaded", "in the field", "taken": what stands beside a clip, and whether it may be asked for. */
export function clip_badge(state: ClipView | undefined, applier: string): { text: string; may_load: boolean } {
  if (!state || state.state === 'tray') return { text: state && state.applications > 0 ? `used ${state.applications}×` : '', may_load: true };
  if (state.state === 'free') return { text: 'in the field', may_load: false };
  return { text: state.holder === applier || state.holder === '' ? 'loaded' : 'taken', may_load: false };
}

export class ClipChooser {
  readonly root = el('div', { class: 'clips' });
  private readonly head = el('button', { class: 'clip-head', 'aria-haspopup': 'listbox', 'aria-expanded': 'false', title: 'clip in the applier (L)' });
  private readonly list = el('div', { class: 'clip-list', role: 'listbox', 'aria-label': 'Clips' });
  private entries: Entry[] = [];
  private applier: ToolData | null = null;
  private shown = '?';

  constructor(private readonly run: (c: UserCommand) => void, private readonly may_drive: boolean) {
    this.root.append(this.head, this.list);
    this.head.onclick = () => this.toggle();
    // Keys in the list choose a clip; they must not move the hand.
    this.root.addEventListener('keydown', (e) => this.key(e));
    window.addEventListener('pointerdown', (e) => { if (!this.root.contains(e.target as Node)) this.close(); });
    this.close();
  }

  show_scene(bundle: Bundle): void {
    this.applier = appliers(bundle)[0] ?? null;
    const clips = this.applier ? bundle.tools.filter((t) => t.clip !== null && t.hand !== 'left' && t.hand !== 'right') : [];
    this.entries = clips.map((tool) => {
      const badge = el('span', { class: 'badge' });
      const button = el('button', { role: 'option', 'data-clip': tool.id },
        tool.picture ? el('img', { src: tool.picture, alt: '' }) : el('span', { class: 'no-picture' }),
        el('span', { class: 'what' }, el('b', {}, tool.title), el('small', {}, clip_facts(tool))), badge);
      button.onclick = () => { if (this.applier) this.run(ask(this.applier.id, 'load', tool.id)); this.close(); };
      return { tool, button, badge };
    });
    this.list.replaceChildren(...this.entries.map((e) => e.button));
    this.root.hidden = this.entries.length === 0;
    this.shown = '?';
    this.close();
    this.show([]);
  }

  show(states: readonly ClipView[]): void {
    if (!this.applier) return;
    const key = states.map((s) => `${s.id} ${s.state} ${s.holder} ${s.applications}`).join();
    if (key === this.shown) return;
    this.shown = key;
    let loaded: ToolData | null = null;
    for (const { tool, button, badge } of this.entries) {
      const state = clip_badge(states.find((s) => s.id === tool.id), this.applier.id);
      set_text(badge, state.text);
      badge.dataset.state = state.text;
      button.disabled = !this.may_drive || !state.may_load;
      button.setAttribute('aria-selected', String(state.text === 'loaded'));
      if (state.text === 'loaded') loaded = tool;
    }
    this.head.replaceChildren(...(loaded?.picture ? [el('img', { src: loaded.picture, alt: '' })] : []),
      el('span', { class: 'what' }, el('b', {}, loaded ? loaded.title : 'No clip loaded'), el('small', {}, loaded ? clip_facts(loaded) : 'choose one')), el('span', { class: 'arrow' }, '▾'));
  }

  toggle(): void {
    if (this.root.hidden) return;
    if (!this.list.hidden) { this.close(); return; }
    this.list.hidden = false;
    this.head.setAttribute('aria-expanded', 'true');
    this.usable()[0]?.focus();
  }

  private close(): void {
    const had_focus = this.root.contains(document.activeElement);
    this.list.hidden = true;
    this.head.setAttribute('aria-expanded', 'false');
    if (had_focus) (document.activeElement as HTMLElement).blur();
  }

  private usable(): HTMLButtonElement[] { return this.entries.map((e) => e.button).filter((b) => !b.disabled); }

  private key(e: KeyboardEvent): void {
    if (e.ctrlKey || e.metaKey || e.altKey) return;
    if (this.list.hidden) return;
    e.stopPropagation();
    const at = this.usable().findIndex((b) => b === document.activeElement);
    const n = this.usable().length;
    if (e.code === 'ArrowDown' && n > 0) { e.preventDefault(); this.usable()[(at + 1) % n]!.focus(); }
    else if (e.code === 'ArrowUp' && n > 0) { e.preventDefault(); this.usable()[(at - 1 + n) % n]!.focus(); }
    else if (e.code === 'Escape' || e.code === 'KeyL') { e.preventDefault(); this.close(); }
    else if (/^Digit[1-9]$/.test(e.code)) this.entries[Number(e.code.slice(5)) - 1]?.button.click();
  }
}
