// SPDX-License-Identifier: GPL-3.0-or-later
// How a person at the page practises an exercise: follows the targets of both hands as the guide's panel tells,
// presses the buttons, chooses clips, and places a clip anew that lies badly.

/** Nobody moves on with a wrist that is seen to be turned so wrong. */
const wrongDegrees = 20;
/** Pictures and programs take a moment; the longer ones are for blades and for goals that ask to hold on. */
const bladesMs = 2000;
const holdMs = 5000;
const neckShut = (view) => view.goals.every((g) => g.done || !/neck/.test(g.text)) || /neck is shut/.test(view.message);

/** Who works beside an aneurysm moves with care. */
const besideAneurysm = (view) => view.chooses || view.goals.some((g) => /aneurysm/.test(g.text));

export class Practice {
  /** careful: whether who sees that moves with care. */
  constructor(person, careful = besideAneurysm) {
    this.person = person;
    this.careful = careful;
    this.page = person.page;
    /** Of each hand: how many targets it has, and whether it has done them. */
    this.course = [0, 1].map(() => ({ of: 0, done: false }));
    this.turnedFor = '';
    this.tries = 0;
    /** What the applier held when it was last told to let go. */
    this.released = '';
    /** Of what the example has left over: how many places, and how often one was swept in vain. */
    this.leftOver = this.sweeps = 0;
  }

  /** Practises until all goals are reached or the time is over; returns what the page shows then. */
  async until(time) {
    let view = await this.person.look();
    while (Date.now() < time && view.end === '') view = await this.next(view);
    return view;
  }

  /** What is done next, and what is seen after it. */
  async next(view) {
    const { target } = view;
    if (view.leftOver) return this.clear(view);
    if (target === null || view.otherFirst) return this.handOver();
    const mine = this.course[view.hand];
    const other = this.course[1 - view.hand];
    mine.of = target.of;
    mine.done ||= target.at === target.of && target.near;
    // All targets are done, but not all goals: the hand that has more of them begins again.
    if (mine.done && other.of > 0 && (!other.done || other.of > mine.of)) return this.handOver();
    if (mine.done) return this.beginAgain(target, mine);
    const choice = /^Choose from the list: (.*) \(L\)$/.exec(view.todo)?.[1];
    if (choice) return this.choose(choice);
    if (/^Take up: .* \(T\)$/.test(view.todo)) return this.takeUp();
    return this.goTo(target, view);
  }

  async takeUp() {
    await this.page.keyboard.press('t');
    return this.person.settled();
  }

  /** What the example has left over: goes there, and sweeps the edge across it; passes over what does not give way. */
  async clear(view) {
    const { count, mm } = view.leftOver;
    if (count !== this.leftOver) this.sweeps = 0;
    this.leftOver = count;
    this.tell(view, `: ${count} left over, ${mm} mm`);
    if (++this.sweeps % 9 === 0) {
      await this.page.keyboard.press('n');
      return this.person.settled();
    }
    return /^Sweep/.test(view.todo) ? this.sweepHere() : this.person.reach(view, true);
  }

  async sweepHere() {
    await this.person.sweep();
    return this.person.settled();
  }

  async handOver() {
    await this.person.holdHere();
    return this.person.settled();
  }

  async beginAgain(target, mine) {
    mine.done = false;
    for (let k = 3; k < target.of; k++) await this.page.keyboard.press('Shift+N');
    return this.person.settled();
  }

  async choose(title) {
    await this.person.choose(title);
    return this.person.settled();
  }

  /** One try: turns the wrist, presses what is to be pressed, or moves nearer. */
  async goTo(target, before) {
    await this.turn(target, before);
    const view = await this.person.look();
    if (view.target?.at !== target.at || view.hand < 0) return view;
    if (view.target.near && /button/.test(view.todo)) return this.press(view);
    if (/^Stay here/.test(view.todo)) return this.stay(view);
    if (/^Sweep/.test(view.todo)) return this.sweepHere();
    if (this.tries > 12) await this.page.keyboard.press('n');
    const after = await this.person.reach(view, this.careful(view));
    if (this.tries === 1) this.tell(after);
    return after;
  }

  /** Waits for the goal; when the tutor says that the other hand has lost its hold, that one grips again. */
  async stay(view) {
    this.tell(view, `, ${view.cue || 'waits'}`);
    if (!/not held/.test(view.cue)) return this.person.settled();
    const other = await this.handOver();
    this.course[other.hand].done = false;
    for (let k = 0; k < 2; k++) await this.page.keyboard.press('Shift+N');
    return this.person.settled();
  }

  /** Lets the page turn the wrist, and spoils it a little at a new target. */
  async turn(target, { hand }) {
    const here = `${hand} ${target.at}`;
    if (here !== this.turnedFor) this.tries = 0;
    const again = this.tries > 2 || target.degrees > wrongDegrees;
    if (!target.near && target.degrees > 5 && (here !== this.turnedFor || again)) {
      await this.page.keyboard.press('y');
      await this.person.settled();
      if (this.tries === 0) await this.person.tremble();
    }
    this.turnedFor = here;
    this.tries++;
  }

  /** What the hand does at a target that is reached but for its buttons. */
  async press(view) {
    if (/hold button 2/.test(view.todo)) this.released = view.loaded;
    for (const [, on, off] of view.todo.matchAll(/hold button (\d)|let button (\d) go/g)) {
      // A goal may ask to hold on for a while.
      if (off === '1') await this.person.wait(3000);
      await this.person.squeeze(Number(on ?? off), Boolean(on));
      if (off) await this.person.wait(bladesMs);
    }
    this.tell(view, `: ${view.todo}`);
    const permanent = this.released !== '' && !/temporary/i.test(this.released);
    const clipIsFree = permanent && /let button 2 go/.test(view.todo);
    return clipIsFree && !neckShut(view) ? this.placeAgain() : this.person.settled();
  }

  /** A clip that lies badly is taken back, opened where it is, moved as the message says, and closed again. */
  async placeAgain() {
    const { person } = this;
    for (let k = 0; ; k++) {
      await person.wait(holdMs);
      const view = await person.look();
      if (neckShut(view) || view.end !== '' || k === 5) return view;
      await this.button2();
      await person.wait(700);
      await person.squeeze(1, true);
      await person.wait(800);
      const short = /tips end ([\d.]+) mm before/.exec(view.message)?.[1];
      const deeper = /branch/.test(view.message) ? -0.0007 : Number(short ?? 0) / 1000 + 0.0005;
      this.tell(view, `: again, ${deeper} m deeper`);
      await person.move([0, 0, -deeper].map((w) => w + person.error(0.0002)));
      await person.wait(500);
      await person.squeeze(1, false);
      await person.wait(bladesMs);
      await this.button2();
    }
  }

  /** What lets a clip go, and takes it back. */
  async button2() {
    await this.person.squeeze(2, true);
    await this.person.wait(300);
    await this.person.squeeze(2, false);
  }

  tell({ hand, target, goals, faults, message, clipNear }, what = '') {
    if (!process.env.VERBOSE) return;
    const { began, mPerPx, clockRate } = this.person;
    const seconds = ((Date.now() - began) / 1000).toFixed(0);
    const done = goals.map((g) => (g.done ? '+' : '-')).join('');
    const at = target ? `${target.at}/${target.of}, ${target.mm} mm, ${target.degrees} degrees` : 'no target';
    const rate = `${(1e6 * mPerPx).toFixed(0)} um a pixel, clock at ${clockRate.toFixed(2)}`;
    console.log(`   ${seconds} s: hand ${hand}: ${at}${what}; goals ${done}; ${rate}`);
    console.log(`      ${[...faults, message, clipNear].filter((t) => t !== '').join('; ')}`);
  }
}
