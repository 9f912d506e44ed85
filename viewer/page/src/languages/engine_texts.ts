// SPDX-License-Identifier: GPL-3.0-or-later
// Texts that the engine's own code says, of any scene: kinds of events, ends, and refusals (lcm_types/sim_event.lcm).
// They are listed for the catalogues; said() looks them up.
import { text } from './text';

export const engineTexts = (): string[] => [
  text('command'),
  text('refused'),
  text('message'),
  text('read'),
  text('goal'),
  text('goal lost'),
  text('fault'),
  text('end'),
  text('mode'),
  text('reset'),
  text('soft guide'),
  text('A test gives no soft force'),
  text('reopened'),
  text('complication'),
  text('Exercise complete'),
  text('The exercise goes on'),
  text('unknown command'),
  text('there is no clip in the applier'),
  text('there is a clip in the applier already'),
  text('the exercise has failed; reset it first'),
  text('the applier lies on the tray; take it up first'),
  text('systolic pressure cannot be below diastolic'),
  text('diastolic pressure cannot be above systolic'),
  text('the last dose of adenosine still acts'),
  text('no more adenosine: the total would be too high'),
  text('nothing bleeds'),
  text('it bleeds already'),
  text('no new problem from the engine: forces are off'),
  text('draw the instrument out of the field before you exchange it'),
  text('draw the applier out of the field before you load it'),
  text('close the jaws before you let the clip go'),
];
