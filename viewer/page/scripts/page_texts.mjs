// SPDX-License-Identifier: GPL-3.0-or-later
// Reads the page's sources with TypeScript's parser: the messages of text(), and texts that a person would read
// although they went past text().
import { readdirSync, readFileSync } from 'node:fs';
import { join, relative } from 'node:path';
import { fileURLToPath } from 'node:url';
import ts from 'typescript';

const root = fileURLToPath(new URL('../src', import.meta.url));

export function sourceFiles(folder = root) {
  return readdirSync(folder, { withFileTypes: true, recursive: true })
    .filter((e) => e.isFile() && e.name.endsWith('.ts') && e.name !== 'lcm.ts')
    .map((e) => join(e.parentPath, e.name))
    .sort();
}

const parse = (file, code = readFileSync(file, 'utf8')) =>
  ts.createSourceFile(file, code, ts.ScriptTarget.Latest, true);

function visit(node, seen) {
  seen(node);
  ts.forEachChild(node, (n) => visit(n, seen));
}

function place(source, node) {
  const { line } = source.getLineAndCharacterOfPosition(node.getStart());
  return `${relative(root, source.fileName)}:${line + 1}`;
}

/** Names under which a file has the function text() of languages/text.ts. */
function namesOfText(source) {
  const names = new Set();
  for (const s of source.statements) {
    if (!ts.isImportDeclaration(s) || !/(^|\/)text$/.test(s.moduleSpecifier.text)) continue;
    const named = s.importClause?.namedBindings;
    if (named && ts.isNamedImports(named))
      for (const e of named.elements) if ((e.propertyName ?? e.name).text === 'text') names.add(e.name.text);
  }
  return names;
}

/** The messages of one file: {key, where}. Throws for one that is no literal. */
export function textsOf(file, code) {
  const source = parse(file, code);
  const names = namesOfText(source);
  const found = [];
  if (names.size > 0)
    visit(source, (n) => {
      if (!ts.isCallExpression(n) || !ts.isIdentifier(n.expression) || !names.has(n.expression.text)) return;
      const message = n.arguments[0];
      // said() looks up what the engine has said, which is in no source.
      if (message && ts.isIdentifier(message) && file.endsWith('languages/said.ts')) return;
      if (!message || !ts.isStringLiteralLike(message))
        throw new Error(`${place(source, n)}: the message of text() is no literal`);
      found.push({ key: message.text, where: place(source, n) });
    });
  return found;
}

/** Of all sources, each message once. */
export function pageTexts() {
  const found = new Map();
  for (const file of sourceFiles()) for (const t of textsOf(file)) if (!found.has(t.key)) found.set(t.key, t.where);
  return [...found].map(([key, where]) => ({ key, where }));
}

/** Properties and attributes that a person reads. */
const read = new Set(['textContent', 'innerText', 'title', 'aria-label', 'placeholder', 'label', 'alt', 'ariaLabel']);
const calls = new Set(['append', 'prepend', 'replaceChildren', 'setText', 'alert', 'confirm', 'prompt', 'fillText']);
/** Words in two letters or more; units and the name of the program are the same in all languages. */
const same = /^(Insula|mm|N|µs|ms|s|MB|Pa)$/;
const isWords = (literal) => (literal.match(/\p{L}{2,}/gu) ?? []).some((word) => !same.test(word));

/** Literal parts of an expression that a person would read; those inside of calls are the calls' own. */
function literals(node) {
  if (ts.isStringLiteralLike(node)) return isWords(node.text) ? [node] : [];
  if (ts.isTemplateExpression(node)) {
    const parts = [node.head, ...node.templateSpans.map((s) => s.literal)];
    if (parts.some((p) => isWords(p.text))) return [node];
    return node.templateSpans.flatMap((s) => literals(s.expression));
  }
  if (ts.isConditionalExpression(node)) return [...literals(node.whenTrue), ...literals(node.whenFalse)];
  if (ts.isParenthesizedExpression(node)) return literals(node.expression);
  if (ts.isBinaryExpression(node) && /^(\+|\|\||\?\?)$/.test(node.operatorToken.getText()))
    return [...literals(node.left), ...literals(node.right)];
  if (ts.isArrayLiteralExpression(node)) return node.elements.flatMap(literals);
  return [];
}

const nameOf = (n) => (ts.isIdentifier(n) || ts.isStringLiteralLike(n) ? n.text : '');

/** What a node gives a person to read. */
function readParts(node) {
  if (ts.isBinaryExpression(node) && node.operatorToken.kind === ts.SyntaxKind.EqualsToken)
    return ts.isPropertyAccessExpression(node.left) && read.has(node.left.name.text) ? literals(node.right) : [];
  if (ts.isPropertyAssignment(node)) return read.has(nameOf(node.name)) ? literals(node.initializer) : [];
  if (!ts.isCallExpression(node)) return [];
  const callee = node.expression;
  const name = ts.isPropertyAccessExpression(callee) ? callee.name.text : nameOf(callee);
  if (name === 'el') return node.arguments.slice(2).flatMap(literals);
  if (name === 'setAttribute') return read.has(nameOf(node.arguments[0])) ? literals(node.arguments[1]) : [];
  return calls.has(name) ? node.arguments.flatMap(literals) : [];
}

/** Texts of one file that went past text(): {text, where}. */
export function untranslated(file, code) {
  const source = parse(file, code);
  const found = [];
  visit(source, (n) => {
    for (const part of readParts(n)) found.push({ text: part.getText(), where: place(source, part) });
  });
  return found;
}

export const allUntranslated = () => sourceFiles().flatMap((f) => untranslated(f));
