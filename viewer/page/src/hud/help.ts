// SPDX-License-Identifier: GPL-3.0-or-later
// The help overlay: every key and mouse action. It scrolls, and closes by button or key.
import { Dialog } from './dialog';
import { el } from './dom';

const rows: [string, string][] = [
  ['Tab, 1, 2', 'choose the left or the right hand; a button whose key you hold meanwhile stays on, latched'],
  ['left drag, arrow keys', 'move the tool in the picture plane (Shift: finer)'],
  ['Shift + wheel, W / S', 'push the tool deeper, draw it back'],
  ['Q / E', 'roll the tool about its shaft'],
  ['A / D, R / F', 'swing the tool left and right, up and down about its tip'],
  ['Space', 'button 1: act with the tool; lets a latched button go'],
  ['B', 'button 2: let go of what the tool holds, take it back'],
  ['T, Shift + T', 'next, previous tool of the active hand'],
  ['X', 'hold this hand where it is, with what its button does, and take the other one'],
  ['Z', 'undo: back to the tool that the hand had before'],
  ['L', 'choose what the tool takes up (arrow keys or 1-9, Enter)'],
  ['I, J', 'infrared picture; inject the dye'],
  ['O, [ ]', 'stereo: off, side by side, red-cyan; less, more depth'],
  ['U', 'depth: plumb line from the tip to the tissue, on or off'],
  ['K', 'ruler from the tip to the tissue: along the tool, along the line of sight, off'],
  ['M', 'sound on or off'],
  ['G', 'give the hand back: its buttons go off and it glides home'],
  ['N, Shift + N', 'next, previous target while you practise'],
  ['Y', 'while you practise: turn the tool slowly as the target is turned; its tip stays'],
  ['right drag', 'turn the microscope'],
  ['middle drag', 'move the field of view'],
  ['wheel', 'zoom'],
  ['double click', 'focus on that point; C: on the active tool'],
  ['V', 'microscope back to its first view'],
  ['P', 'pause, resume'],
  ['H or ?', 'this help'],
  ['Esc, Shift + Tab', 'leave the field for the controls; Esc closes a list or this help'],
  ['one finger, pen', 'move the tool in the picture plane; the tool leans and rolls as the pen leans and twists'],
  ['a finger beside the pen', 'slide up or down: deeper or back; slide sideways: roll'],
  ['two fingers', 'slide up or down: deeper or back; turn: roll; slide sideways: swing; pinch: zoom'],
  ['three fingers', 'turn the microscope'],
  ['gamepad', 'each stick moves its hand; with its shoulder button: depth and roll; triggers: button 1'],
  ['mouse and finger or pen', 'the mouse drags the active hand, the finger or pen the other one'],
];

export class Help {
  private readonly dialog: Dialog;

  constructor(field: () => HTMLElement | null) {
    this.dialog = new Dialog('help', field);
  }

  get root(): HTMLElement {
    return this.dialog.root;
  }

  toggle(): void {
    if (this.dialog.open) {
      this.dialog.close();
      return;
    }
    const table = el('table', {}, ...rows.map(([k, t]) => el('tr', {}, el('th', {}, k), el('td', {}, t))));
    const close = { name: 'close', text: 'Close', run: () => undefined };
    this.dialog.show('Mouse, keyboard and touch', [table], [close], () => undefined);
  }
}
