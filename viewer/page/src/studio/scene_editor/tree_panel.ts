// SPDX-License-Identifier: GPL-3.0-or-later
// The elements of the open file as a tree, with keys as the ARIA pattern of a tree has them.
import { el } from '../../hud/dom';
import { text } from '../../languages/text';
import { attribute, type OutlineElement, pathOf } from './outline';

/** What stands beside an element's name. */
const naming = ['id', 'name', 'title', 'file', 'between'];
const longest = 40;

const key = (e: OutlineElement): string => pathOf(e).join('.');

function nameOf(e: OutlineElement): string {
  const found = naming.map((n) => attribute(e, n)?.value).find((v) => v);
  return found === undefined || found.length <= longest ? (found ?? '') : `${found.slice(0, longest)}…`;
}

export class TreePanel {
  readonly root = el('div', { class: 'tree', role: 'tree', 'aria-label': text('Elements of the scene') });
  private readonly closed = new Set<string>();
  private shown: OutlineElement[] = [];
  private top: OutlineElement | null = null;
  private selected: OutlineElement | null = null;
  private wrong: readonly OutlineElement[] = [];

  constructor(private readonly choose: (e: OutlineElement) => void) {
    this.root.addEventListener('keydown', (e) => this.pressed(e));
    this.root.addEventListener('click', (e) => this.clicked(e));
  }

  /** wrong: elements with problems. */
  show(top: OutlineElement | null, selected: OutlineElement | null, wrong: readonly OutlineElement[]): void {
    [this.top, this.selected, this.wrong] = [top, selected, wrong];
    for (let up = selected?.parent; up; up = up.parent) this.closed.delete(key(up));
    this.write();
  }

  private write(): void {
    const focused = this.root.contains(document.activeElement);
    this.shown = this.top ? this.visible(this.top) : [];
    const rows = this.shown.map((e) => this.row(e));
    this.root.replaceChildren(...rows);
    const now = rows[this.shown.indexOf(this.selected ?? this.shown[0]!)] ?? rows[0];
    if (!now) return;
    now.tabIndex = 0;
    if (focused) now.focus({ preventScroll: true });
    const { offsetTop, offsetHeight } = now;
    const { scrollTop, clientHeight } = this.root;
    if (offsetTop < scrollTop || offsetTop + offsetHeight > scrollTop + clientHeight)
      this.root.scrollTop = offsetTop - clientHeight / 2;
  }

  private visible(e: OutlineElement): OutlineElement[] {
    return [e, ...(this.closed.has(key(e)) ? [] : e.children.flatMap((c) => this.visible(c)))];
  }

  private row(e: OutlineElement): HTMLElement {
    const depth = pathOf(e).length;
    const open = !this.closed.has(key(e));
    const row = el('div', {
      role: 'treeitem',
      tabindex: '-1',
      'aria-level': String(depth + 1),
      'aria-selected': String(e === this.selected),
      style: `padding-left: ${6 + 14 * depth}px`,
    });
    if (e.children.length > 0) row.setAttribute('aria-expanded', String(open));
    row.append(
      el('span', { class: 'twisty', 'aria-hidden': 'true' }, e.children.length === 0 ? '' : open ? '▾' : '▸'),
      el('span', { class: 'element' }, e.name),
      el('span', { class: 'hint' }, nameOf(e)),
    );
    if (this.wrong.includes(e)) row.append(el('span', { class: 'wrong', role: 'img', 'aria-label': text('problem') }));
    return row;
  }

  private fold(e: OutlineElement, closed: boolean): void {
    if (closed) this.closed.add(key(e));
    else this.closed.delete(key(e));
    this.write();
  }

  private clicked(event: MouseEvent): void {
    const target = event.target as HTMLElement;
    const row = target.closest('[role=treeitem]');
    const e = row && this.shown[[...this.root.children].indexOf(row)];
    if (!e) return;
    if (target.classList.contains('twisty') && e.children.length > 0) this.fold(e, !this.closed.has(key(e)));
    else this.choose(e);
  }

  private pressed(event: KeyboardEvent): void {
    const e = this.shown[[...this.root.children].indexOf(document.activeElement!)];
    if (!e) return;
    const at = this.shown.indexOf(e);
    const closed = this.closed.has(key(e));
    const go = (to: OutlineElement | null | undefined) => to && this.choose(to);
    const acts: Record<string, () => unknown> = {
      ArrowDown: () => go(this.shown[at + 1]),
      ArrowUp: () => go(this.shown[at - 1]),
      Home: () => go(this.shown[0]),
      End: () => go(this.shown.at(-1)),
      ArrowRight: () => (closed ? this.fold(e, false) : go(e.children[0])),
      ArrowLeft: () => (e.children.length > 0 && !closed ? this.fold(e, true) : go(e.parent)),
      Enter: () => go(e),
    };
    if (!acts[event.key]) return;
    event.preventDefault();
    acts[event.key]!();
  }
}
