// SPDX-License-Identifier: GPL-3.0-or-later
// What the mock's engine would know beside geometry: tools in hands, clips, pulse, blood, dye, timers; it obeys commands and
// says what happened. All made up.

export const hand_tools = { left: ['left_suction'], right: ['right_dissector', 'right_clip_applier'] };

export const commands = [
  { id: 'right_clip_applier', element: 'clip_applier', commands: [
    { name: 'load', doc: 'puts a clip from the tray into the applier', argument: 'clip', min: 0, max: 0 }, { name: 'release', doc: 'lets the clip go', argument: '', min: 0, max: 0 }] },
  { id: 'artery_pressure', element: 'pressure', commands: [
    { name: 'set_systolic', doc: 'systolic pressure', argument: 'pressure_mmHg', min: 60, max: 220 }, { name: 'set_heart_rate', doc: 'heart rate', argument: 'rate_per_min', min: 40, max: 160 }] },
  { id: 'artery_flow', element: 'blood_flow', commands: [{ name: 'inject_dye', doc: 'gives a bolus of indocyanine green', argument: '', min: 0, max: 0 }] },
  { id: 'artery_bleeding', element: 'bleeding', commands: [{ name: 'rupture', doc: 'tears the bleb', argument: '', min: 0, max: 0 }] },
];

/** clips: ids. script: {rupture, dye, clip, temporary}: simulated seconds at which these happen by themselves. */
export class Theatre {
  constructor(clips, script = {}) {
    this.clips = clips;
    this.script = script;
    this.said = [];
    this.reset();
  }

  reset() {
    this.in_hand = { left: 'left_suction', right: 'right_dissector' };
    this.loaded = null;
    this.free = [];
    this.used = {};
    this.torn_at = this.dye_at = this.placed_at = this.temporary_at = null;
    this.systolic = 120;
    this.rate = 70;
    this.height = 0;
    this.lost = 0;
    this.time = 0;
    this.phase = 0;
  }

  say(kind, id, text) { this.said.push({ kind, id, text }); }

  run(command, argument) {
    const why = this.try_run(command, argument);
    if (why) this.say('refused', command, why);
    else this.say(command === 'message' ? 'message' : 'command', command, argument);
  }

  try_run(command, argument) {
    const [a, b, ...rest] = argument.split(' ');
    if (command === 'message') return argument ? '' : 'a message needs text';
    if (command === 'exchange') {
      if (!hand_tools[a]?.includes(b)) return `no tool "${b}" for the ${a} hand`;
      if (this.in_hand[a] === 'right_clip_applier' && this.loaded && b !== this.in_hand[a]) this.loaded = null;
      this.in_hand[a] = b;
      return '';
    }
    if (command !== 'ask') return `unknown command "${command}"`;
    const text = rest.join(' ');
    if (a === 'right_clip_applier' && b === 'load') {
      if (!this.clips.includes(text)) return `no clip "${text}"`;
      if (this.free.includes(text)) return `"${text}" is in the field`;
      this.loaded = text;
      this.say('clip_loaded', text, '');
      return '';
    }
    if (a === 'artery_bleeding' && b === 'rupture') { if (this.torn_at === null) { this.torn_at = this.time; this.say('rupture', a, 'The aneurysm has ruptured'); } return ''; }
    if (a === 'artery_flow' && b === 'inject_dye') { this.dye_at = this.time; return ''; }
    const number = Number(text);
    if (a === 'artery_pressure' && b === 'set_systolic') { if (!(number >= 60 && number <= 220)) return `systolic: ${text} is outside 60 to 220`; this.systolic = number; return ''; }
    if (a === 'artery_pressure' && b === 'set_heart_rate') { if (!(number >= 40 && number <= 160)) return `heart rate: ${text} is outside 40 to 160`; this.rate = number; return ''; }
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
    if (due('rupture') && this.torn_at === null) { this.torn_at = this.script.rupture; this.say('rupture', 'artery_bleeding', 'The aneurysm has ruptured'); }
    if (due('dye') && this.dye_at === null) this.dye_at = this.script.dye;
    if (due('clip') && this.placed_at === null) { this.placed_at = time; this.place(this.clips[0]); }
    const temporary = this.clips.find((c) => c.includes('temporary'));
    if (due('temporary') && this.temporary_at === null && temporary) { this.temporary_at = time; this.place(temporary); }
    this.phase = (this.phase + (dt * this.rate) / 60) % 1;
    this.pulse = this.phase < 0.15 ? Math.sin((this.phase / 0.15) * Math.PI * 0.5) : Math.exp(-(this.phase - 0.15) * 3.2);
    const open_neck = this.placed_at === null ? 1 : 0.02, open_parent = this.temporary_at === null ? 1 : 0.04;
    this.tension = this.placed_at === null ? 1 : Math.exp(-(time - this.placed_at) / 3);
    this.bleed = this.torn_at === null ? 0 : 42 * open_neck * open_parent * (0.7 + 0.6 * this.pulse) * this.systolic / 120;
    const suction = this.height > 0.001 ? 22 : 0;
    this.lost += (this.bleed / 60) * dt;
    // A bowl with a rim: more runs off.
    this.height = Math.min(0.010, Math.max(0, this.height + ((this.bleed - suction) / 60) * dt * 1e-6 / 4.5e-4));
    this.flow = { parent: 140 * open_parent * (1 + 0.02 * Math.sin(time)), superior: 62 * open_parent, inferior: 78 * open_parent * (this.placed_at === null ? 1 : 0.62), sac: 30 * open_neck * open_parent };
  }

  hud(origin, up) {
    const since = this.dye_at === null ? -1 : this.time - this.dye_at;
    const dye = (delay, reach) => (since < delay ? 0 : reach * (1 - Math.exp(-(since - delay) * 1.6)) * Math.exp(-Math.max(0, since - 14) / 9));
    const rest = { parent: 140, superior: 62, inferior: 78, sac: 30 };
    const arterial = 80 + (this.systolic - 80) * this.pulse;
    const sealed = this.placed_at !== null;
    const vessels = Object.keys(rest).map((id) => ({ id, pressure_mmHg: id === 'sac' && sealed ? arterial * this.tension : arterial * (id === 'parent' ? 1 : 0.97), flow_mL_min: this.flow[id],
      flow_percent: 100 * this.flow[id] / rest[id], lumen_percent: id === 'inferior' && sealed ? 71 : id === 'sac' && sealed ? 0 : 100,
      dye: dye({ parent: 0.3, superior: 1.0, inferior: 1.3, sac: 1.6 }[id], id === 'sac' && sealed ? 0.02 : id === 'inferior' && sealed ? 0.8 : 1) }));
    const timers = [
      { id: 'temporary', text: 'Temporary clip', elapsed_s: this.temporary_at === null ? 0 : this.time - this.temporary_at + (this.script.temporary_for ?? 0), limit_s: 180, running: this.temporary_at !== null },
      { id: 'rupture', text: 'Rupture to clip', elapsed_s: this.torn_at === null ? 0 : (this.placed_at ?? this.time) - this.torn_at, limit_s: 300, running: this.torn_at !== null && this.placed_at === null },
    ];
    return {
      heart_phase: this.phase, vessels, timers,
      blood: { open: this.torn_at !== null && this.bleed > 1, rate_mL_min: this.bleed, lost_mL: this.lost, height_m: this.height, origin, up, radius_m: 0.016, since_s: this.torn_at === null ? null : this.time - this.torn_at },
      clips: this.clips.map((id) => ({ id, state: this.free.includes(id) ? 'free' : this.loaded === id ? 'held' : 'tray', holder: this.loaded === id ? 'right_clip_applier' : null,
        opening_rad: 0, force_N: 1.2, applications: this.used[id] ?? 0, temporary: id.includes('temporary') })),
      measures: sealed ? [{ id: 'remnant', text: 'Neck remnant', value: 1, unit: 'grade', good: 1 }, { id: 'stenosis_superior', text: 'Stenosis, superior branch', value: 4, unit: '%', good: 1 },
        { id: 'stenosis_inferior', text: 'Stenosis, inferior branch', value: 29, unit: '%', good: 0 }] : [],
      hands: Object.entries(this.in_hand).map(([hand, tool]) => ({ hand, tool })),
    };
  }
}
