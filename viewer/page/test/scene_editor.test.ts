// SPDX-License-Identifier: GPL-3.0-or-later
// The scene editor without a page: places in the text, changes that leave all else byte for byte, and values.
/// <reference types="vite/client" />
import { describe, expect, it } from 'vitest';
import { pointOf as framedPoint } from '../src/framed';
import { type Parameter, declarationsOf } from '../src/studio/scene_editor/declarations';
import { applied, changedAttribute, withChild, withoutElement } from '../src/studio/scene_editor/edits';
import {
  attribute,
  elementAt,
  elementOfPath,
  outlineOf,
  pathOf,
  withDescendants,
} from '../src/studio/scene_editor/outline';
import { meant } from '../src/studio/scene_editor/problems';
import { placedFrom, viewFrom } from '../src/studio/scene_editor/seen';
import { addedView, changedView } from '../src/studio/scene_editor/taken_view';
import { converted, faultOf, isPoint, partsOf, pointOf, pointText, rangeText } from '../src/studio/scene_editor/values';

const scene = `<?xml version="1.0" encoding="UTF-8"?>
<!-- A comment with <an element/> and an "attribute". -->
<scene   title = 'Two &amp; more'>
\t<soft_body id="lobe"
             mesh="a.msh">  <!-- after -->
    <fixed  region="outside"  radius = "16 mm" />
    <surface id="s"/>
  </soft_body>

  <contact between='a "b"'/>
</scene>
`;

/** All scenes and parts of the project. */
const scenes = import.meta.glob<string>('../../../scenes/**/*.xml', { query: '?raw', import: 'default', eager: true });

const declarations = declarationsOf([
  { name: 'surface', kind: 'surface', doc: '', children: [], parameters: [{ name: 'id' }] },
  {
    name: 'goal',
    children: [],
    parameters: [{ name: 'id' }, { name: 'hand', required: true, choices: ['left', 'right'] }],
  },
  { name: '' },
]);

const parameter = (more: Partial<Parameter>): Parameter => ({
  name: 'p',
  type: '',
  doc: '',
  required: false,
  fallback: '',
  min: '',
  max: '',
  choices: [],
  units: [],
  numbers: null,
  whole: false,
  reference: '',
  ...more,
});
const young = parameter({
  numbers: 1,
  min: '1 Pa',
  max: '1 GPa',
  units: [
    { symbol: 'Pa', toSi: 1 },
    { symbol: 'kPa', toSi: 1000 },
    { symbol: 'GPa', toSi: 1e9 },
  ],
});
const home = parameter({ numbers: 3, units: [{ symbol: 'mm', toSi: 1e-3 }] });

const find = (doc: string, name: string) => withDescendants(outlineOf(doc)!).find((e) => e.name === name)!;

describe('the outline of a text', () => {
  it('has elements, attributes and their places, and no comments', () => {
    const root = outlineOf(scene)!;
    expect(withDescendants(root).map((e) => e.name)).toEqual(['scene', 'soft_body', 'fixed', 'surface', 'contact']);
    expect(attribute(root, 'title')?.value).toBe('Two & more');
    const radius = attribute(find(scene, 'fixed'), 'radius')!;
    expect(scene.slice(radius.valueFrom, radius.valueTo)).toBe('16 mm');
    expect(attribute(find(scene, 'contact'), 'between')?.value).toBe('a "b"');
  });
  it('finds the innermost element at a place, and an element by its path', () => {
    const root = outlineOf(scene)!;
    const fixed = elementAt(root, scene.indexOf('radius'));
    expect(fixed.name).toBe('fixed');
    expect(pathOf(fixed)).toEqual([0, 0]);
    expect(elementOfPath(root, [0, 1])?.name).toBe('surface');
    expect(elementOfPath(root, [7])).toBeNull();
    expect(elementAt(root, scene.length).name).toBe('scene');
  });
  it('reads what it can of a text that is being typed', () => {
    for (let end = 0; end <= scene.length; end += 3) expect(() => outlineOf(scene.slice(0, end))).not.toThrow();
    expect(outlineOf('')).toBeNull();
    expect(find('<scene><fixed radius=></scene>', 'fixed').attributes.length).toBe(1);
    expect(attribute(outlineOf('<a b="&#x41;&#66;&lt;&unknown;"/>')!, 'b')?.value).toBe('AB<&unknown;');
  });
});

describe('a changed attribute', () => {
  const change = (doc: string, name: string, parameterName: string, value: string | null) =>
    applied(doc, changedAttribute(doc, find(doc, name), parameterName, value)!);
  it('changes the bytes of its value and nothing else', () => {
    expect(change(scene, 'fixed', 'radius', '2 cm')).toBe(scene.replace('16 mm', '2 cm'));
    expect(change(scene, 'scene', 'title', 'it’s "<new>" & \'own\'')).toBe(
      scene.replace('Two &amp; more', 'it’s "&lt;new>" &amp; &apos;own&apos;'),
    );
  });
  it('is added behind the others, and taken away with its blank', () => {
    expect(change(scene, 'contact', 'friction', '0.1')).toBe(scene.replace(`'a "b"'/`, `'a "b"' friction="0.1"/`));
    expect(change(scene, 'surface', 'id', null)).toBe(scene.replace('<surface id="s"/>', '<surface/>'));
    expect(change(scene, 'fixed', 'radius', null)).toBe(scene.replace('  radius = "16 mm"', ''));
  });
  it('is no change if it is as it was', () => {
    expect(changedAttribute(scene, find(scene, 'fixed'), 'radius', '16 mm')).toBeNull();
    expect(changedAttribute(scene, find(scene, 'fixed'), 'normal', null)).toBeNull();
  });
  it('comes back byte for byte in every scene of the project', () => {
    const files = Object.values(scenes);
    expect(files.length).toBeGreaterThan(20);
    let changes = 0;
    for (const doc of files) {
      for (const [k, e] of withDescendants(outlineOf(doc)!).entries())
        for (const a of e.attributes) {
          const other = applied(doc, changedAttribute(doc, e, a.name, `${a.value}<"'&`)!);
          const again = withDescendants(outlineOf(other)!)[k]!;
          expect(attribute(again, a.name)!.value).toBe(`${a.value}<"'&`);
          const back = applied(other, changedAttribute(other, again, a.name, a.value)!);
          // Only an entity may be written in another way.
          expect(back.replaceAll('&apos;', "'")).toBe(doc.replaceAll('&apos;', "'"));
          changes++;
        }
    }
    expect(changes).toBeGreaterThan(1000);
  });
});

describe('elements', () => {
  const [surface, goal] = [declarations.get('surface')!, declarations.get('goal')!];
  it('are added on a line of their own, indented as their neighbours', () => {
    const doc = '<scene>\n    <a/>\n  <!-- end -->\n</scene>\n';
    expect(applied(doc, withChild(doc, outlineOf(doc)!, surface, []))).toBe(
      '<scene>\n    <a/>\n  <!-- end -->\n    <surface/>\n</scene>\n',
    );
    const leaf = '<scene>\n  <a b="1" />\n</scene>';
    expect(applied(leaf, withChild(leaf, find(leaf, 'a'), goal, [['hand', 'left']]))).toBe(
      '<scene>\n  <a b="1">\n    <goal hand="left"/>\n  </a>\n</scene>',
    );
    const line = '<scene></scene>';
    expect(applied(line, withChild(line, outlineOf(line)!, surface, []))).toBe('<scene>\n  <surface/>\n</scene>');
  });
  it('are removed with their line, and comments stay', () => {
    expect(applied(scene, withoutElement(scene, find(scene, 'surface')))).toBe(
      scene.replace('    <surface id="s"/>\n', ''),
    );
    const shared = '<a><b/> <c/></a>';
    expect(applied(shared, withoutElement(shared, find(shared, 'b')))).toBe('<a> <c/></a>');
  });
});

describe('values', () => {
  it('are numbers and a unit', () => {
    expect(partsOf(' 54 4 -2  mm')).toEqual({ numbers: '54 4 -2', unit: 'mm' });
    expect(partsOf('0.3 N m/rad')).toEqual({ numbers: '0.3', unit: 'N m/rad' });
    expect(partsOf('$young')).toBeNull();
  });
  it('keep what they say in another unit', () => {
    expect(converted(young, '2.1 kPa', 'Pa')).toBe('2100 Pa');
    expect(converted(young, '$x', 'Pa')).toBe('$x');
    expect(converted(young, '3', 'kPa')).toBe('3 kPa');
  });
  it('are told to be wrong while they are typed', () => {
    expect(faultOf(young, '2.1 kPa')).toBe('');
    expect(faultOf(young, '1 GPa')).toBe('');
    expect(faultOf(young, '1.01 GPa')).toMatch(/Outside .*1 Pa to 1 GPa/);
    expect(faultOf(young, '0.5 Pa')).toMatch(/Outside/);
    expect(faultOf(young, '2.1 mm')).toMatch(/“mm” is no unit of it: Pa, kPa/);
    expect(faultOf(young, '2.1')).toMatch(/A unit is needed/);
    expect(faultOf(young, '2,1 kPa')).toMatch(/point, not a comma/);
    expect(faultOf(young, 'much')).toMatch(/A number is needed/);
    expect(faultOf(home, '1 2 mm')).toMatch(/3 numbers/);
    expect(faultOf(home, '1 2 3 mm')).toBe('');
    expect(faultOf(parameter({ numbers: 1, whole: true, min: '1' }), '1.5')).toMatch(/whole/);
    expect(faultOf(parameter({ numbers: 1, whole: true, min: '1' }), '0')).toMatch(/at least 1/);
    expect(faultOf(parameter({ numbers: 1 }), '1 mm')).toMatch(/No unit/);
    expect(faultOf(parameter({ choices: ['left', 'right'] }), 'up')).toMatch(/left, right/);
    expect(faultOf(young, '$young')).toBe('');
  });
  it('have a range in words', () => {
    expect(rangeText(young)).toBe('1 Pa to 1 GPa');
    expect(rangeText(parameter({ max: '3' }))).toBe('at most 3');
    expect(rangeText(home)).toBe('');
  });
});

describe('a point', () => {
  const metres = parameter({ ...home, units: [...home.units, { symbol: 'm', toSi: 1 }] });
  it('is placed in the unit that it has', () => {
    expect(isPoint(home)).toBe(true);
    expect(isPoint(young) || isPoint(parameter({ numbers: 3 }))).toBe(false);
    expect(pointOf(home, '82.6 25 10.3 mm')!.map((x) => Number(x.toFixed(6)))).toEqual([0.0826, 0.025, 0.0103]);
    expect(pointOf(home, '$home') ?? pointOf(home, '1 2 mm')).toBeNull();
    expect(pointText(home, [0.0826004, -0.025, 1e-9], '1 2 3 mm')).toBe('82.6 -25 0 mm');
    expect(pointText(metres, [0.08261, -0.025, 0], '1 2 3 m')).toBe('0.08261 -0.025 0 m');
    expect(pointText(home, [0.001, 0, 0], '')).toBe('1 0 0 mm');
  });
  it('comes from the picture as three numbers', () => {
    expect(placedFrom({ insula: 'placed', at: [1, 2, 3] })).toEqual([1, 2, 3]);
    expect(placedFrom({ insula: 'placed', at: [1, 2] }) ?? placedFrom({ at: [1, 2, 3] })).toBeNull();
    expect(framedPoint([1, 2, 3])).toEqual([1, 2, 3]);
    for (const wrong of [null, [1, 2], [1, 2, NaN], [1, 2, '3'], 'place']) expect(framedPoint(wrong)).toBeNull();
  });
});

describe('a proposed name', () => {
  const problem = { severity: 'error', file: 'a', line: 1, column: 1 };
  it('takes the place of the wrong one', () => {
    const doc = '<scene>\n<dissectr hand="left"/></scene>';
    const words = 'unknown element <dissectr>; did you mean <dissector>?';
    const change = meant(doc, 8, { ...problem, text: words, nearest: 'dissector' })!;
    expect(applied(doc, change)).toBe(doc.replace('dissectr', 'dissector'));
    const fem = '<corotational_fem yuong="2.1 kPa"/>';
    const parameterWords = '<corotational_fem> has no parameter "yuong"; did you mean "young"?';
    expect(applied(fem, meant(fem, 18, { ...problem, text: parameterWords, nearest: 'young' })!)).toBe(
      fem.replace('yuong', 'young'),
    );
  });
  it('is none if none is near', () => {
    expect(meant('<a/>', 0, { ...problem, text: 'no', nearest: '' })).toBeNull();
  });
});

describe('the present view', () => {
  const data = { insula: 'view', eye: [0.1, -0.0251234, 0], target: [0, 0, 0.001], up: [0, 0.123456, 1] };
  const seen = { eye: '100 -25.12 0 mm', target: '0 0 1 mm', up: '0 0.1235 1' };
  it('is read in millimetres', () => {
    expect(viewFrom(data)).toEqual(seen);
    expect(viewFrom({ ...data, eye: [1, 2] })).toBeNull();
    expect(viewFrom('view')).toBeNull();
  });
  it('changes the view of the scene and keeps its other attributes', () => {
    const doc = '<scene>\n  <view eye="1 2 3 mm"   field_of_view="12 deg" target="0 0 0 mm"/> <!-- c -->\n</scene>';
    const changed = doc.replace('1 2 3 mm', seen.eye).replace('"0 0 0 mm"', `"${seen.target}" up="${seen.up}"`);
    expect(applied(doc, changedView(doc, seen)!)).toBe(changed);
    expect(applied('<scene>\n</scene>', addedView('<scene>\n</scene>', seen)!)).toBe(
      '<scene>\n  <view eye="100 -25.12 0 mm" target="0 0 1 mm" up="0 0.1235 1"/>\n</scene>',
    );
  });
});
