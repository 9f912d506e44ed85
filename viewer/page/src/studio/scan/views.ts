// SPDX-License-Identifier: GPL-3.0-or-later
// The scan or the surface, beside the steps.
import { el } from '../../hud/dom';
import { text } from '../../languages/text';
import type { Project } from '../api';

export class Views {
  readonly root: HTMLElement;
  private readonly bar = el('div', { class: 'buttons', role: 'group' });
  private readonly toScan = el('button', { type: 'button' }, text('Scan'));
  private readonly toSurface = el('button', { type: 'button' }, text('Surface'));
  private isScan = false;
  private hasSurface = true;
  private onSurface = false;

  constructor(
    private readonly scan: HTMLElement,
    private readonly surface: HTMLElement,
  ) {
    this.bar.setAttribute('aria-label', text('What is shown'));
    this.bar.append(this.toScan, this.toSurface);
    this.toScan.onclick = () => this.choose(false);
    this.toSurface.onclick = () => this.choose(true);
    this.root = el('div', { class: 'views' }, this.bar, scan, surface);
    this.lay();
  }

  show(p: Project): void {
    this.isScan = p.scan !== null;
    this.hasSurface = p.facts !== null;
    this.lay();
  }

  choose(surface: boolean): void {
    this.onSurface = surface;
    this.lay();
  }

  private lay(): void {
    const surface = !this.isScan || (this.onSurface && this.hasSurface);
    this.bar.hidden = !this.isScan;
    this.scan.hidden = surface;
    this.surface.hidden = !surface;
    this.toSurface.disabled = !this.hasSurface;
    this.toScan.setAttribute('aria-pressed', String(!surface));
    this.toSurface.setAttribute('aria-pressed', String(surface));
  }
}
