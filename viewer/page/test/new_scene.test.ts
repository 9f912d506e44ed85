// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes from nothing: what new components begin with.
import { expect, test } from 'vitest';
import { withComponents } from '../src/studio/scene_editor/components';
import { declarationsOf } from '../src/studio/scene_editor/declarations';
import { componentsOf } from '../src/studio/scene_editor/new_scene';

const metre = [
  { symbol: 'm', to_si: 1 },
  { symbol: 'mm', to_si: 1e-3 },
];
const all = declarationsOf([
  { name: 'scene', kind: 'scene', children: ['include', 'ball', 'spring', 'wall'] },
  { name: 'include', kind: '', parameters: [{ name: 'file', required: true }] },
  {
    name: 'ball',
    kind: 'body',
    parameters: [
      { name: 'radius', required: true, numbers: 1, min: '0.5 mm', max: '1 m', units: metre },
      { name: 'at', required: true, numbers: 3, units: metre },
      { name: 'colour', required: true, choices: ['red', 'blue'] },
      { name: 'unit', required: true, choices: ['m', 'cm', 'mm'] },
      { name: 'mass', default: '1 kg' },
    ],
  },
  { name: 'spring', kind: 'constraint', parameters: [{ name: 'on', required: true, reference: 'body' }] },
  { name: 'wall', kind: 'settings', parameters: [{ name: 'mesh', type: 'file', required: true }] },
]);
const kinds = (...names: string[]) => names.map((name) => all.get(name)!);

test('a scene may begin with what stands right inside of it, by kind', () => {
  expect([...componentsOf(all)].map(([kind, of]) => [kind, of.map((e) => e.name)])).toEqual([
    ['body', ['ball']],
    ['constraint', ['spring']],
    ['settings', ['wall']],
  ]);
});

test('components begin with what they must have, and name what is there', () => {
  const begun = withComponents('<scene title="a">\n</scene>\n', kinds('ball', 'ball', 'spring', 'wall'), all);
  expect(begun).toBe(`<scene title="a">
  <ball id="ball" radius="0.5 mm" at="0 0 0 mm" colour="red" unit="mm"/>
  <ball id="ball_2" radius="0.5 mm" at="0 0 0 mm" colour="red" unit="mm"/>
  <spring on="ball"/>
  <wall mesh=""/>
</scene>
`);
});

test('what may be named is missing: the value is left to the author', () => {
  expect(withComponents('<scene/>', kinds('spring'), all)).toBe('<scene>\n  <spring on=""/>\n</scene>');
});
