// SPDX-License-Identifier: GPL-3.0-or-later
// The elements of a scene's text with their places in it. The text is the only truth: comments, order and white space
// are never written anew.
import { xmlLanguage } from '@codemirror/lang-xml';

type Tree = ReturnType<typeof xmlLanguage.parser.parse>;
type SyntaxNode = Tree['topNode'];

export interface OutlineAttribute {
  name: string;
  /** As written, with entities resolved. */
  value: string;
  from: number;
  to: number;
  /** Inside of the quotes; -1: it has no value. */
  valueFrom: number;
  valueTo: number;
}

export interface OutlineElement {
  name: string;
  from: number;
  to: number;
  /** End of the name in the start tag. */
  nameTo: number;
  /** End of the start tag. */
  tagTo: number;
  /** Begin of the end tag; -1: there is none. */
  closeFrom: number;
  attributes: OutlineAttribute[];
  children: OutlineElement[];
  parent: OutlineElement | null;
}

const entities: Record<string, string> = { lt: '<', gt: '>', amp: '&', quot: '"', apos: "'" };

const resolved = (written: string): string =>
  written.replace(/&(?:#x([0-9a-f]+)|#(\d+)|(\w+));/gi, (all, hex?: string, decimal?: string, name?: string) => {
    if (name !== undefined) return entities[name] ?? all;
    const code = hex !== undefined ? parseInt(hex, 16) : Number(decimal);
    return code <= 0x10ffff ? String.fromCodePoint(code) : all;
  });

function attributeOf(node: SyntaxNode, doc: string): OutlineAttribute {
  const name = node.getChild('AttributeName');
  const value = node.getChild('AttributeValue');
  const [valueFrom, valueTo] = value ? [value.from + 1, Math.max(value.from + 1, value.to - 1)] : [-1, -1];
  return {
    name: name ? doc.slice(name.from, name.to) : '',
    value: value ? resolved(doc.slice(valueFrom, valueTo)) : '',
    from: node.from,
    to: node.to,
    valueFrom,
    valueTo,
  };
}

function elementOf(node: SyntaxNode, doc: string, parent: OutlineElement | null): OutlineElement | null {
  const tag = node.getChild('OpenTag') ?? node.getChild('SelfClosingTag');
  const name = tag?.getChild('TagName');
  if (!tag || !name) return null;
  const element: OutlineElement = {
    name: doc.slice(name.from, name.to),
    from: node.from,
    to: node.to,
    nameTo: name.to,
    tagTo: tag.to,
    closeFrom: node.getChild('CloseTag')?.from ?? -1,
    attributes: tag.getChildren('Attribute').map((a) => attributeOf(a, doc)),
    children: [],
    parent,
  };
  for (const child of node.getChildren('Element')) {
    const inner = elementOf(child, doc, element);
    if (inner) element.children.push(inner);
  }
  return element;
}

/** The root of a text; null: there is none. */
export function outlineOf(doc: string, tree: Tree = xmlLanguage.parser.parse(doc)): OutlineElement | null {
  const root = tree.topNode.getChild('Element');
  return root && elementOf(root, doc, null);
}

/** The innermost element at a place. */
export function elementAt(root: OutlineElement, at: number): OutlineElement {
  const inner = root.children.find((c) => c.from <= at && at < c.to);
  return inner ? elementAt(inner, at) : root;
}

export const attribute = (e: OutlineElement, name: string): OutlineAttribute | undefined =>
  e.attributes.find((a) => a.name === name);

/** All of them, in the order of the text. */
export const withDescendants = (e: OutlineElement): OutlineElement[] => [e, ...e.children.flatMap(withDescendants)];

/** Where an element is in the tree: the numbers of the children on the way to it. */
export function pathOf(e: OutlineElement): number[] {
  return e.parent ? [...pathOf(e.parent), e.parent.children.indexOf(e)] : [];
}

export function elementOfPath(root: OutlineElement, path: readonly number[]): OutlineElement | null {
  let at: OutlineElement | undefined = root;
  for (const k of path) at = at?.children[k];
  return at ?? null;
}
