// SPDX-License-Identifier: GPL-3.0-or-later
// What the file holds, and how it is to be read.
import { el } from '../hud/dom';
import { fixed } from '../languages/numbers';
import { text } from '../languages/text';
import type { Facts, Project } from './api';
import type { Asks } from './editor';
import { field, select, toggle } from './fields';
import { forThePage } from './wording';

const grid = 0.2; // mm

export class FilePanel {
  readonly root: HTMLElement;
  private readonly facts = el('div', {});
  private readonly unit = select([
    ['', text('as the file says, or found by its size')],
    ['mm', 'mm'],
    ['cm', 'cm'],
    ['m', 'm'],
    ['inch', text('inch')],
  ]);
  private readonly left = toggle(text('The vessel is of the left side'));
  private readonly anew = toggle(text('Make the surface anew from a grid of {mm} mm', { mm: fixed(grid, 1) }));

  constructor(asks: Asks) {
    // Places that were chosen are those of the surface as it was read before.
    const places = { neck: null, inlet: null, cuts: [] };
    this.unit.onchange = () => asks.choose({ unit: this.unit.value, ...places });
    this.left.input.onchange = () => asks.choose({ mirror: this.left.input.checked });
    this.anew.input.onchange = () => asks.choose({ rebuild_mm: this.anew.input.checked ? grid : null });
    this.root = el(
      'section',
      {},
      el('h3', {}, text('1. The file')),
      this.facts,
      field(text('Unit of its numbers'), this.unit),
      this.left.root,
      this.anew.root,
    );
  }

  show(p: Project): void {
    this.unit.value = p.choices.unit;
    this.unit.parentElement!.hidden = p.scan !== null;
    this.left.input.checked = p.choices.mirror;
    this.anew.input.checked = p.choices.rebuildMm !== null;
    this.facts.replaceChildren(el('p', { class: 'hint' }, p.file), ...this.found(p));
  }

  private found(p: Project): HTMLElement[] {
    if (p.inspect.state === 'running') return [el('p', { role: 'status' }, text('The file is being read …'))];
    if (p.facts) return FilePanel.told(p.facts);
    return p.inspect.error === '' ? [] : [el('p', { class: 'bad' }, forThePage(p.inspect.error))];
  }

  private static told(f: Facts): HTMLElement[] {
    const size = f.sizeMm.map((mm) => fixed(mm, 1)).join(' × ');
    const openings = f.openings.map((o) => fixed(o.calibreMm, 1)).join(', ');
    return [
      el(
        'p',
        {},
        text('{count, plural, one {# triangle} other {# triangles}}, {size} mm', { count: f.triangles, size }),
      ),
      el(
        'p',
        {},
        f.openings.length === 0
          ? text('No openings yet.')
          : text('{count, plural, one {# opening} other {# openings}}: {widths} mm wide', {
              count: f.openings.length,
              widths: openings,
            }),
      ),
      ...f.notes
        .filter((n) => n.kind !== 'fact')
        .map((n) =>
          el('p', { class: n.kind === 'problem' ? 'bad' : 'mended' }, `${forThePage(n.text)} ${forThePage(n.advice)}`),
        ),
    ];
  }
}
