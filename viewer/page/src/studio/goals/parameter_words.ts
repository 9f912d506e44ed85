// SPDX-License-Identifier: GPL-3.0-or-later
// What parameters of rules mean, in an author's language. Those that are not here have their own words, in English.
import { text } from '../../languages/text';

/** '': none. */
export function parameterWords(element: string, parameter: string): string {
  switch (`${element}.${parameter}`) {
    case 'goal_clipped.max_grade':
      return text('Worst remnant that is accepted (Sindou grade)');
    case 'goal_clipped.min_flow':
      return text('Least flow of a branch, as a share of that before');
    case 'fault_stenosis.limit':
      return text('A branch counts as narrowed below this share of its flow');
    case 'goal_clipped.sealed':
      return text('The sac counts as closed below this share of its section');
    case 'goal_strands.fraction':
      return text('Share of the strands to be divided');
    case 'goal_opening.distance':
      return text('How far the lips are to be parted');
    case 'goal_bleeding_stopped.rate':
    case 'goal_temporary_removed.rate':
    case 'timer_rupture.rate':
      return text('It counts as bleeding above');
    case 'goal_two_hands.count':
      return text('How often');
    case 'fault_force.limit':
      return text('Largest force');
    case 'fault_order.allowed':
      return text('Deep strands that may be cut too early');
    case 'time_limit.limit':
    case 'timer_rupture.limit':
    case 'timer_temporary_clip.limit':
      return text('Time limit');
    case 'complication.probability':
      return text('How likely it is, 0 to 1');
    case 'complication.from':
      return text('Not before');
    case 'complication.to':
      return text('Not after');
    case 'strand_springs.density':
      return text('How densely they stand');
    case 'strand_springs.max_length':
      return text('Longest that arises');
    case 'strand_springs.stiffness':
    case 'arachnoid_membrane.stiffness':
      return text('Stiffness');
    case 'strand_springs.strength':
    case 'arachnoid_membrane.strength':
      return text('Force at which it tears');
    case 'strand_springs.cut_force':
      return text('Force of a blade that cuts it');
  }
  if (parameter === 'hold') return text('How long it must hold');
  return parameter === 'grace' ? text('Shorter times are forgiven') : '';
}

export const isOfStrands = (element: string): boolean =>
  element === 'strand_springs' || element === 'arachnoid_membrane';

/** What strands tie, by the names that the case builder gives them. */
export function strandWords(element: string, id: string): string {
  if (element === 'arachnoid_membrane')
    return text('Membrane between strands: {id}', { id: id.replace(/^membrane_to_/, '') });
  switch (id) {
    case 'arachnoid':
      return text('Strands between the lips of the fissure');
    case 'to_frontal':
      return text('Strands to the frontal lobe');
    case 'to_temporal':
      return text('Strands to the temporal lobe');
    case 'to_branches':
      return text('Strands between sac and branches');
    default:
      return text('Strands: {id}', { id: id.replace(/^to_/, '') });
  }
}

/** What happens by chance. */
export function complicationWords(command: string): string {
  if (command.startsWith('bleeding rupture')) return text('The dome ruptures');
  return command.startsWith('heart set_systolic') ? text('The blood pressure rises') : command;
}
