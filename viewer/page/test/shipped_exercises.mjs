// SPDX-License-Identifier: GPL-3.0-or-later
// The shipped exercises as a gateway lists them, with the texts and pictures that lie in scenes/.
import { existsSync, readdirSync, readFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const root = fileURLToPath(new URL('../../..', import.meta.url));
const entities = { '&amp;': '&', '&lt;': '<', '&gt;': '>', '&quot;': '"', '&apos;': "'" };
const plain = (words) => words.replace(/\s+/g, ' ').replace(/&\w+;/g, (e) => entities[e] ?? e);

export const pictureOf = (scene) => join(root, scene.replace(/\.xml$/, '.jpg'));

function exerciseOf(group, name) {
  const scene = `scenes/${group}/${name}`;
  const tag = /<exercise\s[^>]*>/.exec(readFileSync(join(root, scene), 'utf8'))?.[0];
  if (!tag) return [];
  const value = (what) => plain(new RegExp(`\\s${what}="([^"]*)"`).exec(tag)?.[1] ?? '');
  const [title, text, site] = ['title', 'text', 'site'].map(value);
  const rank = { difficulty: Number(value('difficulty')), picture: existsSync(pictureOf(scene)) };
  const ofCase = group === 'cases' && name.includes('/') ? dirname(name) : '';
  return [{ scene, group, case: ofCase, name: title, title, text, site, ...rank }];
}

export const shippedExercises = () =>
  ['skills', 'training', 'cases'].flatMap((group) =>
    readdirSync(join(root, 'scenes', group), { recursive: true })
      .filter((name) => name.endsWith('.xml'))
      .sort()
      .flatMap((name) => exerciseOf(group, name)),
  );
