// SPDX-License-Identifier: GPL-3.0-or-later
// The help overlay: every key and mouse action. It scrolls, and closes by button or key.
import { Dialog } from './dialog';
import { text } from '../languages/text';
import { el } from './dom';

const rows: [string, string][] = [
  [
    text('Tab, 1, 2'),
    text('choose the left or the right hand; a button whose key you hold meanwhile stays on, latched'),
  ],
  [text('left drag, arrow keys'), text('move the tool in the picture plane (Shift: finer)')],
  [text('Shift + wheel, W / S'), text('push the tool deeper, draw it back')],
  [text('Q / E'), text('roll the tool about its shaft')],
  [text('A / D, R / F'), text('swing the tool left and right, up and down about its tip')],
  [text('Space'), text('button 1: act with the tool; lets a latched button go')],
  [text('B'), text('button 2: let go of what the tool holds, take it back')],
  [text('T, Shift + T'), text('next, previous tool of the active hand')],
  [text('X'), text('hold this hand where it is, with what its button does, and take the other one')],
  [text('Z'), text('undo: back to the tool that the hand had before')],
  [text('L'), text('choose what the tool takes up (arrow keys or 1-9, Enter)')],
  [text('I, J'), text('infrared picture; inject the dye')],
  [text('O, [ ]'), text('stereo: off, side by side, red-cyan; less, more depth')],
  [text('U'), text('depth: plumb line from the tip to the tissue, on or off')],
  [text('K'), text('ruler from the tip to the tissue: along the tool, along the line of sight, off')],
  [text('M'), text('sound on or off')],
  [text('G'), text('give the hand back: its buttons go off and it glides home')],
  [text('N, Shift + N'), text('next, previous target while you practise')],
  [text('Y'), text('while you practise: turn the tool slowly as the target is turned; its tip stays')],
  [text('right drag'), text('turn the microscope')],
  [text('middle drag'), text('move the field of view')],
  [text('wheel'), text('zoom')],
  [text('double click'), text('focus on that point; C: on the active tool')],
  [text('V'), text('microscope back to its first view')],
  [text('P'), text('pause, resume')],
  [text('H or ?'), text('this help')],
  [text('Esc, Shift + Tab'), text('leave the field for the controls; Esc closes a list or this help')],
  [
    text('one finger, pen'),
    text('move the tool in the picture plane; the tool leans and rolls as the pen leans and twists'),
  ],
  [text('a finger beside the pen'), text('slide up or down: deeper or back; slide sideways: roll')],
  [text('two fingers'), text('slide up or down: deeper or back; turn: roll; slide sideways: swing; pinch: zoom')],
  [text('three fingers'), text('turn the microscope')],
  [text('gamepad'), text('each stick moves its hand; with its shoulder button: depth and roll; triggers: button 1')],
  [text('mouse and finger or pen'), text('the mouse drags the active hand, the finger or pen the other one')],
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
    const table = el('table', {}, ...rows.map(([keys, what]) => el('tr', {}, el('th', {}, keys), el('td', {}, what))));
    const close = { name: 'close', text: text('Close'), run: () => undefined };
    this.dialog.show(text('Mouse, keyboard and touch'), [table], [close], () => undefined);
  }
}
