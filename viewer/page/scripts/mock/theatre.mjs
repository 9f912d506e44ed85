// SPDX-License-Identifier: GPL-3.0-or-later
// What the mock's engine would know beside geometry: tools in hands, clips, pulse, blood, dye, timers; it obeys
// commands and says what happened. All made up.

export const handTools = { left: ['left_suction'], right: ['right_dissector', 'right_clip_applier'] };

export const commands = [
  {
    id: 'right_clip_applier',
    element: 'clip_applier',
    commands: [
      { name: 'load', doc: 'puts a clip from the tray into the applier', argument: 'clip id', min: 0, max: 0 },
      { name: 'release', doc: 'lets the clip go', argument: '', min: 0, max: 0 },
    ],
  },
  {
    id: 'artery_pressure',
    element: 'pressure',
    commands: [
      { name: 'set_systolic', doc: 'systolic pressure', argument: 'pressure_mmHg', min: 60, max: 220 },
      { name: 'set_heart_rate', doc: 'heart rate', argument: 'rate_per_min', min: 40, max: 160 },
    ],
  },
  {
    id: 'flow',
    element: 'blood_flow',
    commands: [{ name: 'inject_dye', doc: 'gives a bolus of indocyanine green', argument: '', min: 0, max: 0 }],
  },
  {
    id: 'artery_bleeding',
    element: 'bleeding',
    commands: [{ name: 'rupture', doc: 'tears the bleb', argument: '', min: 0, max: 0 }],
  },
  {
    id: 'adenosine',
    element: 'adenosine_pause',
    commands: [
      {
        ...{ name: 'give_adenosine', doc: 'the heart pauses some seconds later', argument: 'dose_mg' },
        ...{ min: 1, max: 120, usual: 25 },
      },
    ],
  },
];

/** mL/min. */
const flowAtRest = { parent: 140, superior: 62, inferior: 78, sac: 30 };
export const branches = Object.keys(flowAtRest);

/** clips: ids. script: {rupture, dye, clip, temporary}: simulated seconds at which these happen by themselves. */
export class Theatre {
  constructor(clips, script = {}) {
    this.clips = clips;
    this.script = script;
    this.said = [];
    this.reset();
  }

  reset() {
    this.inHand = { left: 'left_suction', right: 'right_dissector' };
    this.loaded = null;
    this.free = [];
    this.used = {};
    this.tornAt = this.dyeAt = this.placedAt = this.temporaryAt = null;
    this.systolic = 120;
    this.rate = 70;
    this.height = 0;
    this.lost = 0;
    this.time = 0;
    this.phase = 0;
  }

  say(kind, id, text) {
    this.said.push({ kind, id, text });
  }

  run(command, argument) {
    const why = this.tryRun(command, argument);
    if (why) this.say('refused', command, why);
    else this.say(command === 'message' ? 'message' : 'command', command, argument);
  }

  tryRun(command, argument) {
    const [a, b, ...rest] = argument.split(' ');
    if (command === 'message') return argument ? '' : 'a message needs text';
    if (command === 'exchange') {
      if (!handTools[a]?.includes(b)) return `no tool "${b}" for the ${a} hand`;
      this.inHand[a] = b;
      return '';
    }
    if (command !== 'ask') return `unknown command "${command}"`;
    const text = rest.join(' ');
    if (a === 'right_clip_applier' && b === 'load') {
      if (!this.clips.includes(text)) return `no clip "${text}"`;
      if (this.inHand.right !== a) return 'the applier lies on the tray; take it up first';
      if (this.free.includes(text)) return `"${text}" is in the field`;
      this.loaded = text;
      this.say('clip_loaded', text, '');
      return '';
    }
    if (a === 'artery_bleeding' && b === 'rupture') {
      if (this.tornAt === null) {
        this.tornAt = this.time;
        this.say('rupture', a, 'The aneurysm has ruptured');
      }
      return '';
    }
    if (a === 'flow' && b === 'inject_dye') {
      this.dyeAt = this.time;
      return '';
    }
    const number = Number(text);
    if (a === 'artery_pressure' && b === 'set_systolic') {
      if (!(number >= 60 && number <= 220)) return `systolic: ${text} is outside 60 to 220`;
      this.systolic = number;
      return '';
    }
    if (a === 'artery_pressure' && b === 'set_heart_rate') {
      if (!(number >= 40 && number <= 160)) return `heart rate: ${text} is outside 40 to 160`;
      this.rate = number;
      return '';
    }
    if (a === 'adenosine' && b === 'give_adenosine') return '';
    return `"${a}" has no command "${b}"`;
  }

  place(clip) {
    this.free.push(clip);
    this.used[clip] = (this.used[clip] ?? 0) + 1;
    if (this.loaded === clip) this.loaded = null;
    this.say('clip_released', clip, '');
  }

  step(time, dt) {
    this.time = time;
    const due = (name) => this.script[name] !== undefined && time >= this.script[name];
    if (due('rupture') && this.tornAt === null) {
      this.tornAt = this.script.rupture;
      this.say('rupture', 'artery_bleeding', 'The aneurysm has ruptured');
    }
    if (due('dye') && this.dyeAt === null) this.dyeAt = this.script.dye;
    if (due('clip') && this.placedAt === null) {
      this.placedAt = time;
      this.place(this.clips[0]);
    }
    const temporary = this.clips.find((c) => c.includes('temporary'));
    if (due('temporary') && this.temporaryAt === null && temporary) {
      this.temporaryAt = time;
      this.place(temporary);
    }
    this.phase = (this.phase + (dt * this.rate) / 60) % 1;
    this.pulse =
      this.phase < 0.15 ? Math.sin((this.phase / 0.15) * Math.PI * 0.5) : Math.exp(-(this.phase - 0.15) * 3.2);
    const openNeck = this.placedAt === null ? 1 : 0.02;
    const openParent = this.temporaryAt === null ? 1 : 0.04;
    this.tension = this.placedAt === null ? 1 : Math.exp(-(time - this.placedAt) / 3);
    this.bleed =
      this.tornAt === null ? 0 : (42 * openNeck * openParent * (0.7 + 0.6 * this.pulse) * this.systolic) / 120;
    const suction = this.height > 0.001 ? 22 : 0;
    this.lost += (this.bleed / 60) * dt;
    // A bowl with a rim: more runs off.
    this.height = Math.min(0.01, Math.max(0, this.height + (((this.bleed - suction) / 60) * dt * 1e-6) / 4.5e-4));
    this.flow = {
      parent: 140 * openParent * (1 + 0.02 * Math.sin(time)),
      superior: 62 * openParent,
      inferior: 78 * openParent * (this.placedAt === null ? 1 : 0.62),
      sac: 30 * openNeck * openParent,
    };
  }

  /** Dye in a branch: comes late, reaches so much, is washed out. */
  dye(id) {
    const since = this.dyeAt === null ? -1 : this.time - this.dyeAt;
    const delay = { parent: 0.3, superior: 1.0, inferior: 1.3, sac: 1.6 }[id];
    if (since < delay) return 0;
    const reach = this.placedAt === null ? 1 : id === 'sac' ? 0.02 : id === 'inferior' ? 0.8 : 1;
    return reach * (1 - Math.exp(-(since - delay) * 1.6)) * Math.exp(-Math.max(0, since - 14) / 9);
  }

  /** SI, by branch. */
  branch(id) {
    const sealed = this.placedAt !== null;
    const arterial = (80 + (this.systolic - 80) * this.pulse) * 133.322;
    return {
      pressure: id === 'sac' && sealed ? arterial * this.tension : arterial * (id === 'parent' ? 1 : 0.97),
      flow: (this.flow[id] * 1e-6) / 60,
      share: this.flow[id] / flowAtRest[id],
      dye: this.dye(id),
    };
  }

  /** How the hands work. */
  metrics() {
    const of = (hand, value) => ({ id: 'path_length', text: 'Path of the hand', hand, value, unit: 'mm', digits: 0 });
    const both = { id: 'tip_separation', text: 'Mean distance of the two tips', hand: 'both', unit: 'mm', digits: 1 };
    return [
      { ...of('left', this.time * 3), better: 'low' },
      { ...of('right', this.time * 8), better: 'low' },
      { ...both, value: 21.5, better: 'none' },
    ];
  }

  /** Of hud_json: what the exercise and the hands say. */
  hud() {
    const timers = [
      {
        id: 'temporary',
        text: 'Temporary clip',
        elapsed_s: this.temporaryAt === null ? 0 : this.time - this.temporaryAt + (this.script.temporary_for ?? 0),
        limit_s: 180,
        running: this.temporaryAt !== null,
      },
      {
        id: 'rupture',
        text: 'Rupture to clip',
        elapsed_s: this.tornAt === null ? 0 : (this.placedAt ?? this.time) - this.tornAt,
        limit_s: 300,
        running: this.tornAt !== null && this.placedAt === null,
      },
    ];
    const measures = [
      { id: 'remnant', text: 'Neck remnant', value: 1, unit: 'grade', good: 1 },
      { id: 'stenosis_superior', text: 'Stenosis, superior branch', value: 4, unit: '%', good: 1 },
      { id: 'stenosis_inferior', text: 'Stenosis, inferior branch', value: 29, unit: '%', good: 0 },
    ];
    const hands = Object.entries(this.inHand).map(([hand, tool]) => ({ hand, tool }));
    return { timers, measures: this.placedAt === null ? [] : measures, hands };
  }
}
