// SPDX-License-Identifier: GPL-3.0-or-later
// The scene editor of the studio shows this page in a frame. It asks where the microscope stands, and lets a point of
// the scene be moved with the mouse.
import type { Scene } from 'three';
import type { Microscope } from './camera';
import type { Placing } from './placing';

/** The studio is another program on the same machine, and so has the same host name. */
const ofThisMachine = (origin: string, here: Location): boolean => {
  try {
    return new URL(origin).hostname === here.hostname;
  } catch {
    return false;
  }
};

/** The answer: metres in the scene's frame. */
export function presentView({ target, camera }: Microscope): object {
  const [eye, up] = [camera.position.toArray(), camera.up.toArray()];
  return { insula: 'view', eye, target: target.toArray(), up };
}

/** Three finite numbers; null: it is something else. */
export function pointOf(value: unknown): [number, number, number] | null {
  const fine = Array.isArray(value) && value.length === 3 && value.every((x) => Number.isFinite(x));
  return fine ? (value as [number, number, number]) : null;
}

interface Seen {
  scope: Microscope;
  scene: Scene;
  canvas: HTMLCanvasElement;
}

/** Messages {insula: 'where'}, {insula: 'place', at: [m] | null}. */
export function answerTheFrame({ scope, scene, canvas }: Seen): void {
  if (window.parent === window) return;
  let placing: Placing | null = null;
  const place = async (at: [number, number, number] | null, answer: (message: object) => void) => {
    const loaded = await import('./placing');
    placing?.end();
    const moved = (to: { toArray(): number[] }) => answer({ insula: 'placed', at: to.toArray() });
    placing = at && new loaded.Placing(scene, canvas, scope.camera, at, moved);
  };
  window.addEventListener('message', (e: MessageEvent<{ insula?: unknown; at?: unknown } | null>) => {
    if (e.source !== window.parent || !ofThisMachine(e.origin, window.location)) return;
    const answer = (message: object) => window.parent.postMessage(message, e.origin);
    if (e.data?.insula === 'where') answer(presentView(scope));
    if (e.data?.insula === 'place') void place(pointOf(e.data.at), answer);
  });
}
