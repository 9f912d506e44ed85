// SPDX-License-Identifier: GPL-3.0-or-later
// What the engine's tutor says, how long a cue is shown, and what the browser keeps of the choice.
import { describe, expect, it } from 'vitest';
import { catalogue } from '../scripts/texts.mjs';
import { parseHud } from '../src/hud/state';
import { setLanguage } from '../src/languages/text';
import { readCueChoice, writeCueChoice } from '../src/tutor/choice';
import { whyText } from '../src/tutor/cue_line';
import { isFresh, shownS } from '../src/tutor/tutor';
import { parseTutor } from '../src/tutor/state';

const said = { id: 'ease_off', text: 'Ease off', hand: 'right', watched: 'a.b', value: '160 mN', limit: '200 mN' };

describe('what the tutor says', () => {
  it('is read from the state beside the picture', () => {
    const cue = { ...said, share: 0.8, holds: true, time_s: 12.5 };
    const tutor = parseHud(JSON.stringify({ tutor: { cue, causes: [said], cues: [cue] } }))!.tutor;
    expect(tutor.cue).toEqual({ ...said, hand: 1, share: 0.8, holds: true, timeS: 12.5 });
    expect(tutor.causes).toHaveLength(1);
    expect(tutor.cues[0]!.timeS).toBe(12.5);
  });

  it('says which hand a soft force draws', () => {
    expect(parseTutor({ soft_guide: true, guided: 'left' })).toMatchObject({ softGuide: true, guided: 0 });
    expect(parseTutor({ soft_guide: 'yes', guided: 2 })).toMatchObject({ softGuide: false, guided: -1 });
  });

  it('may be missing or anything', () => {
    for (const v of [undefined, null, 7, [], { cue: 3, causes: 'x', cues: [null, { text: 5 }] }])
      expect(parseTutor(v)).toEqual({ cue: null, causes: [], cues: [], softGuide: false, guided: -1 });
    expect(parseTutor({ cue: { text: 'T', hand: 'third', share: 'much' } }).cue).toMatchObject({ hand: -1, share: 0 });
  });
});

describe('a cue', () => {
  it('says in words what came near its limit', () => {
    const near = { watched: 'vessel_force.right.force', value: '160 mN', limit: '200 mN' };
    expect(whyText(near)).toBe('vessel force, right, force: 160 mN, limit 200 mN');
    expect(whyText({ ...near, watched: 'force_mean right' })).toContain('force mean, right:');
    setLanguage('de', catalogue('de'));
    expect(whyText(near)).toContain('Kraft auf das Gefäß, rechts, Kraft: 160 mN');
    setLanguage('en', {});
  });

  it('is shown for a few seconds of simulated time', () => {
    expect(isFresh({ timeS: 10 }, 10)).toBe(true);
    expect(isFresh({ timeS: 10 }, 10 + shownS - 0.1)).toBe(true);
    expect(isFresh({ timeS: 10 }, 10 + shownS)).toBe(false);
    expect(isFresh({ timeS: 10 }, 2)).toBe(false);
    expect(isFresh({ timeS: null }, 2)).toBe(false);
  });

  it('is given as the browser keeps it', () => {
    const kept = new Map<string, string>();
    const store = { getItem: (k: string) => kept.get(k) ?? null, setItem: (k: string, v: string) => kept.set(k, v) };
    expect(readCueChoice(store)).toEqual({ words: true, arrow: true });
    writeCueChoice(store, { words: false, arrow: true });
    expect(readCueChoice(store)).toEqual({ words: false, arrow: true });
    for (const broken of ['{', '7', '{"words":"no"}', 'null']) {
      kept.set('insula.tutor', broken);
      expect(readCueChoice(store)).toEqual({ words: true, arrow: true });
    }
    expect(readCueChoice(null)).toEqual({ words: true, arrow: true });
  });
});
