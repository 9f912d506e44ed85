// SPDX-License-Identifier: GPL-3.0-or-later
import { describe, expect, it } from 'vitest';
import { curvesOf, exercisesOf } from '../src/start/api';
import { bySite, chosen } from '../src/start/case_filter';
import { certificateOf } from '../src/start/certificate_api';
import { courseOf, curriculaOf } from '../src/start/course_api';
import { conditionOf, conditionText, rowText } from '../src/start/gate_words';
import { cusumText, levelText, reachedText } from '../src/start/learning';

describe('a curriculum of the gateway', () => {
  it('is checked before use', () => {
    expect(curriculaOf(7)).toEqual({ state: '', problem: '', curricula: [] });
    expect(curriculaOf({ state: 'ready', curricula: [{ id: 'a', title: 'A' }, {}, null] }).curricula).toEqual([
      { id: 'a', title: 'A', text: '', problem: '' },
    ]);
    expect(courseOf(null).id).toBe('');
    const task = { id: 't', standing: 'king', start: 'waiting', seed: 'x', gates: [{ needed: 0 }], runs: [{}, 7] };
    const course = courseOf({ modules: [{ id: 'm', standing: 'due', tasks: [task], locked_by: ['a', 3] }] });
    expect(course.modules[0]).toMatchObject({ standing: 'due', lockedBy: ['a'] });
    expect(course.modules[0]!.tasks[0]).toMatchObject({ standing: 'locked', runs: [], passedMs: null });
    expect(course.modules[0]!.tasks[0]!.terms).toEqual({ scene: '', sceneTitle: '', mode: 'practice', seed: null });
    expect(course.modules[0]!.tasks[0]!.gates[0]!.needed).toBe(1);
  });
  it('tells how an attempt counts', () => {
    const next = { kind: 'task', task: 't', exercise: 's.xml', scene_title: 'S', start: 'test', seed: 21 };
    expect(courseOf({ next }).next.terms).toEqual({ scene: 's.xml', sceneTitle: 'S', mode: 'test', seed: 21 });
  });
  it('ends with a certificate', () => {
    expect(
      certificateOf({ tasks: [{ gates: [{ kind: 'goals' }], runs: [{ uuid: 'u' }, {}] }] }).tasks[0],
    ).toMatchObject({ gates: [{ kind: 'goals', inARow: 1 }], runs: [{ uuid: 'u' }] });
  });
});

describe('a gate', () => {
  const words = (json: object) => conditionText(conditionOf(json));
  it('is told in words', () => {
    expect(words({ kind: 'goals' })).toBe('All goals are reached');
    expect(words({ kind: 'faults' })).toBe('No faults');
    expect(words({ kind: 'faults', most_faults: 2 })).toBe('At most 2 faults');
    expect(words({ kind: 'faults', most_faults: 1, fault_texts: ['Vein torn', 'Out of order'] })).toBe(
      'At most 1 of these faults: Vein torn, Out of order',
    );
    const path = { kind: 'metric', metric_text: 'Path', hand: 'right', unit: 'mm', at_most: 2000.5 };
    expect(words(path)).toBe('Path, right hand: at most 2000.5 mm');
    expect(words({ ...path, at_least: 3, group: 'ours' })).toBe(
      'Path, right hand: 3 mm to 2000.5 mm, as the group “ours”',
    );
    expect(rowText(conditionOf({}))).toBe('');
    expect(rowText(conditionOf({ in_a_row: 3 }))).toBe('3 times in a row');
    expect(rowText(conditionOf({ in_a_row: 3, within_ms: 30 * 86_400_000 }))).toBe('3 times in a row, within 30 days');
  });
});

describe('cases', () => {
  const cases = exercisesOf([
    { scene: 'a', site: 'middle cerebral', difficulty: 4 },
    { scene: 'b' },
    { scene: 'c', site: 'middle cerebral', difficulty: 2 },
    { scene: 'd', site: 'basilar tip', difficulty: 99 },
    { scene: 'e', site: 'middle cerebral' },
  ]);
  it('are grouped by site, the easiest first, what is not said last', () => {
    const groups = bySite(cases).map((g) => [g.site, g.cases.map((c) => c.map((e) => e.scene).join('+')).join('')]);
    expect(groups).toEqual([
      ['basilar tip', 'd'],
      ['middle cerebral', 'cae'],
      ['', 'b'],
    ]);
    expect(cases[3]!.difficulty).toBe(5);
  });
  it('keep their exercises together', () => {
    const exercises = exercisesOf([
      { scene: 'a', difficulty: 4, case: 'one' },
      { scene: 'b', difficulty: 3 },
      { scene: 'c', difficulty: 2, case: 'one' },
      { scene: 'd', difficulty: 3 },
    ]);
    const scenes = bySite(exercises)[0]!.cases.map((c) => c.map((e) => e.scene));
    expect(scenes).toEqual([['a', 'c'], ['b'], ['d']]);
  });
  it('are chosen by site and difficulty', () => {
    const names = (site: string | null, most: number) => chosen(cases, site, most).map((c) => c.scene);
    expect(names(null, 0)).toHaveLength(5);
    expect(names('middle cerebral', 3)).toEqual(['c']);
    expect(names('', 0)).toEqual(['b']);
  });
});

describe('a level', () => {
  const cusum = { sum: [0.9, 1.8], h0: 1.8, h1: 1.7, accepted: null, alarmed: 1 };
  const curve = (more: object) =>
    curvesOf([{ unit: 'mm', digits: 1, level: { at_most: 9, in_a_row: 2, source: 'curriculum' }, cusum, ...more }])[0]!;
  it('is told in words', () => {
    const c = curve({});
    expect(levelText(c, c.learning!)).toBe('Level of the curriculum: at most 9 mm');
    expect(reachedText(c.learning!)).toBe('Not reached yet: it takes 2 attempts in a row.');
    expect(reachedText(curve({ attempts_to_level: 4 }).learning!)).toBe('Reached 2 times in a row after 4 attempts.');
    expect(cusumText(c.learning!)).toContain('too frequent');
    expect(cusumText(curve({ cusum: { ...cusum, sum: [-2], accepted: 0 } }).learning!)).toContain('rare');
    expect(cusumText(curve({ cusum: { ...cusum, sum: [-2, 0] } }).learning!)).toContain('Too few');
  });
  it('may be unknown', () => {
    expect(curve({ level: {} }).learning).toBeNull();
    expect(curve({ level: 'low' }).learning).toBeNull();
  });
});
