// SPDX-License-Identifier: GPL-3.0-or-later
// A person at the page, for tests: sees what stands in the panels, reacts after 300 ms, aims with an error of 2 mm and
// 10 degrees, and moves by mouse, wheel and keys. Knows no pose and asks nothing but the page's texts.

const reactionMs = 300;
const aimM = 0.002;
const aimRad = (10 * Math.PI) / 180;
/** Careful hands stop so far before a target, and then go on by so much at most. */
const stopM = 0.006;
const shortM = 0.003;
const carefulM = (distance) => (distance > 1.2 * stopM ? distance - stopM : Math.min(shortM, distance));
/** Half of a short sweep, m. */
const sweepM = 0.0015;
const wheelM = 0.0008;
const keyRadPerS = 0.9;
const keyOfButton = { 1: 'Space', 2: 'b' };
/** A hand goes on in steps of this length, m: slowly over short distances, quickly over long ones. */
const stepM = 0.002;
const stepMs = (distance) => (distance > 0.01 ? 60 : 160);
/** The mouse's gain is learnt from movements in the picture that are at least so long, m. */
const learnFromM = 0.0015;

export const pause = (ms) => new Promise((r) => setTimeout(r, ms));

/** Numbers in 0..1, the same ones for the same seed (Park and Miller). */
function chance(seed) {
  let x = (seed * 48271 + 11) % 2147483647;
  return () => (x = (x * 48271) % 2147483647) / 2147483647;
}

/** Runs in the page: until a picture has been drawn after what was done before. */
const nextPicture = () => new Promise((r) => requestAnimationFrame(() => requestAnimationFrame(() => r(null))));

/** What the guide's panel says, as a person reads it: mm and degrees by direction. Runs in the page. */
function readPanel() {
  const seen = (e) => e !== null && e.checkVisibility();
  const text = (s) => document.querySelector(s)?.textContent ?? '';
  const guide = document.querySelector('.guide');
  const ways = {};
  for (const li of document.querySelectorAll('.guide li')) {
    if (!seen(li)) continue;
    const found = /^\S+ (deeper|back|right|left|up|down|roll|swing|tilt)(?: \((\w)\))? ([\d.]+)/.exec(li.textContent);
    if (found) ways[found[2] && 'QEADRF'.includes(found[2]) ? found[2] : found[1]] = Number(found[3]);
  }
  const header = text('.guide header b');
  const title = /Target (\d+) of (\d+): ([\d.]+) mm, (\d+)°/.exec(header);
  const leftOver = seen(guide) ? /(\d+) left over: ([\d.]+) mm/.exec(header) : null;
  return {
    target:
      seen(guide) && title
        ? { at: +title[1], of: +title[2], mm: +title[3], degrees: +title[4], near: guide.dataset.near === 'true' }
        : null,
    /** What the example has left over: how many places, and how far the chosen one is. */
    leftOver: leftOver ? { count: +leftOver[1], mm: +leftOver[2] } : null,
    ways,
    todo: text('.guide .todo'),
    otherFirst: seen(document.querySelector('.guide .waits')),
    hand: [...document.querySelectorAll('.hand')].findIndex((h) => h.classList.contains('active')),
    latched: document.querySelector('.hand.active .latch')?.getAttribute('aria-pressed') === 'true',
    goals: [...document.querySelectorAll('.goals li')].map((g) => ({
      text: g.textContent,
      done: g.classList.contains('done'),
    })),
    message: text('.message'),
    /** What the tutor says. */
    cue: seen(document.querySelector('.cue')) ? text('.cue') : '',
    clockS: text('.clock')
      .split(':')
      .reduce((s, part) => 60 * s + Number(part), 0),
    /** How far a clip in the field is, and whether it can be taken back. */
    clipNear: text('.hand.active .reach'),
    /** The clip in the applier; '': none. */
    loaded: /^No /.test(text('.tool-list-head b')) ? '' : text('.tool-list-head b'),
    chooses: seen(document.querySelector('.tool-list')),
    faults: [...document.querySelectorAll('.faults li')].map((f) => f.textContent),
    end: seen(document.querySelector('.dialog.summary')) ? text('.dialog.summary h2') : '',
  };
}

export class Person {
  /** pace: 1 is a person's; 0 waits for nothing, for a page that is made up. */
  constructor(page, seed, pace = 1) {
    this.page = page;
    /** Of the exercise's clock, in seconds a second: below 1 on a machine that is too slow for the scene. */
    this.clockRate = 1;
    this.seen = null;
    // Where the exercise is slow, a person whose hands were not would hurry.
    this.wait = (ms) => pause((pace * ms) / this.clockRate);
    this.random = chance(seed);
    // Learnt from what the panel says before and after a movement.
    this.mPerPx = 0.0001;
    this.held = new Set();
    this.began = Date.now();
  }

  /** Looks at a new picture, and takes a moment to understand. */
  async look() {
    await this.wait(reactionMs);
    await this.page.evaluate(nextPicture);
    const view = await this.page.evaluate(readPanel);
    this.watchClock(view.clockS);
    return view;
  }

  /** Learns how fast the exercise's clock goes. */
  watchClock(clockS) {
    const seconds = Date.now() / 1000;
    this.seen ??= { clockS, seconds };
    const past = seconds - this.seen.seconds;
    if (past < 2) return;
    this.clockRate = Math.max(0.1, Math.min(1, (clockS - this.seen.clockS) / past || 1));
    this.seen = { clockS, seconds };
  }

  /** Looks until the tool has come to rest; on a slow machine the picture is late. */
  async settled() {
    let last = await this.look();
    for (let k = 0; k < 12; k++) {
      const now = await this.look();
      const shown = (seen, what) => (seen.target ?? seen.leftOver)?.[what] ?? 0;
      const still = (what) => Math.abs(shown(now, what) - shown(last, what));
      last = now;
      if (still('mm') < 0.15 && still('degrees') < 1) break;
    }
    return last;
  }

  /** Normal deviate. */
  error(sd) {
    return sd * Math.sqrt(-2 * Math.log(1 - this.random())) * Math.cos(2 * Math.PI * this.random());
  }

  /** An error of aim: 2 mm in the root of the mean square over the three directions. */
  aim() {
    return [0, 1, 2].map(() => this.error(aimM / Math.sqrt(3)));
  }

  /** m: to the right, up, to the viewer. Goes on when the hand has got there. */
  async move([right, up, out]) {
    const { mouse, keyboard } = this.page;
    const { width, height } = this.page.viewportSize();
    const distance = Math.hypot(right, up, out);
    const steps = Math.max(1, Math.ceil(distance / stepM));
    const from = [0.5 * width, 0.25 * height];
    const px = [right / this.mPerPx, -up / this.mPerPx];
    const clicks = out / wheelM;
    await mouse.move(...from);
    await mouse.down();
    let turned = 0;
    for (let k = 1; k <= steps; k++) {
      await mouse.move(from[0] + (px[0] * k) / steps, from[1] + (px[1] * k) / steps);
      const due = Math.round((clicks * k) / steps) - turned;
      if (due !== 0) {
        await keyboard.down('Shift');
        await mouse.wheel(0, 100 * due);
        await keyboard.up('Shift');
        turned += due;
      }
      await this.wait(stepMs(distance));
    }
    await mouse.up();
  }

  /** Across a place and back, in the picture's two directions. */
  async sweep() {
    const across = [
      [1, 0],
      [-2, 0],
      [1, 1],
      [0, -2],
      [0, 1],
    ];
    for (const [right, up] of across) {
      const error = this.error(0.0003);
      await this.move([right * sweepM + error, up * sweepM + error, 0]);
    }
  }

  /** Holds a button by its key, or lets it go; a latched one goes off when its key is pressed. */
  async squeeze(button, on) {
    const key = keyOfButton[button];
    if (on) await this.page.keyboard.down(key);
    else if (this.held.has(button)) await this.page.keyboard.up(key);
    else await this.page.keyboard.press(key);
    if (on) this.held.add(button);
    else this.held.delete(button);
  }

  /** Leaves this hand here with what its buttons do, and takes the other one. */
  async holdHere() {
    await this.page.keyboard.press('x');
    for (const button of this.held) await this.page.keyboard.up(keyOfButton[button]);
    this.held.clear();
  }

  /** Opens the list of what an instrument takes up, and clicks the entry of that name. */
  async choose(title) {
    await this.page.keyboard.press('l');
    await this.wait(reactionMs);
    for (const entry of await this.page.locator('.tool-list [role=option]').all())
      if ((await entry.locator('b').textContent()) === title) await entry.click();
  }

  /** Turns the wrist a little wrong: 10 degrees in the root of the mean square over the three turns. */
  async tremble() {
    for (const [more, less] of ['eq', 'da', 'fr']) {
      const rad = this.error(aimRad / Math.sqrt(3));
      const key = rad > 0 ? more : less;
      await this.page.keyboard.down(key);
      await this.wait((1000 * Math.abs(rad)) / keyRadPerS);
      await this.page.keyboard.up(key);
    }
  }

  /** The way that the panel shows, m. */
  wayOf({ ways }) {
    const pair = (more, less) => ((ways[more] ?? 0) - (ways[less] ?? 0)) / 1000;
    return [pair('right', 'left'), pair('up', 'down'), pair('back', 'deeper')];
  }

  /**
   * One try to reach the target: the way that is shown, with an error; learns how far the mouse goes. careful: to a
   * place before it, and then nearer by short movements.
   */
  async reach(view, careful = false) {
    const whole = this.wayOf(view);
    const distance = Math.hypot(...whole);
    const length = careful ? carefulM(distance) : distance;
    const way = whole.map((w) => (distance > 0 ? (w * length) / distance : 0));
    const error = this.aim();
    // Nobody overshoots a short way by its own length, and short movements with care err by a quarter of it.
    const share = Math.min(1, length / ((careful && length < stopM ? 4 : 2) * aimM));
    const made = way.map((w, k) => w + share * error[k]);
    await this.move(made);
    const after = await this.settled();
    const far = Math.hypot(made[0], made[1]);
    if (far < learnFromM || !view.target || after.target?.at !== view.target.at) return after;
    const left = this.wayOf(after);
    const gone = Math.hypot(whole[0] - left[0], whole[1] - left[1]);
    // The panel is read to a tenth of a millimetre, and leaves out what is near: a short movement teaches less.
    const certain = Math.min(1, far / 0.006);
    this.mPerPx *= Math.max(0.7, Math.min(1.5, 1 + certain * (gone / far - 1)));
    return after;
  }
}
