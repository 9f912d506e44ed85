// SPDX-License-Identifier: GPL-3.0-or-later
// What a gateway answers to the pages beside a session, with a person who is half through a curriculum: for checks of
// how these pages look and read. The exercises are the shipped ones.
import { shippedExercises } from './shipped_exercises.mjs';

const began = Date.UTC(2026, 1, 3, 9, 30);
const day = 86_400_000;
const clipping = 'scenes/training/3_clipping.xml';
const fissure = 'scenes/training/1_sylvian_fissure.xml';

export const run = {
  uuid: '0f8b1c52-6f0e-4f5a-9a43-2f6f1d7b8c11',
  scene: clipping,
  title: 'Clipping',
  mode: 'practice',
  began_ms: began,
  duration_s: 185,
  state: 'failed',
  goals: 3,
  goals_done: 1,
  faults: 2,
  recording: 'clipping',
};
const passedRun = { ...run, scene: fissure, state: 'done', goals_done: 3, faults: 0, mode: 'test' };

const points = [3.4, 2.9, 2.2].map((value, k) => ({
  ...{ uuid: `${k}`, began_ms: began + k * day, mode: 'test' },
  ...{ done: true, value },
}));
const curve = { metric: 'a', hand: 'left', text: 'Largest force', unit: 'N', better: 'low', digits: 2, points };

const goals = { kind: 'goals', in_a_row: 1 };
const thrice = { kind: 'faults', most_faults: 0, fault_texts: [], in_a_row: 3, within_ms: 30 * day };
const gate = (condition, met) => ({ condition, in_a_row: met ? 3 : 1, needed: condition.in_a_row, met });

function task(id, title, text, standing, more = {}) {
  const done = standing === 'passed';
  return {
    ...{ id, title, text, standing, exercise: fissure, scene_title: 'Opening the Sylvian fissure' },
    ...{ start: 'test', locked_by: [], gates: [gate(goals, true), gate(thrice, done)] },
    ...{ attempts: 4, runs: [passedRun], passed_ms: done ? began : null, due_ms: done ? began + 7 * day : null },
    ...more,
  };
}

const course = {
  state: 'ready',
  problem: '',
  id: 'residency_year',
  title: 'Residency year',
  text: 'The four exercises in order.',
  passed: true,
  next: {
    ...{ kind: 'task', task: 'fissure_test', why: 'open', exercise: fissure, start: 'test' },
    ...{ scene_title: 'Opening the Sylvian fissure', seed: null },
  },
  modules: [
    {
      ...{ id: 'fissure', title: 'Opening the Sylvian fissure', standing: 'open', locked_by: [] },
      text: 'Two hands, little force, surface before depth.',
      tasks: [
        task('fissure_guided', 'With the guide', 'Retract with one hand and divide with the other.', 'passed'),
        task('fissure_alone', 'Without the guide', '', 'due'),
        task('fissure_test', 'Test', '', 'open'),
      ],
    },
    {
      ...{ id: 'dissection', title: 'Dissecting the aneurysm', standing: 'locked', locked_by: ['fissure'] },
      text: 'Free sac and branches without pulling at the dome.',
      tasks: [task('dissection_guided', 'With the guide', '', 'locked', { runs: [], locked_by: ['fissure'] })],
    },
  ],
};

const certificate = {
  ...{ person: 'P07', curriculum: course.title, content: '3f9a12c4', version: '0.1.0', digest: '5d41402abc4b2a76' },
  ...{ began_ms: began, passed_ms: began + 30 * day },
  tasks: ['With the guide', 'Test'].map((title) => ({
    ...{ module: 'Opening the Sylvian fissure', title, gates: [goals, thrice], attempts_to_level: 4 },
    ...{ passed_ms: began + 7 * day, runs: [passedRun, passedRun] },
  })),
};

const station = (number, name, error, more) => ({
  ...{ number, given: true, name, url: `http://192.0.2.${number}:8080/`, error, picture: 0, station: more },
});
const room = {
  stations: [
    station(1, 'Table 1', '', {
      ...{ person: 'P07', title: 'Clipping', state: 'running', time_s: 95, frame_age_ms: 20 },
      alarms: [{ kind: 'fault', text: 'A strand was torn', time_s: 80 }],
    }),
    station(2, 'Table 2', 'it does not answer', {}),
  ],
  found: [{ name: 'Table 3', url: 'http://192.0.2.3:8080/' }],
  search_error: '',
};

/** Answers by the last part of the path below api/. */
export const placeAnswers = () => ({
  exercises: shippedExercises(),
  people: [{ pseudonym: 'P07', role: 'resident', handedness: 'right', year: 3 }],
  history: [{ scene: run.scene, title: run.title, runs: 2, last: run, best: { ...run, uuid: 'b', state: 'done' } }],
  curves: [curve],
  state: { scene: run.scene, person: 'P07', state: 'running', text: '', request: '' },
  curricula: { state: 'ready', problem: '', curricula: [{ id: course.id, title: course.title, text: course.text }] },
  curriculum: course,
  certificate,
  room,
  login: { access: 'none' },
});
