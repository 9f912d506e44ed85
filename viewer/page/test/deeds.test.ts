// SPDX-License-Identifier: GPL-3.0-or-later
// Quick deeds in the studio: a gateway that answers late, and changes that do not overwrite each other.
import { expect, test } from 'vitest';
import { type Act, type Project, projectOf } from '../src/studio/api';
import { Deeds } from '../src/studio/deeds';
import { withChange } from '../src/studio/goals/rules';

const projectWith = (choices: object): Project => projectOf({ name: 'one', choices });

/** Keeps choices as the real one does: by name. Its answers wait until they are let go. */
class SlowGateway {
  choices: Record<string, unknown> = { rules: [], walls: [] };
  readonly asked: string[] = [];
  private readonly waiting: (() => void)[] = [];

  project = (): Promise<Project> => this.answer('project');
  act = (act: Act, more: object): Promise<Project> => {
    Object.assign(this.choices, (more as { choices?: object }).choices);
    return this.answer(act);
  };

  private answer(what: string): Promise<Project> {
    this.asked.push(what);
    const project = projectWith(structuredClone(this.choices));
    return new Promise((resolve) => this.waiting.push(() => resolve(project)));
  }

  async letGo(): Promise<void> {
    this.waiting.shift()!();
    for (let k = 0; k < 20; k++) await Promise.resolve();
  }
}

function begun(gateway: { project(): Promise<Project>; act(act: Act, more: object): Promise<Project> }) {
  const shown: Project[] = [];
  const faults: unknown[] = [];
  const overtaken: ((() => void) | null)[] = [];
  const deeds = new Deeds(gateway, (p) => shown.push(p), {
    failed: (e) => faults.push(e),
    overtaken: (again) => overtaken.push(again),
  });
  return { deeds, shown, faults, overtaken };
}

const limit = (deeds: Deeds, rule: string, value: string) =>
  deeds.choose((now) => ({ rules: withChange(now.rules, 3, rule, 'limit', value) }));

test('two changes of one list, the second before the first is answered, both stay', async () => {
  const gateway = new SlowGateway();
  const { deeds, shown } = begun(gateway);
  void deeds.follow();
  await gateway.letGo();
  void limit(deeds, 'time', '10 min');
  void limit(deeds, 'vessel_force', '0.2 N');
  await Promise.resolve();
  expect(gateway.asked).toEqual(['project', 'choose']);
  await gateway.letGo();
  await gateway.letGo();
  expect(gateway.choices.rules).toEqual(['3.time.limit=10 min', '3.vessel_force.limit=0.2 N']);
  expect(shown.at(-1)!.choices.rules).toEqual(gateway.choices.rules);
});

test('an undo that follows a change at once comes after it', async () => {
  const gateway = new SlowGateway();
  const { deeds } = begun(gateway);
  void deeds.follow();
  await gateway.letGo();
  gateway.asked.length = 0;
  void deeds.choose({ walls: ['neck.young=7 MPa'] });
  void deeds.act('undo');
  await Promise.resolve();
  await gateway.letGo();
  expect(gateway.asked).toEqual(['choose', 'undo']);
});

test('what was asked before a change, and is answered after it, is not shown', async () => {
  const gateway = new SlowGateway();
  const { deeds, shown } = begun(gateway);
  void deeds.follow();
  await gateway.letGo();
  gateway.asked.length = shown.length = 0;
  void deeds.follow();
  void deeds.choose({ walls: ['neck.young=7 MPa'] });
  await Promise.resolve();
  await gateway.letGo();
  expect(shown).toEqual([]);
  void deeds.follow();
  expect(gateway.asked, 'nothing is asked while a change is on its way').toEqual(['project', 'choose']);
  await gateway.letGo();
  expect(shown.map((p) => p.choices.walls)).toEqual([['neck.young=7 MPa']]);
});

test('a change that is refused does not stop the next one', async () => {
  let left = 1;
  const gateway = {
    project: () => Promise.resolve(projectWith({ walls: ['bleb.young=1 MPa'] })),
    act: (_act: Act, more: object) =>
      left-- > 0
        ? Promise.reject(new Error('no'))
        : Promise.resolve(projectWith((more as { choices: object }).choices)),
  };
  const { deeds, shown, faults } = begun(gateway);
  expect(await deeds.choose({ walls: ['neck.young=1e9 MPa'] })).toBeNull();
  await deeds.choose((now) => ({ walls: [...now.walls, 'neck.young=7 MPa'] }));
  expect(faults).toEqual([new Error('no')]);
  expect(shown.at(-1)!.choices.walls).toEqual(['bleb.young=1 MPa', 'neck.young=7 MPa']);
});
