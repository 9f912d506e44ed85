// SPDX-License-Identifier: GPL-3.0-or-later
// Messages of the case builder with names in them, such as that of a lobe. Each is a key of the catalogues:
// "There is no place for strands to the {part}." A name is said in the reader's language, and so are numbers.
import { localized, said, saidWith } from '../languages/said';
import { text } from '../languages/text';
import { patternOf } from '../languages/message_pattern';
import { exerciseText } from './exercise_text';
import { partText } from './part_words';

/** {0}, {1}: numbers. {after}, {before}: numbers that may be negative. Others: names, or lists of them. */
export const namedMessages = [
  'Retractor {0} ({part} lobe) stands {1} mm deep in the {other}.',
  'Retractor {0} ({part} lobe)',
  '{retractor} holds no lobe.',
  '{retractor} holds the {part} lobe with {0} N.',
  '{retractor} stands {0} mm deep in tissue.',
  '{retractor} and {other} both hold the {part} lobe.',
  '{tool} starts within tissue or bone.',
  'The lobes are {part} and {other}',
  'There is no place for strands to the {part}.',
  'The flattened neck is {0} mm wide; the blades of {clip} reach over {1} mm of it.',
  '{vessel} was cut off {0} mm from the neck ({1} mm of it left out).',
  '{vessel} could not be cut off',
  'the vessel has no region "{name}"',
  'did you mean "{name}"?',
  'it has {names}',
  'Exercise {0}, "{name}"',
  '{file}, scripted hands',
  '{file}, as it begins',
  'room to the {part}',
  '{after} mm (before parting {before} mm)',
  'The {part} was parted by up to {0} mm, so that it keeps {after} mm from the wall (before: {before} mm).',
  'The {part} still overlaps the wall or touches it ({after} mm).',
  'The {part} lobe had to be parted so far that an element has {0} % of its volume left.',
  'The {part} lobe does not come to rest: {0} mm/s.',
] as const;

const numeral = /^-?\d+(?:\.\d+)?$/;

const patterns = namedMessages.map((key) => {
  const { pattern, names } = patternOf(key);
  return { key, pattern: new RegExp(`^${pattern}$`), names };
});

/** What the case builder calls something, for a reader. */
export function nameWords(name: string): string {
  const [, kind, n] = /^(branch|trunk|arm)_(\d+)$/.exec(name) ?? [];
  if (kind === 'branch') return text('branch {n}', { n: n! });
  if (kind === 'trunk') return text('trunk {n}', { n: n! });
  if (kind === 'arm') return text('Retractor {n}', { n: n! });
  switch (name) {
    case 'parent':
      return text('parent artery');
    case 'branches':
      return text('the branches');
    case 'vessel':
      return text('the vessel');
    default: {
      const words = partText(exerciseText(name));
      return words === name ? said(name) : words;
    }
  }
}

const wordsOf = (value: string): string =>
  numeral.test(value) ? localized(value) : value.split(', ').map(nameWords).join(', ');

/** A message of the catalogues in the reader's language, whatever names are in it, or back as it is. */
export function saidWithNames(english: string): string {
  const plain = said(english);
  if (plain !== english) return plain;
  for (const { key, pattern, names } of patterns) {
    const found = pattern.exec(english);
    const words = found && saidWith(key, Object.fromEntries(names.map((name, k) => [name, wordsOf(found[k + 1]!)])));
    if (words) return words;
  }
  return english;
}
