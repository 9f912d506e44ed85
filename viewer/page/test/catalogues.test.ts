// SPDX-License-Identifier: GPL-3.0-or-later
// Every text of the page and of the shipped exercises has a translation in every catalogue, and no text goes past them.
import { IntlMessageFormat } from 'intl-messageformat';
import { describe, expect, it } from 'vitest';

import { allUntranslated, textsOf, untranslated } from '../scripts/page_texts.mjs';
import { builtProgram, catalogue, exercisesChanged, htmlOf, languages, missing, stale } from '../scripts/texts.mjs';
import { languages as offered } from '../src/languages/languages';

type Part = ReturnType<IntlMessageFormat['getAst']>[number];

/** Names of a message's arguments, in any depth. */
function argumentsOf(message: string): string[] {
  const names = new Set<string>();
  const visit = (parts: readonly Part[]) => {
    for (const p of parts) {
      if (p.type !== 0 && p.type !== 7) names.add(p.value);
      if ('options' in p && p.options) for (const o of Object.values(p.options)) visit(o.value);
    }
  };
  visit(new IntlMessageFormat(message, 'en', undefined, { ignoreTag: true }).getAst());
  return [...names].sort();
}

it('offers the languages that have catalogues, and English', () => {
  expect(['en', ...languages].sort()).toEqual([...offered].sort());
});

// Reading all sources with the compiler takes seconds.
describe.each(languages)('catalogue of %s', { timeout: 120_000 }, (language) => {
  it('has every text', () => {
    const lacks = missing(language);
    const ready = JSON.stringify(Object.fromEntries(lacks.map((k) => [k, ''])), null, 2);
    expect(lacks.length, `to fill in, then: node scripts/texts.mjs --fill ${language} FILE\n${ready}`).toBe(0);
  });

  it('has no text that is no more', () => {
    expect(stale(language)).toEqual([]);
  });

  it('has translations that are whole, and have the arguments of the English message', () => {
    for (const [english, translation] of Object.entries(catalogue(language))) {
      expect(translation.trim(), english).not.toBe('');
      expect(argumentsOf(translation), english).toEqual(argumentsOf(english));
    }
  });
});

describe('sources', { timeout: 120_000 }, () => {
  it('have no text that went past text()', () => {
    expect(allUntranslated()).toEqual([]);
  });

  it('are searched for assignments, attributes, elements and drawn text', () => {
    const found = (code: string) => untranslated('example.ts', code).length;
    expect(found("e.textContent = 'Two words';")).toBe(1);
    expect(found("el('button', { title: 'press me' }, 'Begin', on ? 'yes it is' : text('no'));")).toBe(3);
    expect(found("e.setAttribute('aria-label', `hand ${n}`);")).toBe(1);
    expect(found("root.append(`${n} mm`, 'µs', x ?? 'nothing');")).toBe(1);
    expect(found("c.fillText('now', 0, 0); alert('really?');")).toBe(2);
    expect(found("el('b', { class: 'two words' }, text('fine')); log('a debug line');")).toBe(0);
  });

  it('give text() literal messages', () => {
    const start = "import { text as t } from './languages/text';\n";
    expect(textsOf('example.ts', `${start}t('A'); text('B');`).map((m) => m.key)).toEqual(['A']);
    expect(() => textsOf('example.ts', `${start}t(name);`)).toThrow(/no literal/);
  });

  it('have HTML whose words are the name of the program, until the script runs', () => {
    for (const page of ['index', 'start', 'replay']) {
      const html = htmlOf(page);
      const words = html.replace(/<title>Insula<\/title>/, '').replace(/<[^>]*>/g, '');
      expect(words.trim(), page).toBe('');
      expect(html, page).not.toMatch(/aria-label|placeholder|title=/);
    }
  });
});

it.skipIf(!builtProgram())('the kept texts of exercises are what the program says', { timeout: 600_000 }, async () => {
  expect(await exercisesChanged(builtProgram())).toBe(false);
});
