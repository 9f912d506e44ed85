// SPDX-License-Identifier: GPL-3.0-or-later
// Regions and their dye, timers, commands, what the instructor's page makes of declarations, extended HUD text.
import { describe, expect, it } from 'vitest';
import { clip_badge, clip_facts } from '../src/hud/clips';
import { appliers, ask, exchange, find_command, longest_argument_bytes, message, number_argument, takes_number } from '../src/hud/commands';
import { nice_top } from '../src/hud/curves';
import { label, step_of } from '../src/hud/instructor';
import { value_text } from '../src/hud/progress';
import { clock_text, parse_hud } from '../src/hud/state';
import { time_left_text, urgency, used_share } from '../src/hud/timers';
import { flow_level, whole } from '../src/hud/vitals';
import { tool_in_hand } from '../src/hand_tool';
import { absorb_region, drawn_surfaces, region_dye, region_vessels, wall_thinness } from '../src/regions';
import type { Bundle, ToolData } from '../src/bundle';
import * as lcm from '../src/lcm';

describe('regions', () => {
  const regions = ['parent', 'superior', 'neck', 'sac', 'bleb', 'ends'];

  it('take the dye of their own vessel, else of the nearest that is measured', () => {
    const vessels = [{ id: 'sac', dye: 0.5 }, { id: 'parent', dye: 0.9 }, { id: 'superior', dye: 0.25 }];
    expect(region_vessels(regions, vessels.map((v) => v.id))).toEqual(['parent', 'superior', 'parent', 'sac', 'sac', null]);
    expect(region_dye(regions, vessels)).toEqual([0.9, 0.25, 0.9, 0.5, 0.5, 0]);
  });

  it('bear dye out of range and no vessels at all', () => {
    expect(region_dye(['parent'], [{ id: 'parent', dye: 7 }])).toEqual([1]);
    expect(region_dye(['parent'], [{ id: 'parent', dye: -1 }])).toEqual([0]);
    expect(region_dye(regions, [])).toEqual([0, 0, 0, 0, 0, 0]);
  });

  it('give ends to the vessel they close, however far from it', () => {
    // A strip 0-1-2-3-4: 0 is parent, the rest ends.
    const strip = Uint32Array.from([0, 1, 2, 1, 2, 3, 2, 3, 4]);
    expect([...absorb_region(Uint32Array.from([0, 5, 5, 5, 5]), strip, 5)]).toEqual([0, 0, 0, 0, 0]);
    expect([...absorb_region(Uint32Array.from([5, 5, 5]), Uint32Array.from([0, 1, 2]), 5)]).toEqual([5, 5, 5]);
    expect([...absorb_region(Uint32Array.from([1, 2]), Uint32Array.from([]), -1)]).toEqual([1, 2]);
    // An island of ends without a neighbour stays, and the search ends.
    expect([...absorb_region(Uint32Array.from([0, 5]), Uint32Array.from([]), 5)]).toEqual([0, 5]);
  });

  it('are thin at the bleb, thick at the parent, smooth between', () => {
    const strip = Uint32Array.from([0, 1, 2, 1, 2, 3, 2, 3, 4]);
    const t = wall_thinness(Uint32Array.from([0, 0, 2, 3, 4]), regions, strip);
    for (let i = 1; i < 5; i++) expect(t[i]!).toBeGreaterThan(t[i - 1]!);
    expect(wall_thinness(Uint32Array.from([0, 0, 0]), regions, Uint32Array.from([0, 1, 2]))).toEqual(Float32Array.from([0, 0, 0]));
  });
});

describe('surfaces of a wall', () => {
  const surface = (id: string, material: string, wall: string[], vertices: number) => ({ id, material, regions: wall, positions: new Float32Array(3 * vertices) });
  const ids = (list: { id: string }[]) => list.map((s) => s.id);

  it('draws the finest of those that show the same wall', () => {
    const coarse = surface('wall', 'vessel', ['parent', 'sac'], 100), fine = surface('picture', 'vessel', ['parent', 'sac'], 400);
    expect(ids(drawn_surfaces([coarse, fine]))).toEqual(['picture']);
    expect(ids(drawn_surfaces([fine, coarse]))).toEqual(['picture']);
    expect(ids(drawn_surfaces([coarse]))).toEqual(['wall']);
    expect(ids(drawn_surfaces([coarse, { ...coarse, id: 'again' }]))).toEqual(['wall']);
  });

  it('keeps what shows something else', () => {
    const a = surface('a', 'cortex', [], 10), b = surface('b', 'cortex', [], 20), c = surface('c', 'vessel', ['parent'], 5), d = surface('d', 'vessel', ['parent', 'sac'], 6);
    expect(ids(drawn_surfaces([a, b, c, d]))).toEqual(['a', 'b', 'c', 'd']);
  });
});

describe('timers', () => {
  const at = (elapsed_s: number, limit_s = 180) => ({ elapsed_s, limit_s });
  it('count down in minutes and seconds, rounded up, and past the end', () => {
    expect([0, 0.4, 60, 119.5, 179.9, 180, 180.4, 245].map((t) => time_left_text(at(t)))).toEqual(['3:00', '3:00', '2:00', '1:01', '0:01', '0:00', '+0:00', '+1:05']);
    expect(time_left_text(at(75.9, 0))).toBe('1:15');
  });
  it('press at two thirds and at nine tenths', () => {
    expect([0, 119, 121, 161, 163, 400].map((t) => urgency(at(t)))).toEqual(['calm', 'calm', 'soon', 'soon', 'over', 'over']);
    expect(urgency(at(1000, 0))).toBe('calm');
    expect([used_share(at(90)), used_share(at(500)), used_share(at(5, 0))]).toEqual([0.5, 1, 0]);
  });
  it('never shows sixty seconds', () => {
    expect([59.97, 119.96, 3599.99].map(clock_text)).toEqual(['1:00.0', '2:00.0', '60:00.0']);
  });
});

describe('commands', () => {
  const systolic = { name: 'set_systolic', doc: '', argument: 'pressure_mmHg', min: 60, max: 220 };
  it('read as the engine reads them', () => {
    expect(exchange('right', 'applier')).toEqual({ command: 'exchange', argument: 'right applier' });
    expect(ask('applier', 'load', 'clip_mini')).toEqual({ command: 'ask', argument: 'applier load clip_mini' });
    expect(ask('bleeding', 'rupture')).toEqual({ command: 'ask', argument: 'bleeding rupture' });
    expect(ask('a', 'b', '  two words ')).toEqual({ command: 'ask', argument: 'a b two words' });
  });
  it('keep numbers inside their range and plain', () => {
    expect([80, 1e9, -5, NaN, 120.1234567].map((v) => number_argument(v, systolic))).toEqual(['80', '220', '60', '60', '120.123457']);
    expect(number_argument(1e-5, { ...systolic, min: 0, max: 1 })).toBe('0.00001');
    expect([takes_number(systolic), takes_number({ ...systolic, min: 0, max: 0 })]).toEqual([true, false]);
  });
  it('send messages in one line that fits, whole characters only', () => {
    expect(message('  stop \n now ')).toEqual({ command: 'message', argument: 'stop now' });
    expect(message('   ')).toBeNull();
    const long = message('ä€😀'.repeat(100))!.argument;
    expect(new TextEncoder().encode(long).length).toBeLessThanOrEqual(longest_argument_bytes);
    expect(long).not.toContain('\ufffd');
    expect([...long].every((c) => 'ä€😀'.includes(c))).toBe(true);
  });
  it('are found by name, and appliers by what they offer', () => {
    const commands = [{ id: 'a', element: 'clip_applier', commands: [{ ...systolic, name: 'load' }] }, { id: 'flow', element: 'blood_flow', commands: [{ ...systolic, name: 'inject_dye' }] }];
    expect(find_command(commands, 'inject_dye')!.id).toBe('flow');
    expect(find_command(commands, 'fly')).toBeNull();
    const bundle = { commands, tools: [{ id: 'a' }, { id: 'b' }] } as unknown as Bundle;
    expect(appliers(bundle).map((t) => t.id)).toEqual(['a']);
  });
});

describe('panels', () => {
  it('label sliders with the unit of their argument', () => {
    const c = { argument: 'pressure_mmHg', min: 60, max: 220 };
    expect([step_of(c), label(120, c)]).toEqual([1, '120 mmHg']);
    expect(label(0.25, { argument: 'force_N', min: 0, max: 1 })).toBe('0.25 N');
    expect(label(70, { argument: 'rate_per_min', min: 40, max: 160 })).toBe('70 /min');
    expect(label(3, { argument: 'grade', min: 0, max: 100 })).toBe('3');
  });
  it('say which clip may be loaded', () => {
    const clip = (state: 'tray' | 'held' | 'free', holder = '', applications = 0) => ({ id: 'c', state, holder, force_N: 1, applications, temporary: false });
    expect(clip_badge(undefined, 'a')).toEqual({ text: '', may_load: true });
    expect(clip_badge(clip('tray', '', 2), 'a')).toEqual({ text: 'used 2×', may_load: true });
    expect(clip_badge(clip('free'), 'a')).toEqual({ text: 'in the field', may_load: false });
    expect(clip_badge(clip('held', 'a'), 'a').text).toBe('loaded');
    expect(clip_badge(clip('held', 'b'), 'a')).toEqual({ text: 'taken', may_load: false });
    expect(clip_facts({ clip: { kind: 'mini', blade_length_m: 0.005, closing_force_N: 1.2 } } as ToolData)).toBe('mini · 5 mm · 1.2 N');
  });
  it('show values and scales that can be read', () => {
    expect([value_text(1, ''), value_text(28.7, '%'), value_text(1.234, 'mm'), value_text(0.034, 'N'), value_text(NaN, '%')]).toEqual(['1', '29 %', '1.2 mm', '0.03 N', '–']);
    expect([0.1, 0.3, 0.6, 1.5, 3, 8].map(nice_top)).toEqual([0.2, 0.5, 1, 2, 5, 10]);
    expect(['parent', 'parent', 'parent', 'sac'].map((id, i) => flow_level({ id, flow_percent: [95, 60, 20, 0][i]! }))).toEqual(['good', 'high', 'too_much', 'none']);
  });
  it('find the tool a hand holds: not what lies on the tray, not the clip in an applier', () => {
    const bundle = { tools: [{ index: 0, hand: 'right', clip: null }, { index: 1, hand: 'right', clip: null }, { index: 2, hand: 'none', clip: {} }] } as unknown as Bundle;
    const f = lcm.render_frame_t.make();
    f.tool = [2, 0, 1].map((index) => Object.assign(lcm.render_tool_t.make(), { index, hand: 1, state: index === 0 ? 0 : 1 }));
    expect(tool_in_hand(f, bundle, 1)!.index).toBe(1);
    expect(tool_in_hand(f, bundle, 0)).toBeNull();
  });
});

describe('monitor', () => {
  it('shows whole numbers and no minus before zero', () => {
    expect([whole(103.6), whole(-0.3), whole(-1.6), whole(0)]).toEqual(['104', '0', '-2', '0']);
  });
});

describe('hud text of a vessel', () => {
  it('reads vessels, blood, clips, timers, measures, hands', () => {
    const s = parse_hud(JSON.stringify({
      heart_phase: 0.25, vessels: [{ id: 'parent', pressure_mmHg: 98, flow_mL_min: 120, flow_percent: null, lumen_percent: 90, dye: 0.5 }],
      blood: { open: true, rate_mL_min: 30, lost_mL: 2, height_m: 0.004, origin: [1, 2, 3], up: [0, 0, 1], radius_m: 0.015, since_s: 4 },
      clips: [{ id: 'c', state: 'free', holder: null, opening_rad: 0, force_N: 1.5, applications: 1, temporary: true }],
      timers: [{ id: 't', text: 'T', elapsed_s: 3, limit_s: 180, running: true }], measures: [{ id: 'm', text: 'M', value: null, unit: '%', good: -1 }], hands: [{ hand: 'left', tool: 'suction' }],
    }))!;
    expect(s.vessels[0]).toEqual({ id: 'parent', pressure_mmHg: 98, flow_mL_min: 120, flow_percent: null, lumen_percent: 90, dye: 0.5 });
    expect(s.blood).toEqual({ open: true, rate_mL_min: 30, lost_mL: 2, height_m: 0.004, origin: [1, 2, 3], up: [0, 0, 1], radius_m: 0.015 });
    expect(s.clips[0]).toEqual({ id: 'c', state: 'free', holder: '', force_N: 1.5, applications: 1, temporary: true });
    expect([s.timers[0]!.running, s.measures[0]!.good, s.measures[0]!.value, s.hands[0]!.tool, s.heart_phase]).toEqual([true, -1, NaN, 'suction', 0.25]);
  });
  it('bears nonsense in each of them', () => {
    const s = parse_hud('{"vessels":7,"blood":{"origin":[1,2],"up":[0,0,0]},"clips":[{"state":"flying"}],"timers":[null],"measures":{},"hands":"no","heart_phase":"fast"}')!;
    expect([s.vessels, s.blood, s.timers, s.measures, s.hands, s.heart_phase]).toEqual([[], null, [], [], [], null]);
    expect(s.clips[0]!.state).toBe('tray');
  });
});
