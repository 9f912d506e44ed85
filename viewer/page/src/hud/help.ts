// SPDX-License-Identifier: GPL-3.0-or-later
// The help overlay: every key and mouse action.
import { el } from './dom';

const rows: [string, string][] = [
  ['Tab, 1, 2', 'choose the left or the right hand'],
  ['left drag, arrow keys', 'move the tool in the picture plane (Shift: finer)'],
  ['Shift + wheel, W / S', 'push the tool deeper, draw it back'],
  ['Q / E', 'roll the tool about its shaft'],
  ['A / D, R / F', 'swing the tool left and right, up and down about its tip'],
  ['Space', 'button 1: act with the tool'],
  ['B', 'button 2: let go of what the tool holds, take it back'],
  ['T, Shift + T', 'next, previous tool of the active hand'],
  ['L', 'choose what the tool takes up (arrow keys or 1-9, Enter)'],
  ['I, J', 'infrared picture; inject the dye'],
  ['O, [ ]', 'stereo: off, side by side, red-cyan; less, more depth'],
  ['U', 'depth: plumb line from the tip to the tissue, on or off'],
  ['M', 'beep with the heart'],
  ['G', 'release the hand (back to device or script)'],
  ['right drag', 'turn the microscope'],
  ['middle drag', 'move the field of view'],
  ['wheel', 'zoom'],
  ['double click', 'focus on that point; C: on the active tool'],
  ['V', 'microscope back to its first view'],
  ['P', 'pause, resume'],
  ['H or ?', 'this help'],
  ['touch', 'one finger moves the tool, two turn and zoom'],
];

export function makeHelp(): HTMLElement {
  const table = el('table', {}, ...rows.map(([k, t]) => el('tr', {}, el('th', {}, k), el('td', {}, t))));
  const panel = el(
    'div',
    { class: 'panel help', role: 'dialog', 'aria-label': 'Help' },
    el('h2', {}, 'Mouse and keyboard'),
    table,
  );
  panel.hidden = true;
  return panel;
}
