// SPDX-License-Identifier: GPL-3.0-or-later
// What the browser tests of the case builder's page share.
import { join } from 'node:path';

/** Takes pictures of the page as PREFIX_NAME.png, if INSULA_SHOTS names a folder for them. */
export const shots =
  (prefix, options = { fullPage: true }) =>
  async (page, name) => {
    if (!process.env.INSULA_SHOTS) return;
    await page.screenshot({ path: join(process.env.INSULA_SHOTS, `${prefix}_${name}.png`), ...options });
  };

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
