// SPDX-License-Identifier: GPL-3.0-or-later
import { describe, expect, it } from 'vitest';
import { curvesOf, exercisesOf, historyOf, peopleOf, runningOf, runOf } from '../src/start/api';
import type { Curve } from '../src/start/api';
import { movingMedian, places } from '../src/start/curve';
import { ranked } from '../src/start/progress';
import { durationText, resultText, stateOf } from '../src/start/wording';

const run = (more: object = {}) =>
  runOf({ uuid: 'u', state: 'done', goals: 2, goals_done: 2, faults: 0, duration_s: 65, ...more })!;

describe('answers of the gateway', () => {
  it('are checked before use', () => {
    expect(exercisesOf('nonsense')).toEqual([]);
    expect(exercisesOf([{ scene: 'a', picture: 'yes' }, null, 7, { title: 'no scene' }])).toEqual([
      { scene: 'a', group: '', ofCase: '', name: '', title: '', text: '', site: '', difficulty: 0, picture: false },
    ]);
    expect(peopleOf([{ pseudonym: 'P', year: 'x' }, {}])).toEqual([
      { pseudonym: 'P', role: '', handedness: '', year: 0 },
    ]);
    expect(runOf({})).toBeNull();
    expect(run({ began_ms: Infinity }).beganMs).toBe(0);
    expect(historyOf([{ scene: 's', runs: 3, last: { uuid: 'u' }, best: null }]).get('s')!.best).toBeNull();
    expect(curvesOf([{ digits: 99, points: [{ value: null }] }])[0]!.digits).toBe(6);
    expect(runningOf(undefined)).toEqual({ scene: '', person: '', state: '', text: '', request: '' });
  });
});

describe('what is said of runs', () => {
  it('names goals, faults and time', () => {
    expect(resultText(run())).toBe('all goals, no fault, 1:05 min');
    expect(resultText(run({ state: 'failed', goals_done: 1, faults: 2 }))).toBe(
      '1 of 2 goals, failed, 2 faults, 1:05 min',
    );
    expect(resultText(run({ state: 'running', goals: 1, goals_done: 0, faults: 1 }))).toBe(
      '0 of 1 goal, 1 fault, 1:05 min',
    );
    expect(durationText(59.6)).toBe('1:00 min');
  });
  it('tells new, begun and done', () => {
    const history = { scene: 's', title: '', runs: 1, last: run(), best: run() };
    expect(stateOf(undefined)).toBe('new');
    expect(stateOf(history)).toBe('done');
    expect(stateOf({ ...history, best: run({ state: 'failed' }) })).toBe('begun');
  });
});

describe('learning curves', () => {
  const curve = (metric: string, better: string, values: number[]): Curve => ({
    ...curvesOf([{ metric, better, hand: 'both' }])[0]!,
    points: values.map((value) => ({ uuid: '', beganMs: 0, mode: 'test', done: true, value })),
  });
  it('have the median of the last values', () => {
    expect(movingMedian([5, 1, 9, 3], 3)).toEqual([5, 3, 5, 3]);
    expect(movingMedian([], 3)).toEqual([]);
  });
  it('put larger values higher, and one value in the middle', () => {
    const [a, b] = places([1, 3]);
    expect(a!.y).toBeGreaterThan(b!.y);
    expect(a!.x).toBeLessThan(b!.x);
    expect(places([4])).toEqual([{ x: 150, y: 45 }]);
    expect(places([2, 2])[0]!.y).toBe(45);
  });
  it('come with the largest change first, without those that have no better side', () => {
    const order = ranked([
      curve('same', 'low', [4, 4, 4]),
      curve('noise', 'low', [1, 9, 1]),
      curve('better', 'low', [9, 5, 1]),
      curve('neutral', 'none', [9, 5, 1]),
    ]).map((c) => c.metric);
    expect(order).toEqual(['better', 'noise', 'same']);
  });
});
