// SPDX-License-Identifier: GPL-3.0-or-later
// What stands over the picture while there is none, or none that moves.
import type { SceneInfo } from './lcm';
import { text } from './languages/text';

export interface Liveness {
  /** Of the graphics card; '': it is there. */
  graphics: string;
  connected: boolean;
  info: SceneInfo | null;
  /** No word of the scene, no frames, for longer than usual. */
  infoQuiet: boolean;
  framesQuiet: boolean;
  loadError: string;
  /** A scene is built. */
  built: boolean;
  frames: number;
  paused: boolean;
  /** The scene is looked at, not played, or waits for a choice that is on the screen. */
  still: boolean;
}

export function bannerText(s: Liveness): string {
  // It explains the empty picture, whatever else is amiss.
  if (s.graphics) return s.graphics;
  if (!s.connected) return text('Viewer gateway not reached\ntrying again …');
  // Pictures are a sign of life too: on a slow machine they crowd out the second's word of the scene.
  if (!s.info || (s.infoQuiet && s.framesQuiet)) return text('Waiting for the engine …');
  if (s.info.state === 'error') return `${text('The scene has errors')}\n${s.info.message}`;
  if (s.loadError) return `${text('Scene data cannot be read')}\n${s.loadError}`;
  if (!s.built || s.info.state === 'loading') return text('Loading the scene …');
  if (s.frames === 0 || s.framesQuiet)
    return s.info.state === 'ended'
      ? text('The session has ended')
      : text('No pictures from the engine: waiting for it to come back …');
  return s.paused && !s.still ? text('Paused') : '';
}
