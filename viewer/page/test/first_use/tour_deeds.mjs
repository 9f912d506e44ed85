// SPDX-License-Identifier: GPL-3.0-or-later
// What somebody does for each step of the first-use tour, by mouse and by keys; dir: -1 or 1, there or back.
import { patience } from '../browser.mjs';

/** Of the field; panels cover the rest. */
const middle = { x: 500, y: 300 };
const left = 0;
const right = 1;

const hand = (page, side) => page.locator('.hand').nth(side);

async function drag(page, button, dx, dy) {
  await page.mouse.move(middle.x, middle.y);
  await page.mouse.down({ button });
  await page.mouse.move(middle.x + dx, middle.y + dy, { steps: 6 });
  await page.mouse.up({ button });
}

async function wheel(page, clicks) {
  await page.mouse.move(middle.x, middle.y);
  for (let k = 0; k < Math.abs(clicks); k++) await page.mouse.wheel(0, 100 * Math.sign(clicks));
}

async function dragHand(page, side, px) {
  await hand(page, side).locator('.choose').click(patience);
  await drag(page, 'left', 0, px);
}

/** Until a hand's button is on, or off again, in the page. */
const buttonIs = (page, side, on) =>
  page.waitForFunction(([s, o]) => window.__insula.buttons[s][0] === o, [side, on], patience);

/** What both ways of working share: there are no keys for it. */
const microscope = {
  zoom: (page, dir) => wheel(page, 3 * dir),
  turn: (page, dir) => drag(page, 'right', 90 * dir, 0),
};

export const byMouse = {
  ...microscope,
  right_hand: (page, dir) => dragHand(page, right, 140 * dir),
  left_hand: (page, dir) => dragHand(page, left, 140 * dir),
  async button(page) {
    const latch = hand(page, left).locator('[data-latch="1"]');
    await latch.click(patience);
    await buttonIs(page, left, true);
    await page.waitForTimeout(300);
    await latch.click(patience);
    await buttonIs(page, left, false);
  },
  exchange: (page) => hand(page, left).locator('.tray button:enabled').click(patience),
  async choose(page) {
    await page.locator('.tool-list-head').click(patience);
    await page.locator('.tool-list-entries button:enabled').first().click(patience);
  },
};

async function keyHand(page, side, dir) {
  await page.keyboard.press(String(side + 1));
  await page.keyboard.press(dir > 0 ? 'ArrowDown' : 'ArrowUp', { delay: 1200 });
}

export const byKeys = {
  ...microscope,
  right_hand: (page, dir) => keyHand(page, right, dir),
  left_hand: (page, dir) => keyHand(page, left, dir),
  async button(page) {
    await page.keyboard.press('1');
    await page.keyboard.press('Space', { delay: 500 });
  },
  async exchange(page) {
    await page.keyboard.press('1');
    await page.keyboard.press('t');
  },
  async choose(page) {
    await page.keyboard.press('l');
    await page.locator('.tool-list-entries').waitFor(patience);
    await page.keyboard.press('ArrowDown');
    await page.keyboard.press('Enter');
  },
};

/** The right thing, but too little of it. */
export const tooLittle = {
  zoom: (page, dir) => wheel(page, dir),
  turn: (page, dir) => drag(page, 'right', 10 * dir, 0),
  right_hand: (page, dir) => dragHand(page, right, 20 * dir),
  left_hand: (page, dir) => dragHand(page, left, 20 * dir),
  async button(page) {
    await page.keyboard.press('1');
    await page.keyboard.press('b', { delay: 300 });
  },
  exchange: (page) => page.locator('.hand .tray button[aria-pressed=true]').first().hover(),
  async choose(page) {
    await page.locator('.tool-list-head').click(patience);
    await page.locator('.tool-list-head').click(patience);
  },
};
