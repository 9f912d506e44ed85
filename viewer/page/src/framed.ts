// SPDX-License-Identifier: GPL-3.0-or-later
// The scene editor of the studio shows this page in a frame, and asks where the microscope stands.
import type { Microscope } from './camera';

/** The studio is another program on the same machine, and so has the same host name. */
const ofThisMachine = (origin: string, here: Location): boolean => {
  try {
    return new URL(origin).hostname === here.hostname;
  } catch {
    return false;
  }
};

/** The answer: metres in the scene's frame. */
export function presentView(scope: Microscope): object {
  const { target, camera } = scope;
  return {
    insula: 'view',
    eye: camera.position.toArray(),
    target: target.toArray(),
    up: camera.up.toArray(),
  };
}

export function answerTheFrame(scope: Microscope): void {
  if (window.parent === window) return;
  window.addEventListener('message', (e: MessageEvent<{ insula?: unknown } | null>) => {
    if (e.source !== window.parent || !ofThisMachine(e.origin, window.location) || e.data?.insula !== 'where') return;
    window.parent.postMessage(presentView(scope), e.origin);
  });
}
