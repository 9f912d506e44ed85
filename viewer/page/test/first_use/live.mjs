// SPDX-License-Identifier: GPL-3.0-or-later
// What somebody sees and moves in a live exercise with a tool in each hand over a tray.
import assert from 'node:assert/strict';
import { check, look, patience, waitFor } from '../browser.mjs';

const field = { x: 293, y: 100, width: 780, height: 470 };
const middle = [field.x + field.width / 2, field.y + field.height / 2];

/** Share of the field's points whose brightness is another one after three more pictures, and what was done before. */
async function change(page, act = async () => {}) {
  const shot = async () => (await page.screenshot({ clip: field, timeout: patience.timeout })).toString('base64');
  const before = await shot();
  await act();
  const { pictures } = await page.evaluate(() => ({ ...window.__insula }));
  await page.waitForFunction((n) => window.__insula.pictures > n + 3, pictures, patience);
  return page.evaluate(
    async (two) => {
      const points = await Promise.all(
        two.map(async (base64) => {
          const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
          const image = await createImageBitmap(new Blob([bytes], { type: 'image/png' }));
          const context = new OffscreenCanvas(image.width, image.height).getContext('2d');
          context.drawImage(image, 0, 0);
          return context.getImageData(0, 0, image.width, image.height).data;
        }),
      );
      let changed = 0;
      for (let i = 1; i < points[0].length; i += 4) if (Math.abs(points[0][i] - points[1][i]) > 12) changed++;
      return (4 * changed) / points[0].length;
    },
    [before, await shot()],
  );
}

const rests = (page) => waitFor('picture at rest', async () => (await change(page)) < 0.0002);

/** It changes at least so much of the picture, which stood still. Says how much. */
async function changes(page, least, what, act) {
  await rests(page);
  const share = await change(page, act);
  assert.ok(share > least, `${what}: ${(100 * share).toFixed(2)} % of the field change`);
  return `${(100 * share).toFixed(1)} %`;
}

async function picture(page) {
  await rests(page);
  const { mean, deviation } = await look(page, field);
  assert.ok(mean > 10 && mean < 245, `mean brightness ${mean}`);
  assert.ok(deviation > 8, `contrast ${deviation}`);
  check(`the live picture is there (brightness ${mean.toFixed(0)}, contrast ${deviation.toFixed(0)})`);
}

/** Zooms out, so that the tools come into the field. */
async function microscope(page) {
  const { mouse } = page;
  await mouse.move(...middle);
  const zoomed = await changes(page, 0.1, 'the wheel', async () => {
    for (let k = 0; k < 5; k++) await mouse.wheel(0, 100);
  });
  const turned = await changes(page, 0.1, 'a right drag', async () => {
    await mouse.down({ button: 'right' });
    await mouse.move(middle[0] + 60, middle[1], { steps: 4 });
    await mouse.up({ button: 'right' });
  });
  check(`the wheel zooms and a right drag turns the microscope (${zoomed}, ${turned} of the field)`);
}

/** Only down and up, and in depth: so the hand does not touch the ball, which would end the exercise. */
async function hand(page) {
  const { mouse, keyboard } = page;
  await mouse.move(...middle);
  const dragged = await changes(page, 0.002, 'a drag', async () => {
    await mouse.down();
    await mouse.move(middle[0], middle[1] + 80, { steps: 8 });
    await mouse.up();
  });
  assert.ok(await page.evaluate(() => window.__insula.taken[1]), 'the right hand is taken');
  const wheeled = await changes(page, 0.0005, 'Shift and the wheel', async () => {
    await keyboard.down('Shift');
    for (let k = 0; k < 8; k++) await mouse.wheel(0, 100);
    await keyboard.up('Shift');
  });
  const pressed = await changes(page, 0.002, 'a key', () => keyboard.press('ArrowDown', { delay: 1000 }));
  await keyboard.press('g');
  await page.waitForFunction(() => !window.__insula.taken[1], null, patience);
  check(`drag, wheel and key move the hand (${dragged}, ${wheeled}, ${pressed} of the field), and a key gives it back`);
}

async function reload(page) {
  const { session } = await page.evaluate(() => ({ ...window.__insula }));
  await page.reload();
  await page.waitForFunction(
    (s) => window.__insula?.ready && window.__insula.session === s && window.__insula.frames > 5,
    session,
    patience,
  );
  check('a page that is loaded again shows the same session');
}

export async function liveExercise(page) {
  await picture(page);
  await microscope(page);
  await hand(page);
  await reload(page);
}
