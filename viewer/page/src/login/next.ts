// SPDX-License-Identifier: GPL-3.0-or-later
// Where a login leads to: a page of this gateway, whatever the address line says.

/** next: path with a query, of the address line; base: the folder of the pages. */
export function nextPage(next: string, base: URL): URL {
  const start = new URL('index.html', base);
  if (!next.startsWith('/')) return start;
  const url = new URL(next, base);
  const allowed = url.origin === base.origin && (url.pathname === '/' || /^\/\w+\.html$/.test(url.pathname));
  return allowed && url.pathname !== '/login.html' ? url : start;
}
