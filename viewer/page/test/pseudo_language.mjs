// SPDX-License-Identifier: GPL-3.0-or-later
// A language made by machine: each text in brackets, with accents, and one third longer. Text outside of brackets went
// past the catalogues, and what has no room for it has none for a language with long words.
import { readFileSync } from 'node:fs';
import { parse, TYPE } from '@formatjs/icu-messageformat-parser';

const accents = { a: 'á', c: 'ç', d: 'ð', e: 'é', i: 'í', n: 'ñ', o: 'ó', s: 'š', t: 'ţ', u: 'ú', y: 'ý' };
const accented = (words) => words.replace(/[acdeinostuy]/g, (c) => accents[c]);

/** The literal parts of a parsed message, those within plurals and choices too. */
function literals(elements) {
  return elements.flatMap((e) => {
    if (e.type === TYPE.literal) return [e.location];
    if (e.type === TYPE.plural || e.type === TYPE.select)
      return Object.values(e.options).flatMap((o) => literals(o.value));
    return [];
  });
}

/** "Start" is "[Šţárţ··]". Arguments stay; a single letter or sign, such as the name of a key, gets brackets alone. */
export function pseudo(message) {
  const parts = literals(parse(message, { captureLocation: true, ignoreTag: true }));
  let length = 0;
  let out = '';
  let at = 0;
  for (const { start, end } of parts) {
    const words = message.slice(start.offset, end.offset);
    length += words.length;
    out += message.slice(at, start.offset) + accented(words);
    at = end.offset;
  }
  return `[${out}${message.slice(at)}${'·'.repeat(Math.floor(length / 3))}]`;
}

/** The catalogue of this language, with the keys of a real one. */
export function pseudoCatalogue() {
  const real = new URL('../src/languages/catalogues/de.json', import.meta.url);
  const keys = Object.keys(JSON.parse(readFileSync(real, 'utf8')));
  return Object.fromEntries(keys.map((k) => [k, pseudo(k)]));
}

/** The page's language "de" is this one from now on. */
export async function speakPseudo(context) {
  const body = `export default ${JSON.stringify(pseudoCatalogue())}`;
  await context.route(/assets\/de-[^/]*\.js/, (route) => route.fulfill({ contentType: 'text/javascript', body }));
}
