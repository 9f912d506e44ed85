// SPDX-License-Identifier: GPL-3.0-or-later
// What the browser tests of the case builder's page share.
import { join } from 'node:path';

/** Takes pictures of the page as PREFIX_NAME.png, if INSULA_SHOTS names a folder for them. */
export const shots =
  (prefix, options = { fullPage: true }) =>
  async (page, name, more = {}) => {
    if (!process.env.INSULA_SHOTS) return;
    await page.screenshot({
      path: join(process.env.INSULA_SHOTS, `${prefix}_${name}.png`),
      timeout: 300_000,
      ...options,
      ...more,
    });
  };

/** Large enough to read the page's steps beside the vessel, small enough to be read in the manual. */
export const viewport = process.env.INSULA_PICTURES ? { width: 1180, height: 740 } : { width: 1366, height: 900 };

/** A picture of docs/tutorial-case.md, if INSULA_PICTURES names their folder. at: scrolled to the top. */
export async function picture(page, name, at) {
  if (!process.env.INSULA_PICTURES) return;
  if (at) await at.evaluate((e) => e.scrollIntoView({ block: 'start' }));
  await page.waitForTimeout(600); // for the surface to be drawn
  const path = join(process.env.INSULA_PICTURES, `${name}.jpg`);
  await page.screenshot({ path, type: 'jpeg', quality: 70, timeout: 300_000 });
}

/** A step of the page by its title. */
export const step = (page, title) => page.locator('.steps section', { has: page.getByText(title, { exact: true }) });

/** Drops a file onto the page. */
export const dropped = (page, name, bytes) =>
  page.evaluate(
    ({ file, base64 }) => {
      const transfer = new DataTransfer();
      transfer.items.add(new File([Uint8Array.from(atob(base64), (c) => c.charCodeAt(0))], file));
      document.querySelector('.drop').dispatchEvent(new DragEvent('drop', { dataTransfer: transfer, bubbles: true }));
    },
    { file: name, base64: bytes.toString('base64') },
  );

/** Drops files or folders of this machine onto the page, as a hand does. Chromium only. */
export async function droppedFrom(page, ...paths) {
  const box = await page.locator('.drop').boundingBox();
  const to = await page.context().newCDPSession(page);
  const data = { items: [], files: paths, dragOperationsMask: 1 };
  const at = { x: box.x + box.width / 2, y: box.y + box.height / 2, data };
  for (const type of ['dragEnter', 'dragOver', 'drop']) await to.send('Input.dispatchDragEvent', { type, ...at });
  await to.detach();
}
