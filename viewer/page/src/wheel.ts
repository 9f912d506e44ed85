// SPDX-License-Identifier: GPL-3.0-or-later
// How far a mouse wheel was turned. Browsers disagree on what a click of it is: some give about a hundred pixels,
// Firefox three lines.

/** By WheelEvent.deltaMode: pixels, lines, pages. */
const perClick = [100, 3, 1];
/** At once; a touchpad's swipe can be long. */
const mostClicks = 3;
const zoomPerClick = 1.12;

type Turned = Pick<WheelEvent, 'deltaX' | 'deltaY' | 'deltaMode'>;

/** Towards the person is more than zero. With Shift some browsers give the way sideways. */
export function wheelClicks(e: Turned): number {
  // Asked first: Firefox gives lines only to those who have looked at the unit, and else fewer pixels than others.
  const unit = e.deltaMode;
  const clicks = (e.deltaY || e.deltaX) / perClick[unit]!;
  return Math.max(-mostClicks, Math.min(mostClicks, clicks));
}

/** Of the microscope's distance. */
export const wheelZoom = (e: Turned): number => zoomPerClick ** wheelClicks(e);
