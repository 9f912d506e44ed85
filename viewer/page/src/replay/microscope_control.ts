// SPDX-License-Identifier: GPL-3.0-or-later
// Mouse, pen and fingers move the microscope alone: drag turns it, with Shift or the right button it moves aside, the
// wheel or two fingers zoom, a double click looks there.
import type { Stage } from '../stage';
import { wheelZoom } from '../wheel';

export function controlMicroscope(stage: Stage): void {
  const { canvas, scope } = stage;
  const down = new Map<number, { x: number; y: number }>();
  const spread = () => {
    const [a, b] = [...down.values()];
    return a && b ? Math.hypot(a.x - b.x, a.y - b.y) : 0;
  };
  canvas.addEventListener('pointerdown', (e) => {
    canvas.setPointerCapture(e.pointerId);
    down.set(e.pointerId, { x: e.clientX, y: e.clientY });
  });
  canvas.addEventListener('pointermove', (e) => {
    const last = down.get(e.pointerId);
    if (!last) return;
    const before = spread();
    const [dx, dy] = [e.clientX - last.x, e.clientY - last.y];
    down.set(e.pointerId, { x: e.clientX, y: e.clientY });
    if (down.size === 2) {
      if (before > 0) scope.zoom(before / Math.max(1, spread()));
    } else if (e.shiftKey || (e.buttons & 2) !== 0) scope.pan(dx, dy, canvas.clientHeight);
    else scope.orbit(dx, dy);
  });
  for (const end of ['pointerup', 'pointercancel', 'lostpointercapture'] as const)
    canvas.addEventListener(end, (e) => down.delete(e.pointerId));
  canvas.addEventListener(
    'wheel',
    (e) => {
      e.preventDefault();
      scope.zoom(wheelZoom(e));
    },
    { passive: false },
  );
  canvas.addEventListener('dblclick', (e) => {
    void stage.focusAt(e.clientX - canvas.offsetLeft, e.clientY - canvas.offsetTop);
  });
  canvas.addEventListener('contextmenu', (e) => e.preventDefault());
}
