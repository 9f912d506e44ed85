// SPDX-License-Identifier: GPL-3.0-or-later
// What the case builder says for its command line, as what to do on this page. Some of its messages are translated.
import { said } from '../languages/said';

/** Options in messages of tools/case_builder, and what stands for them here. In this order. */
const here: readonly [RegExp, string][] = [
  [/; --any-size takes it all the same/g, ''],
  [/insula case wall FOLDER --vertices (\d+)( --on)?/g, 'choose $1 vertices and build again'],
  [/insula case intake FOLDER INPUT --rebuild "([\d.]+ mm)" --on/g, 'make the surface anew from a grid of $1'],
  [/insula case wall FOLDER --neck "[^"]*"( --on)?/g, 'set the neck by two clicks and build again'],
  [/insula case wall FOLDER --neck \.\.\. --on/g, 'choose one of them'],
  [/: --neck "[^"]*" \(a point in the neck and the direction to the dome\)/g, ' by clicks'],
  [/ ?\(--neck, --neck-points\)/g, ' by two clicks'],
  [/ with --neck "[^"]*" or --neck-points/g, ' by two clicks'],
  [/ with --rebuild "([\d.]+ mm)"/g, ' of $1'],
  [/ ?\(--vertices (\d+)\)/g, ' ($1)'],
  [/: give --unit (\w+)/g, ': choose the unit $1'],
  [/with --unit if/g, 'if'],
  [/^--neck-points: /g, ''],
  [/name a point in it with --seed/g, 'put the seed into it'],
  [
    /name a point in it \(--seed\) and take what is near it \(--around "[^"]*"\)/g,
    'put the seed into it and take a part',
  ],
];

/**
 * A message of the case builder for somebody who has no command line, in the reader's language if it is one of
 * scripts/builder_texts.json.
 */
export const forThePage = (words: string): string =>
  said(here.reduce((all, [option, action]) => all.replace(option, action), words));

/** Why something was refused. */
export const reason = (e: unknown): string => (e instanceof Error ? forThePage(e.message) : String(e));
