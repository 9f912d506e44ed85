// SPDX-License-Identifier: GPL-3.0-or-later
// The text of a scene: CodeMirror with completion from the declarations and marks for problems. Its history serves the
// other panels too, since they change nothing but the text.
import { autocompletion, completionKeymap } from '@codemirror/autocomplete';
import { defaultKeymap, history, historyKeymap, redo, redoDepth, undo, undoDepth } from '@codemirror/commands';
import { xml } from '@codemirror/lang-xml';
import { HighlightStyle, syntaxHighlighting } from '@codemirror/language';
import { type Diagnostic, lintGutter, lintKeymap, setDiagnostics } from '@codemirror/lint';
import { highlightSelectionMatches, search, searchKeymap } from '@codemirror/search';
import { EditorState, type Extension } from '@codemirror/state';
import { drawSelection, EditorView, highlightActiveLine, keymap, lineNumbers } from '@codemirror/view';
import { tags } from '@lezer/highlight';
import { text } from '../../languages/text';
import type { Problem } from './api';
import type { Declarations } from './declarations';
import type { Change } from './edits';
import { meant } from './problems';

const colours = HighlightStyle.define([
  { tag: tags.tagName, color: '#8fd0ff' },
  { tag: tags.attributeName, color: '#b9d7a8' },
  { tag: tags.attributeValue, color: '#f3c995' },
  { tag: tags.comment, color: '#9aa7b1', fontStyle: 'italic' },
  { tag: [tags.angleBracket, tags.processingInstruction], color: '#a9b3bb' },
]);

const look = EditorView.theme(
  {
    '&': { height: '100%', fontSize: '13px', backgroundColor: '#0c0e10' },
    '.cm-scroller': { fontFamily: "'DejaVu Sans Mono', monospace" },
    '.cm-gutters': { backgroundColor: '#14181c', color: '#8b959d', border: 'none' },
    '.cm-activeLine, .cm-activeLineGutter': { backgroundColor: '#1a232b' },
    '.cm-content': { caretColor: '#fff' },
    '.cm-cursor': { borderLeftColor: '#fff' },
    '&.cm-focused .cm-selectionBackground, .cm-selectionBackground': { backgroundColor: '#2c4d68 !important' },
    '.cm-tooltip, .cm-panels': { backgroundColor: '#1c2126', color: '#e9edf0', border: '1px solid #4a545d' },
    '.cm-tooltip-autocomplete ul li[aria-selected]': { backgroundColor: '#1f5f93' },
  },
  { dark: true },
);

function language(declarations: Declarations): Extension {
  return xml({
    elements: [...declarations.values()].map((e) => ({
      name: e.name,
      top: e.name === 'scene' || e.name === 'part',
      children: e.children,
      attributes: e.parameters.map((p) => ({ name: p.name, values: p.choices, completion: { detail: p.type } })),
      completion: { info: e.doc },
    })),
  });
}

export interface Hears {
  /** Another text. */
  changed(): void;
  /** Another place of the cursor. */
  moved(at: number): void;
}

export class TextPanel {
  readonly root: HTMLElement;
  private readonly view: EditorView;
  private readonly extensions: Extension[];

  constructor(declarations: Declarations, hears: Hears) {
    this.extensions = [
      lineNumbers(),
      history(),
      drawSelection(),
      highlightActiveLine(),
      highlightSelectionMatches(),
      EditorView.lineWrapping,
      language(declarations),
      syntaxHighlighting(colours),
      look,
      autocompletion(),
      lintGutter(),
      search({ top: true }),
      keymap.of([...completionKeymap, ...searchKeymap, ...historyKeymap, ...lintKeymap, ...defaultKeymap]),
      EditorView.contentAttributes.of({ 'aria-label': text('Text of the scene'), tabindex: '0' }),
      EditorView.updateListener.of((update) => {
        if (update.docChanged) hears.changed();
        else if (update.selectionSet) hears.moved(update.state.selection.main.head);
      }),
    ];
    this.view = new EditorView({ state: this.fresh('') });
    this.root = this.view.dom;
  }

  private fresh(doc: string): EditorState {
    return EditorState.create({ doc, extensions: this.extensions });
  }

  end(): void {
    this.view.destroy();
  }

  get content(): string {
    return this.view.state.doc.toString();
  }
  get place(): number {
    return this.view.state.selection.main.head;
  }
  get canUndo(): boolean {
    return undoDepth(this.view.state) > 0;
  }
  get canRedo(): boolean {
    return redoDepth(this.view.state) > 0;
  }
  undo = (): boolean => undo(this.view);
  redo = (): boolean => redo(this.view);

  /** Another file, with a history of its own. */
  open(doc: string): void {
    this.view.setState(this.fresh(doc));
  }

  /** One step of the history. */
  change(change: Change): void {
    this.view.dispatch({ changes: change, userEvent: 'input.property' });
  }

  /** Another text of the same file, as one step of the history. */
  replace(doc: string): void {
    this.change({ from: 0, to: this.view.state.doc.length, insert: doc });
  }

  /** Marks a piece of the text and brings it into sight. */
  select(from: number, to: number, focus = false): void {
    const end = this.view.state.doc.length;
    const selection = { anchor: Math.min(from, end), head: Math.min(to, end) };
    this.view.dispatch({ selection, effects: EditorView.scrollIntoView(selection.anchor, { y: 'center' }) });
    if (focus) this.view.focus();
  }

  /** Where a line and a column are; counted from 1. */
  placeOf(line: number, column: number): number {
    const { doc } = this.view.state;
    const found = doc.line(Math.min(Math.max(1, line), doc.lines));
    const before = [...found.text].slice(0, Math.max(0, column - 1)).join('');
    return found.from + before.length;
  }

  /** Those of this file. */
  mark(problems: readonly Problem[]): void {
    const { doc } = this.view.state;
    const marks = problems.map((p): Diagnostic => {
      const from = this.placeOf(p.line, p.column);
      const word = /^[<"']?[\w.$-]+/.exec(doc.sliceString(from, doc.lineAt(from).to))?.[0] ?? '';
      const fix = meant(doc.toString(), from, p);
      return {
        from,
        to: from + word.length,
        severity: p.severity === 'warning' ? 'warning' : 'error',
        message: p.text,
        actions: fix ? [{ name: text('Use “{name}”', { name: p.nearest }), apply: () => this.change(fix) }] : [],
      };
    });
    this.view.dispatch(setDiagnostics(this.view.state, marks));
  }
}
