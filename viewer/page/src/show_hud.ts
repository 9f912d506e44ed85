// SPDX-License-Identifier: GPL-3.0-or-later
// Fills the head-up display once a picture: what the newest frame says, how the machine does, what is silent.
import { bannerText } from './banner';
import type { HandState } from './hands';
import type { GuideView } from './hud/guide_panel';
import type { Hud } from './hud/hud';
import type { HapticStatus, RenderFrame, SceneInfo } from './lcm';
import { status } from './status';
import type { Reading } from './step_data/reading';
import type { Within } from './take_back';
import type { World } from './world';
import { text } from './languages/text';

export interface Picture {
  world: World | null;
  frame: RenderFrame | null;
  reading: Reading;
  /** Hand that mouse and keyboard drive; -1: none. */
  active: number;
  hands: HandState[];
  /** What an instrument could take back from the field; null: nothing. */
  within: Within | null;
  guide: GuideView | null;
  /** The hand whose wrist is being turned to its target; -1: none. */
  assisted: number;
}

export interface Streams {
  link: { open: boolean };
  info: SceneInfo | null;
  haptic: HapticStatus | null;
  /** When each was last heard, ms. */
  heard: { haptic: number; info: number; frame: number };
  loadError: string;
  /** What the graphics card says while its picture is lost; '': nothing. */
  graphicsLost: string;
  /** Of the session until now. */
  frames: number;
}

/** quiet: whether a stream that was last heard then has been silent for so long. */
export function showHud(
  hud: Hud,
  { world, frame, reading, active, hands, guide, assisted, within }: Picture,
  { link, info, haptic, heard, loadError, graphicsLost, frames }: Streams,
  now: number,
  quiet: (heardMs: number, limitMs: number) => boolean,
): void {
  const { channels, state } = reading;
  const assists = active >= 0 && assisted === active;
  if (frame && world)
    hud.showFrame({
      frame,
      channels,
      state,
      active,
      hands,
      guide,
      assists,
      within,
      depth: status,
      ready: status.ready,
    });
  const freshHaptic = quiet(heard.haptic, 3000) ? null : haptic;
  hud.showMachine(quiet(heard.frame, 2500) ? null : frame, freshHaptic, status.fps, status.quality);
  const alive = link.open && !quiet(heard.frame, 1000);
  hud.showLink(link.open ? (alive ? text('connected') : text('gateway only')) : text('disconnected'), alive);
  hud.showBanner(
    bannerText({
      graphics: graphicsLost,
      connected: link.open,
      info,
      infoQuiet: quiet(heard.info, 4000),
      framesQuiet: quiet(heard.frame, 2500),
      loadError,
      built: world !== null,
      frames,
      paused: frame?.paused ?? false,
      still: world?.bundle.inventory != null || hud.session.open,
    }),
  );
  hud.showNotice(info && info.state !== 'error' ? info.message : '');
  hud.showProblems(status.problems);
  hud.tick(now);
}
