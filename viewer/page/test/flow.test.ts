// SPDX-License-Identifier: GPL-3.0-or-later
// Regions of walls, timers, commands, what the instructor's page makes of declarations, HUD text.
import { describe, expect, it } from 'vitest';
import {
  ask,
  exchange,
  glowCommands,
  longestArgumentBytes,
  message,
  numberArgument,
  sceneCommands,
  surgeonRequests,
  takesNumber,
  toolCommands,
} from '../src/hud/commands';
import { niceRange, niceTop } from '../src/hud/curves';
import { label, stepOf, unitOf } from '../src/hud/command_number';
import { valueText } from '../src/hud/progress';
import { metricRows, metricText } from '../src/hud/metric_table';
import { parseMetrics } from '../src/hud/metrics';
import { clockText, parseHud } from '../src/hud/state';
import { timeLeftText, urgency, usedShare } from '../src/hud/timers';
import { toolBadge, toolFacts } from '../src/hud/tool_list';
import { toolInHand } from '../src/hand_tool';
import { drawnSurfaces, nearestKnown, thinness, wallThinness } from '../src/regions';
import type { Bundle, ToolData } from '../src/bundle_types';
import * as lcm from '../src/lcm';

describe('regions', () => {
  const regions = ['parent', 'superior', 'neck', 'sac', 'bleb', 'ends'];

  it('take the value of the nearest region that has one, however far from it', () => {
    // A strip 0-1-2-3-4: 0 is parent, the rest ends.
    const strip = Uint32Array.from([0, 1, 2, 1, 2, 3, 2, 3, 4]);
    const known = regions.map((r) => ['parent', 'superior', 'sac'].includes(r));
    expect([...nearestKnown(Uint32Array.from([0, 5, 5, 5, 5]), strip, known)]).toEqual([0, 0, 0, 0, 0]);
    expect([...nearestKnown(Uint32Array.from([0, 2, 2, 4, 3]), strip, known)].slice(3)).toEqual([3, 3]);
    expect([...nearestKnown(Uint32Array.from([5, 5, 5]), Uint32Array.from([0, 1, 2]), known)]).toEqual([5, 5, 5]);
    expect([...nearestKnown(Uint32Array.from([1, 2]), Uint32Array.from([]), [])]).toEqual([1, 2]);
    // An island without a neighbour stays, and the search ends.
    expect([...nearestKnown(Uint32Array.from([0, 5]), Uint32Array.from([]), known)]).toEqual([0, 5]);
  });

  it('look thin from half of the greatest thickness on, thick where nothing is said, smooth between', () => {
    expect([thinness(1, 1), thinness(0.5, 1), thinness(0.1, 1)]).toEqual([0, 1, 1]);
    expect(thinness(0.75, 1)).toBeCloseTo(0.5, 12);
    const strip = Uint32Array.from([0, 1, 2, 1, 2, 3, 2, 3, 4]);
    const thickness = { neck: 0.00025, sac: 0.0002, bleb: 0.0001, superior: 0.0003 };
    const t = wallThinness(Uint32Array.from([0, 0, 2, 3, 4]), regions, thickness, strip);
    for (let i = 1; i < 5; i++) expect(t[i]!).toBeGreaterThan(t[i - 1]!);
    for (const listed of [thickness, {}])
      expect([...wallThinness(Uint32Array.from([0, 0, 0]), regions, listed, Uint32Array.from([0, 1, 2]))]).toEqual([
        0, 0, 0,
      ]);
  });
});

describe('surfaces of a wall', () => {
  const surface = (id: string, material: string, wall: string[], vertices: number) => ({
    id,
    material,
    regions: wall,
    positions: new Float32Array(3 * vertices),
  });
  const ids = (list: { id: string }[]) => list.map((s) => s.id);

  it('draws the finest of those that show the same wall', () => {
    const coarse = surface('wall', 'vessel', ['parent', 'sac'], 100);
    const fine = surface('picture', 'vessel', ['parent', 'sac'], 400);
    expect(ids(drawnSurfaces([coarse, fine]))).toEqual(['picture']);
    expect(ids(drawnSurfaces([fine, coarse]))).toEqual(['picture']);
    expect(ids(drawnSurfaces([coarse]))).toEqual(['wall']);
    expect(ids(drawnSurfaces([coarse, { ...coarse, id: 'again' }]))).toEqual(['wall']);
  });

  it('keeps what shows something else', () => {
    const a = surface('a', 'cortex', [], 10);
    const b = surface('b', 'cortex', [], 20);
    const c = surface('c', 'vessel', ['parent'], 5);
    const d = surface('d', 'vessel', ['parent', 'sac'], 6);
    expect(ids(drawnSurfaces([a, b, c, d]))).toEqual(['a', 'b', 'c', 'd']);
  });
});

describe('timers', () => {
  const at = (elapsedS: number, limitS = 180) => ({ elapsedS: elapsedS, limitS: limitS });
  it('count down in minutes and seconds, rounded up, and past the end', () => {
    expect([0, 0.4, 60, 119.5, 179.9, 180, 180.4, 245].map((t) => timeLeftText(at(t)))).toEqual([
      '3:00',
      '3:00',
      '2:00',
      '1:01',
      '0:01',
      '0:00',
      '+0:00',
      '+1:05',
    ]);
    expect(timeLeftText(at(75.9, 0))).toBe('1:15');
  });
  it('press at two thirds and at nine tenths', () => {
    expect([0, 119, 121, 161, 163, 400].map((t) => urgency(at(t)))).toEqual([
      'calm',
      'calm',
      'soon',
      'soon',
      'over',
      'over',
    ]);
    expect(urgency(at(1000, 0))).toBe('calm');
    expect([usedShare(at(90)), usedShare(at(500)), usedShare(at(5, 0))]).toEqual([0.5, 1, 0]);
  });
  it('never shows sixty seconds', () => {
    expect([59.97, 119.96, 3599.99].map(clockText)).toEqual(['1:00.0', '2:00.0', '60:00.0']);
  });
});

describe('commands', () => {
  const systolic = {
    name: 'set_systolic',
    doc: '',
    argument: 'pressure_mmHg',
    min: 60,
    max: 220,
    start: 120,
    usual: null,
  };
  it('read as the engine reads them', () => {
    expect(exchange('right', 'applier')).toEqual({ command: 'exchange', argument: 'right applier' });
    expect(ask('applier', 'load', 'clip_mini')).toEqual({ command: 'ask', argument: 'applier load clip_mini' });
    expect(ask('bleeding', 'rupture')).toEqual({ command: 'ask', argument: 'bleeding rupture' });
    expect(ask('a', 'b', '  two words ')).toEqual({ command: 'ask', argument: 'a b two words' });
  });
  it('of the surgeon are those with a usual number', () => {
    const dose = { name: 'give_adenosine', doc: '', argument: 'dose_mg', min: 1, max: 120, start: null, usual: 25 };
    const commands = [
      { id: 'heart', element: 'pressure', commands: [systolic] },
      { id: 'adenosine', element: 'adenosine_pause', commands: [dose, { ...dose, name: 'other', usual: null }] },
      { id: 'brain', element: 'brain_relaxation', commands: [{ ...dose, name: 'give_mannitol', usual: 0 }] },
    ];
    expect(surgeonRequests({ commands } as unknown as Bundle).map((r) => [r.id, r.command.name, r.usual])).toEqual([
      ['adenosine', 'give_adenosine', 25],
      ['brain', 'give_mannitol', 0],
    ]);
    expect([unitOf(dose), stepOf(dose)]).toEqual(['mg', 1]);
  });
  it('keep numbers inside their range and plain', () => {
    expect([80, 1e9, -5, NaN, 120.1234567].map((v) => numberArgument(v, systolic))).toEqual([
      '80',
      '220',
      '60',
      '60',
      '120.123457',
    ]);
    expect(numberArgument(1e-5, { ...systolic, min: 0, max: 1 })).toBe('0.00001');
    expect([takesNumber(systolic), takesNumber({ ...systolic, min: 0, max: 0 })]).toEqual([true, false]);
  });
  it('send messages in one line that fits, whole characters only', () => {
    expect(message('  stop \n now ')).toEqual({ command: 'message', argument: 'stop now' });
    expect(message('   ')).toBeNull();
    const long = message('ä€😀'.repeat(100))!.argument;
    expect(new TextEncoder().encode(long).length).toBeLessThanOrEqual(longestArgumentBytes);
    expect(long).not.toContain('\ufffd');
    expect([...long].every((c) => 'ä€😀'.includes(c))).toBe(true);
  });
  it("of tools take tools of the kind that the argument names; other components are the instructor's", () => {
    const plain = { ...systolic, min: 0, max: 0 };
    const commands = [
      {
        id: 'a',
        element: 'holder',
        commands: [
          { ...plain, name: 'load', argument: 'staple id' },
          { ...plain, name: 'drop', argument: '' },
        ],
      },
      { id: 'flow', element: 'network', commands: [{ ...plain, name: 'colour', argument: '' }, systolic] },
    ];
    const tools = [
      { id: 'a', kind: 'holder', hand: 'right' },
      { id: 's1', kind: 'staple', hand: 'none' },
      { id: 's2', kind: 'pin', hand: 'none' },
    ];
    const bundle = {
      commands,
      tools,
      channels: [{ id: 'flow.shine', component: 'flow' }],
      bodies: [{ channelOfRegion: { left: 'flow.shine' } }],
    } as unknown as Bundle;
    const [offer, ...more] = toolCommands(bundle);
    expect([offer!.holder.id, offer!.command.name, offer!.tools.map((t) => t.id), more]).toEqual([
      'a',
      'load',
      ['s1'],
      [],
    ]);
    expect(sceneCommands(bundle).map((g) => g.id)).toEqual(['flow']);
    expect(glowCommands(bundle).map((g) => `${g.id} ${g.command.name}`)).toEqual(['flow colour']);
    expect(toolCommands({ ...bundle, tools: tools.slice(0, 1) } as unknown as Bundle)).toEqual([]);
  });
});

describe('panels', () => {
  it('label sliders with the unit of their argument', () => {
    const c = { argument: 'pressure_mmHg', min: 60, max: 220 };
    expect([stepOf(c), label(120, c)]).toEqual([1, '120 mmHg']);
    expect(label(0.25, { argument: 'force_N', min: 0, max: 1 })).toBe('0.25 N');
    expect(label(70, { argument: 'rate_per_min', min: 40, max: 160 })).toBe('70 /min');
    expect(label(3, { argument: 'grade', min: 0, max: 100 })).toBe('3');
  });
  it('say which tool may be taken up, and what it is', () => {
    expect(toolBadge(undefined, 1)).toEqual({ text: '', free: true });
    expect(toolBadge({ state: 0, hand: -1 }, 1)).toEqual({ text: '', free: true });
    expect(toolBadge({ state: 2, hand: -1 }, 1)).toEqual({ text: 'in the field', free: false });
    expect(toolBadge({ state: 1, hand: 1 }, 1)).toEqual({ text: 'loaded', free: false });
    expect(toolBadge({ state: 1, hand: 0 }, 1)).toEqual({ text: 'taken', free: false });
    const tool = {
      tags: ['mini'],
      properties: [
        { name: 'a', text: '5 mm' },
        { name: 'b', text: '' },
      ],
    };
    expect(toolFacts(tool as unknown as ToolData)).toBe('mini · 5 mm');
  });
  it('show values and scales that can be read', () => {
    expect([
      valueText(1, ''),
      valueText(28.7, '%'),
      valueText(1.234, 'mm'),
      valueText(0.034, 'N'),
      valueText(NaN, '%'),
    ]).toEqual(['1', '29 %', '1.2 mm', '0.03 N', '–']);
    expect([0, 0.1, 0.3, 0.6, 1.5, 3, 8, 1234].map(niceTop)).toEqual([0, 0.1, 0.5, 1, 2, 5, 10, 2000]);
    expect([niceRange([]), niceRange([0.3]), niceRange([-3, 1])]).toEqual([
      [0, 1],
      [0, 0.5],
      [-5, 1],
    ]);
  });
  it('find the tool a hand holds: not what lies on the tray, not what an instrument holds', () => {
    const bundle = {
      tools: [
        { index: 0, hand: 'right' },
        { index: 1, hand: 'right' },
        { index: 2, hand: 'none' },
      ],
    } as unknown as Bundle;
    const f = lcm.render_frame_t.make();
    f.tool = [2, 0, 1].map((index) =>
      Object.assign(lcm.render_tool_t.make(), { index, hand: 1, state: index === 0 ? 0 : 1 }),
    );
    expect(toolInHand(f, bundle, 1)!.index).toBe(1);
    expect(toolInHand(f, bundle, 0)).toBeNull();
  });
});

describe('hud text', () => {
  it('reads timers, measures, hands', () => {
    const s = parseHud(
      JSON.stringify({
        timers: [{ id: 't', text: 'T', elapsed_s: 3, limit_s: 180, running: true }],
        measures: [{ id: 'm', text: 'M', value: null, unit: '%', good: -1 }],
        hands: [{ hand: 'left', tool: 'suction' }],
      }),
    )!;
    expect(s.timers).toEqual([{ id: 't', text: 'T', elapsedS: 3, limitS: 180, running: true }]);
    expect([s.measures[0]!.good, s.measures[0]!.value, s.hands[0]!.tool]).toEqual([-1, NaN, 'suction']);
  });
  it('reads metrics, a row for each, without what nobody did', () => {
    const metrics = [
      { id: 'path', text: 'Path', hand: 'left', value: 12.34, unit: 'mm', digits: 0, better: 'low' },
      { id: 'path', text: 'Path', hand: 'right', value: null, unit: 'mm', digits: 0, better: 'low' },
      { id: 'time', text: 'Time', hand: 'both', value: 3, unit: 's', digits: 1, better: 'low' },
      { id: 'idle', text: 'Idle', hand: 'both', value: 0, unit: 's', digits: 1, better: 'low' },
    ];
    expect(metricRows(parseMetrics(JSON.stringify(metrics))!)).toEqual([
      { id: 'path', text: 'Path', better: 'less', values: ['12 mm', '–'] },
      { id: 'time', text: 'Time', better: 'less', values: ['3.0 s'] },
    ]);
    expect(metricText({ value: -0.001, digits: 2, unit: '' })).toBe('0.00');
    expect([parseMetrics('{'), parseMetrics('{"a":1}')]).toEqual([null, null]);
    expect(parseMetrics('[null,{"value":"x","hand":"third","digits":99}]')).toMatchObject([
      { hand: 'both', value: NaN, digits: 6 },
    ]);
  });
  it('bears nonsense in each of them', () => {
    const s = parseHud('{"timers":[null],"measures":{},"hands":"no"}')!;
    expect([s.timers, s.measures, s.hands]).toEqual([[], [], []]);
  });
});
