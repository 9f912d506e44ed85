// SPDX-License-Identifier: GPL-3.0-or-later
// Shows the cues of the engine's tutor to the trainee: words, an arrow at the tool, a sound, as chosen. Each cue is
// shown for a few seconds of simulated time. The engine sends no cue in a test.
import type { Sight } from '../camera';
import { toolInHand } from '../hand_tool';
import { browserStore } from '../browser_store';
import type { Bundle } from '../bundle_types';
import type { RenderFrame } from '../lcm';
import { vector } from '../world';
import { type CueChoice, readCueChoice, writeCueChoice } from './choice';
import { CueLine } from './cue_line';
import type { HintView, TutorView } from './state';
import { ToolArrow } from './tool_arrow';

/** For which a cue is shown, simulated s. */
export const shownS = 6;

export interface TutorInput {
  frame: RenderFrame | null;
  bundle: Bundle | null;
  tutor: TutorView | null;
  sight: Sight;
  nowMs: number;
}

export class TutorCues {
  readonly line = new CueLine();
  readonly arrow = new ToolArrow();
  choice: CueChoice = readCueChoice(browserStore());
  /** The cue that is shown; null: none. */
  shown: HintView | null = null;
  private lastTimeS = -1;

  /** sound: called once for each cue. */
  constructor(private readonly sound: (nowMs: number) => void) {}

  choose(change: Partial<CueChoice>): void {
    this.choice = { ...this.choice, ...change };
    writeCueChoice(browserStore(), this.choice);
  }

  update({ frame, bundle, tutor, sight, nowMs }: TutorInput): void {
    const cue = frame ? (tutor?.cue ?? null) : null;
    this.shown = cue && frame && isFresh(cue, frame.sim_time_s) ? cue : null;
    if (this.shown && this.shown.timeS !== this.lastTimeS) this.sound(nowMs);
    this.lastTimeS = this.shown?.timeS ?? -1;
    // A force is always said, also to who wants no words.
    const guided = this.shown ? (tutor?.guided ?? -1) : -1;
    this.line.show(this.choice.words || guided >= 0 ? this.shown : null, guided);
    const hand = this.choice.arrow ? (this.shown?.hand ?? -1) : -1;
    const tool = hand >= 0 && frame && bundle ? toolInHand(frame, bundle, hand) : null;
    this.arrow.update(tool ? vector(tool.p_m) : null, sight, nowMs / 1000);
  }
}

/** Whether a cue was given just now. Its time may be ahead of the frame after a reset. */
export function isFresh(cue: Pick<HintView, 'timeS'>, nowS: number): boolean {
  const age = cue.timeS === null ? Infinity : nowS - cue.timeS;
  return age >= -1e-6 && age < shownS;
}
