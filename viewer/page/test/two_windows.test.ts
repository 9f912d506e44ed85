// SPDX-License-Identifier: GPL-3.0-or-later
// One case in two windows of the studio: neither overwrites what it has not shown.
import { expect, test } from 'vitest';
import { Refusal } from '../src/start/api';
import { type Act, type Project, projectOf } from '../src/studio/api';
import { Deeds } from '../src/studio/deeds';

/** As viewer/gateway/studio.cpp has it: a change of another revision than the present one is refused. */
class OneCase {
  revision = 7;
  choices: Record<string, unknown> = { walls: [], difficulty: 0, site: '' };
  readonly done: string[] = [];

  project = (): Promise<Project> =>
    Promise.resolve(projectOf({ name: 'one', choices: structuredClone(this.choices), revision: this.revision }));
  act = (act: Act, more: object): Promise<Project> => {
    const { choices, revision } = more as { choices?: object; revision?: number };
    if (revision !== this.revision) return Promise.reject(new Refusal('the case was changed in another window', 412));
    if (choices) this.revision++;
    Object.assign(this.choices, choices);
    this.done.push(act);
    return this.project();
  };
}

async function window(of: OneCase) {
  const shown: Project[] = [];
  const faults: unknown[] = [];
  const overtaken: ((() => void) | null)[] = [];
  const deeds = new Deeds(of, (p) => shown.push(p), {
    failed: (e) => faults.push(e),
    overtaken: (again) => overtaken.push(again),
  });
  await deeds.follow();
  const choices = () => shown.at(-1)!.choices;
  return { deeds, choices, faults, overtaken };
}

async function twoWindows() {
  const one = new OneCase();
  return { one, a: await window(one), b: await window(one) };
}

/** For deeds that were asked for by a button. */
const settled = () => new Promise((r) => setTimeout(r));

test('a change of the other window is shown, and the next change is made on it', async () => {
  const { one, a, b } = await twoWindows();
  await a.deeds.choose({ difficulty: 3 });
  await b.deeds.follow();
  expect(b.choices().difficulty).toBe(3);
  await b.deeds.choose({ difficulty: 4 });
  expect(one.choices.difficulty).toBe(4);
  expect(b.overtaken).toEqual([]);
});

test('a change of what the other window has changed is not made, and can be made again', async () => {
  const { one, a, b } = await twoWindows();
  await a.deeds.choose((now) => ({ walls: [...now.walls, 'neck.young=7 MPa'] }));
  expect(await b.deeds.choose((now) => ({ walls: [...now.walls, 'bleb.young=1 MPa'] }))).toBeNull();
  expect(one.choices.walls).toEqual(['neck.young=7 MPa']);
  expect(b.choices().walls).toEqual(['neck.young=7 MPa']);
  expect(b.overtaken).toHaveLength(1);
  expect(b.faults).toEqual([]);
  b.overtaken[0]!();
  await settled();
  expect(one.choices.walls).toEqual(['neck.young=7 MPa', 'bleb.young=1 MPa']);
  expect(b.overtaken).toHaveLength(1);
});

test('of several quick changes, none is made before the author was told, and all are made again', async () => {
  const { one, a, b } = await twoWindows();
  await a.deeds.choose({ site: 'basilar tip' });
  void b.deeds.choose({ difficulty: 5 });
  await b.deeds.choose((now) => ({ walls: [...now.walls, 'bleb.young=1 MPa'] }));
  expect(one.choices).toEqual({ walls: [], difficulty: 0, site: 'basilar tip' });
  b.overtaken.at(-1)!();
  await settled();
  expect(one.choices).toEqual({ walls: ['bleb.young=1 MPa'], difficulty: 5, site: 'basilar tip' });
});

test('an undo, a build or a trial of what was not seen is not done', async () => {
  for (const act of ['undo', 'redo', 'build', 'try'] as const) {
    const { one, a, b } = await twoWindows();
    await a.deeds.choose({ difficulty: 3 });
    expect(await b.deeds.act(act)).toBeNull();
    expect(one.done).toEqual(['choose']);
    expect(b.overtaken, 'it is for the author to press it again').toEqual([null]);
    await b.deeds.act(act);
    expect(one.done).toEqual(['choose', act]);
  }
});

test('a drag that began before the other window changed the case is not applied', async () => {
  const { one, a, b } = await twoWindows();
  b.deeds.begin();
  await a.deeds.choose({ pose: [1, 0, 0, 0, 0, 0] });
  await b.deeds.follow();
  b.deeds.begin(); // the hand moves on
  await b.deeds.choose({ pose: [0, 2, 0, 0, 0, 0] });
  expect(one.choices.pose).toEqual([1, 0, 0, 0, 0, 0]);
  expect(b.choices().pose).toEqual([1, 0, 0, 0, 0, 0]);
  expect(b.overtaken).toHaveLength(1);
  b.deeds.end();
  await b.deeds.choose({ pose: [0, 3, 0, 0, 0, 0] });
  expect(one.choices.pose).toEqual([0, 3, 0, 0, 0, 0]);
});

test('changes of this window do not overtake its own drag', async () => {
  const { one, b } = await twoWindows();
  void b.deeds.choose({ difficulty: 2 });
  b.deeds.begin();
  await b.deeds.choose({ site: 'basilar tip' });
  await b.deeds.follow();
  await b.deeds.choose({ difficulty: 3 });
  expect(one.choices).toEqual({ walls: [], difficulty: 3, site: 'basilar tip' });
  expect(b.overtaken).toEqual([]);
});
