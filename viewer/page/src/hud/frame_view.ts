// SPDX-License-Identifier: GPL-3.0-or-later
// What the head-up display shows of one frame.
import type { HandState } from '../hands';
import type { RenderFrame } from '../lcm';
import type { Channels } from '../step_data/channels';
import type { Within } from '../take_back';
import type { GuideView } from './guide_panel';
import type { DepthView } from './hand_panel';
import type { HudState } from './state';

export interface FrameView {
  frame: RenderFrame;
  channels: Channels;
  /** What the frame's hud_json says, null when it says nothing. */
  state: HudState | null;
  /** Hand that mouse and keyboard drive; -1: none. */
  active: number;
  /** Left, right. */
  hands: HandState[];
  /** Of the active hand; null: no target is shown. */
  guide: GuideView | null;
  /** The tool is being turned to its target. */
  assists: boolean;
  depth: DepthView;
  within: Within | null;
  /** A picture of the scene is there. */
  ready: boolean;
}
