// SPDX-License-Identifier: GPL-3.0-or-later
// A browser for checks that read the panels and never the field, so it is not drawn: here is no graphics card, and one
// that draws would take none of the processor's time either. All else of the page runs as it does for a person.
import { launch } from './browser.mjs';

export const launchUndrawn = () => launch('--disable-gpu-compositing');

/** Runs in the page. Twenty pictures a second suffice for reading. */
function drawNothing() {
  const draws = ['drawElements', 'drawArrays', 'drawElementsInstanced', 'drawArraysInstanced', 'clear'];
  for (const name of draws) WebGL2RenderingContext.prototype[name] = () => undefined;
  const soon = window.requestAnimationFrame.bind(window);
  window.requestAnimationFrame = (draw) => setTimeout(() => soon(draw), 40);
}

export async function openUndrawn(browser, viewport) {
  const page = await browser.newPage({ viewport });
  await page.addInitScript(drawNothing);
  return page;
}
