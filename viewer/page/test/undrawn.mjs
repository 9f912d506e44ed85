// SPDX-License-Identifier: GPL-3.0-or-later
// A browser for checks that read the panels and never the field, so it is not drawn: here is no graphics card, and one
// that draws would take none of the processor's time either. All else of the page runs as it does for a person.
import { launch, patience } from './browser.mjs';

export const launchUndrawn = () => launch('--disable-gpu-compositing');

/** Runs in the page. Twenty pictures a second suffice for reading. */
function drawNothing() {
  const draws = ['drawElements', 'drawArrays', 'drawElementsInstanced', 'drawArraysInstanced', 'clear'];
  const gl = WebGL2RenderingContext.prototype;
  for (const name of draws) {
    const draw = gl[name];
    gl[name] = function (...words) {
      if (window.__draws) draw.apply(this, words);
    };
  }
  const soon = window.requestAnimationFrame.bind(window);
  window.requestAnimationFrame = (draw) => setTimeout(() => soon(draw), 40);
}

export async function openUndrawn(browser, viewport) {
  const page = await browser.newPage({ viewport });
  await page.addInitScript(drawNothing);
  return page;
}

/** Draws the field while that is done. */
export async function drawn(page, work) {
  const draws = (on) => page.evaluate((o) => void (window.__draws = o), on);
  await draws(true);
  const { pictures } = await page.evaluate(() => ({ ...window.__insula }));
  await page.waitForFunction((n) => window.__insula.pictures > n + 2, pictures, patience);
  await work();
  await draws(false);
}
