// SPDX-License-Identifier: GPL-3.0-or-later
// The texts that catalogues translate: those of the page's sources, those of the shipped exercises, and those messages
// of the case builder that builder_texts.json lists.
//   node scripts/texts.mjs                   how many there are, and how many each language lacks
//   node scripts/texts.mjs --missing LANG    those without a translation, as JSON to be filled in
//   node scripts/texts.mjs --stale LANG      translations of texts that are no more
//   node scripts/texts.mjs --fill LANG FILE  adds the translations of a JSON file; takes out stale ones, sorts
//   node scripts/texts.mjs --exercises PROGRAM [--check]
//                                            asks insula for the texts of exercises and keeps them, or compares them
import { execFile } from 'node:child_process';
import { existsSync, readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { availableParallelism } from 'node:os';
import { join, relative } from 'node:path';
import { argv, exit } from 'node:process';
import { fileURLToPath } from 'node:url';
import { promisify } from 'node:util';
import { pageTexts } from './page_texts.mjs';

const run = promisify(execFile);
const here = fileURLToPath(new URL('.', import.meta.url));
const folder = join(here, '../src/languages/catalogues');
const kept = join(here, 'exercise_texts.json');
const project = join(here, '../../..');
const json = (value) => `${JSON.stringify(value, null, 2)}\n`;

export const languages = readdirSync(folder).map((f) => f.replace('.json', ''));

export function catalogue(language) {
  const file = join(folder, `${language}.json`);
  if (!existsSync(file)) throw new Error(`no catalogue of "${language}"; there are ${languages.join(', ')}`);
  return JSON.parse(readFileSync(file, 'utf8'));
}

/** Numbers as in src/languages/said.ts. A quantity alone needs no translation. */
function exerciseKey(english) {
  let n = 0;
  const key = english.replace(/(?<![\p{L}\d._])\d+(?:\.\d+)?(?![\p{L}\d_])/gu, () => `{${n++}}`);
  return /^\{0\}( ?(mm|N|deg|%|s|ml|mmHg))?$/.test(key) ? '' : key;
}

/** Text and kind of each, in order. */
export const exerciseTexts = () => JSON.parse(readFileSync(kept, 'utf8'));

/** Messages of the case builder, as its page shows them in English. */
export const builderTexts = () => JSON.parse(readFileSync(join(here, 'builder_texts.json'), 'utf8'));

/** Messages that the engine makes of numbers and names. */
export const engineMessages = () =>
  JSON.parse(readFileSync(join(here, '../src/languages/engine_messages.json'), 'utf8')).map((key) => ({
    key,
    kind: 'message of the engine',
  }));

/** Its sources, with texts that go on over several lines in one piece. */
export function builderSources() {
  const of = join(project, 'tools/case_builder');
  const files = readdirSync(of).filter((f) => f.endsWith('.cpp') && !f.endsWith('_test.cpp'));
  return files.map((f) => readFileSync(join(of, f), 'utf8').replace(/"\s*\n\s*"/g, '')).join('\n');
}

/** All sources of plugins, likewise. */
export function pluginSources() {
  const of = join(project, 'plugins');
  const files = readdirSync(of, { recursive: true }).filter((f) => f.endsWith('.cpp') && !f.endsWith('_test.cpp'));
  return files.map((f) => readFileSync(join(of, f), 'utf8').replace(/"\s*\n\s*"/g, '')).join('\n');
}

/** The literals of a call or a list, from its first bracket on. */
function literalsFrom(text, at) {
  const found = [];
  let depth = 0;
  for (let k = at; k < text.length; k++) {
    if ('({'.includes(text[k])) depth++;
    if (')}'.includes(text[k]) && --depth <= 0) break;
    if (text[k] === ';' && depth <= 0) break;
    if (text[k] !== '"') continue;
    const end = k + /^"(?:[^"\\]|\\.)*"/.exec(text.slice(k))[0].length;
    found.push(
      text
        .slice(k + 1, end - 1)
        .replace(/\\"/g, '"')
        .replace(/\\n/g, ' '),
    );
    k = end - 1;
  }
  return found;
}

/** Sentences that the case builder can say to an author: of refusals, notes and problems with what to do. */
export function builderMessages() {
  const text = builderSources().replace(/'(?:"|\\.)'/g, "' '");
  const heads = /\b(?:InputError|problem|refuse|refuse_patch)\(|\{Note::Kind::\w+|\b(?:check|tell)\(\s*[a-z!]/g;
  const all = [...text.matchAll(heads)].flatMap((m) => literalsFrom(text, m.index + m[0].search(/[({]/)));
  return [...new Set(all)].filter((words) => / /.test(words.trim()) && words.length >= 16).sort();
}

/** Those that stay in English. Their file has them by the reason for it. */
export const englishMessages = () =>
  Object.values(JSON.parse(readFileSync(join(here, 'builder_english.json'), 'utf8')))
    .flat()
    .sort();

let known;

/** All keys: {key, where}. Throws for a text() whose message is no literal. The sources are read once. */
export function allTexts() {
  return (known ??= readTexts());
}

function readTexts() {
  const found = new Map(pageTexts().map((t) => [t.key, t.where]));
  for (const { key, kind } of [...exerciseTexts(), ...builderTexts(), ...engineMessages()])
    if (!found.has(key)) found.set(key, kind);
  return [...found].map(([key, where]) => ({ key, where }));
}

export function missing(language) {
  const has = catalogue(language);
  return allTexts()
    .map((t) => t.key)
    .filter((key) => !Object.hasOwn(has, key));
}

export function stale(language) {
  const keys = new Set(allTexts().map((t) => t.key));
  return Object.keys(catalogue(language)).filter((key) => !keys.has(key));
}

/** Complete scenes in the folders that the start page offers, and the curricula. */
function shippedFiles() {
  return ['scenes/training', 'scenes/skills', 'scenes/cases', 'curricula'].flatMap((group) =>
    readdirSync(join(project, group), { recursive: true })
      .filter((f) => f.endsWith('.xml') && !f.startsWith('bench_'))
      .sort()
      .map((f) => join(project, group, f))
      .filter((f) => !/<part[\s>]/.test(readFileSync(f, 'utf8'))),
  );
}

/** The texts of all shipped files, in their order. As many processes load them as there are processors. */
async function askedTexts(program) {
  const files = shippedFiles();
  const share = Math.ceil(files.length / availableParallelism());
  const asked = [];
  for (let k = 0; k < files.length; k += share)
    asked.push(run(program, ['texts', ...files.slice(k, k + share)], { maxBuffer: 1 << 24 }));
  const kinds = new Map();
  for (const { text, kind } of (await Promise.all(asked)).flatMap(({ stdout }) => JSON.parse(stdout))) {
    const key = exerciseKey(text);
    if (key !== '' && !kinds.has(key)) kinds.set(key, kind);
  }
  return [...kinds].map(([key, kind]) => ({ key, kind }));
}

/** The program that was built beside the page; '' if there is none. */
export function builtProgram() {
  const program = join(here, '../../../build/release/bin/insula');
  return existsSync(program) ? program : '';
}

/** Whether the program says other texts than those that are kept. */
export const exercisesChanged = async (program) => json(await askedTexts(program)) !== readFileSync(kept, 'utf8');

export const htmlOf = (page) => readFileSync(join(here, `../${page}.html`), 'utf8');

function fill(language, file) {
  const all = { ...catalogue(language), ...JSON.parse(readFileSync(file, 'utf8')) };
  const keys = allTexts().map((t) => t.key);
  const entries = keys.filter((key) => typeof all[key] === 'string' && all[key] !== '').map((key) => [key, all[key]]);
  entries.sort(([a], [b]) => (a < b ? -1 : 1));
  writeFileSync(join(folder, `${language}.json`), json(Object.fromEntries(entries)));
}

async function exercises(program, check) {
  if (!check) return writeFileSync(kept, json(await askedTexts(program)));
  if (!(await exercisesChanged(program))) return undefined;
  console.error(
    `error: ${relative('.', kept)} is not what the program says: node scripts/texts.mjs --exercises PROGRAM`,
  );
  exit(1);
}

async function main([what, first, second]) {
  if (what === '--missing') console.log(json(Object.fromEntries(missing(first).map((key) => [key, '']))).trim());
  else if (what === '--stale') console.log(json(stale(first)).trim());
  else if (what === '--fill') fill(first, second);
  else if (what === '--exercises') await exercises(first, second === '--check');
  else {
    console.log(`${allTexts().length} texts`);
    for (const l of languages) console.log(`${l}: ${missing(l).length} missing, ${stale(l).length} stale`);
  }
}

if (argv[1] === fileURLToPath(import.meta.url)) {
  try {
    await main(argv.slice(2));
  } catch (e) {
    console.error(`error: ${e.message}`);
    exit(2);
  }
}
