// SPDX-License-Identifier: GPL-3.0-or-later
// Brush and eraser for the slices.
import { el } from '../../hud/dom';
import { fixed } from '../../languages/numbers';
import { text } from '../../languages/text';
import type { Choices } from '../api';
import type { Asks } from '../editor';
import { field, select } from '../fields';
import type { ScanState } from './scan_state';

const radii = [0.5, 1, 1.5, 2, 3, 5]; // mm
const usual = '1';

export class BrushPanel {
  readonly root: HTMLElement;
  private readonly tool = select([
    ['', text('moves the crosshair')],
    ['paint', text('paints the vessel')],
    ['erase', text('erases the vessel')],
  ]);
  private readonly radius = select(radii.map((mm) => [String(mm), text('{mm} mm', { mm: fixed(mm, 1) })] as const));
  private readonly none = el('button', { type: 'button' }, text('Remove all strokes'));

  constructor(asks: Asks, state: ScanState) {
    this.radius.value = usual;
    const choose = () => {
      const erase = this.tool.value === 'erase';
      state.brush = this.tool.value === '' ? null : { erase, radiusMm: Number(this.radius.value) };
    };
    this.tool.onchange = this.radius.onchange = choose;
    this.none.onclick = () => asks.choose({ paint: [] });
    this.root = el(
      'section',
      { class: 'brush-step' },
      el('h3', {}, text('By hand')),
      field(text('A drag in a slice'), this.tool),
      field(text('Radius of the brush'), this.radius),
      el('p', { class: 'hint' }, text('The brush is a ball. The space key dabs at the crosshair.')),
      el('div', { class: 'buttons' }, this.none),
    );
  }

  show({ paint }: Choices): void {
    this.none.disabled = paint.length === 0;
  }
}
