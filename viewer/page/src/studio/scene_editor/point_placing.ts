// SPDX-License-Identifier: GPL-3.0-or-later
// A point of an element that is placed with the mouse in the running picture.
import { text } from '../../languages/text';
import type { Parameter } from './declarations';
import { type Change, changedAttribute } from './edits';
import { attribute, elementOfPath, type OutlineElement, pathOf } from './outline';
import { pointOf, pointText } from './values';

const valueOf = (e: OutlineElement, parameter: Parameter): string =>
  attribute(e, parameter.name)?.value ?? parameter.fallback;

export class PointPlacing {
  private of: { path: number[]; element: string; parameter: Parameter } | null = null;

  /** show: the point in the picture; null: none. */
  constructor(
    private readonly show: (at: readonly number[] | null) => void,
    private readonly tell: (words: string) => void,
  ) {}

  begin(e: OutlineElement, parameter: Parameter): void {
    const value = valueOf(e, parameter);
    const at = value === '' ? [0, 0, 0] : pointOf(parameter, value);
    this.tell(at ? '' : text('This value is no point: write numbers and a unit first.'));
    this.of = at && { path: pathOf(e), element: e.name, parameter };
    this.show(at);
  }

  end(): void {
    if (this.of) this.show(null);
    this.of = null;
  }

  /** What a point that was placed changes, wherever the tag of its element is now; null: nothing. */
  placed(at: readonly number[], outline: OutlineElement | null, content: string): Change | null {
    const e = this.of && outline && elementOfPath(outline, this.of.path);
    if (!e || !this.of || e.name !== this.of.element) return null;
    const { parameter } = this.of;
    return changedAttribute(content, e, parameter.name, pointText(parameter, at, valueOf(e, parameter)));
  }
}
