// SPDX-License-Identifier: GPL-3.0-or-later
// Changes of a scene's text that touch one attribute or one element. All other bytes stay as they are.
import type { ElementKind } from './declarations';
import { attribute, type OutlineElement } from './outline';

export interface Change {
  from: number;
  to: number;
  insert: string;
}

export const applied = (doc: string, { from, to, insert }: Change): string =>
  doc.slice(0, from) + insert + doc.slice(to);

const escaped = (value: string, quote: string): string =>
  value
    .replaceAll('&', '&amp;')
    .replaceAll('<', '&lt;')
    .replaceAll(quote, quote === '"' ? '&quot;' : '&apos;');

/** An attribute with another value, or without it (null). Null: nothing is to be changed. */
export function changedAttribute(doc: string, e: OutlineElement, name: string, value: string | null): Change | null {
  const found = attribute(e, name);
  if (!found) {
    if (value === null) return null;
    const at = e.attributes.at(-1)?.to ?? e.nameTo;
    return { from: at, to: at, insert: ` ${name}="${escaped(value, '"')}"` };
  }
  if (value === found.value && found.valueFrom >= 0) return null;
  if (value === null) {
    const from = doc.slice(0, found.from).trimEnd().length;
    return { from, to: found.to, insert: '' };
  }
  if (found.valueFrom < 0) return { from: found.from, to: found.to, insert: `${name}="${escaped(value, '"')}"` };
  return { from: found.valueFrom, to: found.valueTo, insert: escaped(value, doc[found.valueFrom - 1] ?? '"') };
}

/** The white space before a place on its line; null: something else stands there. */
function indentAt(doc: string, at: number): string | null {
  const line = doc.slice(doc.lastIndexOf('\n', at - 1) + 1, at);
  return line.trim() === '' ? line : null;
}

/** A child at the end of an element, on a line of its own, with the attributes that it begins with. */
export function withChild(
  doc: string,
  e: OutlineElement,
  child: ElementKind,
  begins: readonly (readonly [string, string])[],
): Change {
  const piece = `<${child.name}${begins.map(([name, value]) => ` ${name}="${escaped(value, '"')}"`).join('')}/>`;
  const own = indentAt(doc, e.from) ?? '';
  const last = e.children.at(-1);
  const inner = (last && indentAt(doc, last.from)) ?? `${own}  `;
  if (e.closeFrom < 0) {
    // The end of "<a/>" becomes that of "<a>", and the blank before it goes.
    const from = doc.slice(0, e.tagTo).replace(/\s*\/?>$/, '').length;
    return { from, to: e.tagTo, insert: `>\n${inner}${piece}\n${own}</${e.name}>` };
  }
  const onOwnLine = indentAt(doc, e.closeFrom) !== null;
  const at = onOwnLine ? doc.lastIndexOf('\n', e.closeFrom - 1) : e.closeFrom;
  return { from: at, to: at, insert: onOwnLine ? `\n${inner}${piece}` : `\n${inner}${piece}\n${own}` };
}

/** Without an element. A line that it had for itself goes with it; comments stay. */
export function withoutElement(doc: string, e: OutlineElement): Change {
  const indent = indentAt(doc, e.from);
  const end = doc.indexOf('\n', e.to);
  const alone = indent !== null && doc.slice(e.to, end < 0 ? doc.length : end).trim() === '';
  const from = alone ? Math.max(0, e.from - indent.length - 1) : e.from;
  return { from, to: alone && end >= 0 ? end : e.to, insert: '' };
}
