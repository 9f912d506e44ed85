// SPDX-License-Identifier: GPL-3.0-or-later
// What is wrong with the layout of an open page, and which of its texts are in no catalogue. Both run in the page.

/** Runs in the page: a line for each fault of the layout. */
export function layoutFaults() {
  const faults = [];
  const name = (e) => {
    const words = (e.getAttribute('aria-label') ?? e.textContent ?? '').trim().slice(0, 40);
    const kind = typeof e.className === 'string' && e.className ? `.${e.className.replaceAll(' ', '.')}` : '';
    return `${e.tagName.toLowerCase()}${e.id && `#${e.id}`}${kind} "${words}"`;
  };
  const shown = (e) => e.checkVisibility({ opacityProperty: true, visibilityProperty: true });
  const root = document.scrollingElement;
  if (root.scrollWidth > innerWidth + 1) faults.push(`the page is ${root.scrollWidth} wide, the window ${innerWidth}`);
  const open = [...document.querySelectorAll('[role=dialog][aria-modal], dialog[open]')].filter(shown).pop();
  const whole = open?.getBoundingClientRect();
  if (whole && (whole.top < -1 || whole.left < -1 || whole.bottom > innerHeight + 1 || whole.right > innerWidth + 1))
    faults.push(`${name(open)}: the window cuts it`);
  const readerOnly = (e) => e.clientWidth <= 1 || e.clientHeight <= 1;
  for (const e of (open ?? document).querySelectorAll('*')) {
    if (!shown(e) || e.closest('svg, canvas')) continue;
    const own = [...e.childNodes].some((n) => n.nodeType === Node.TEXT_NODE && n.textContent.trim() !== '');
    if (!own || readerOnly(e)) continue;
    const style = getComputedStyle(e);
    const size = parseFloat(style.fontSize);
    if (size < 11.99 && !e.closest('sub, sup')) faults.push(`${name(e)}: text of ${size} px`);
    const panel = e.closest('.panel')?.getBoundingClientRect();
    const { left, right } = e.getBoundingClientRect();
    if (panel && (right > panel.right + 1 || left < panel.left - 1)) faults.push(`${name(e)}: sticks out of its panel`);
    if (style.display !== 'inline' && style.overflowX !== 'visible' && e.scrollWidth > e.clientWidth + 1)
      if (!['auto', 'scroll'].includes(style.overflowX) && !e.matches('select, option'))
        faults.push(`${name(e)}: text is cut, ${e.scrollWidth} of ${e.clientWidth} px`);
  }
  const controls = 'button, a[href], input, select, textarea, summary, [role=button], [role=slider]';
  for (const e of (open ?? document).querySelectorAll(controls)) {
    if (!shown(e) || e.disabled || e.type === 'hidden' || e.closest('[inert]')) continue;
    e.scrollIntoView({ block: 'center', inline: 'nearest', behavior: 'instant' });
    // A link over two lines has its middle between them.
    const box = e.getClientRects()[0];
    if (!box || box.width === 0) continue;
    const [x, y] = [box.left + box.width / 2, box.top + box.height / 2];
    if (x < 0 || y < 0 || x >= innerWidth || y >= innerHeight || box.right > innerWidth + 1) {
      faults.push(`${name(e)}: outside of the window, at ${Math.round(x)}, ${Math.round(y)}`);
      continue;
    }
    const hit = document.elementFromPoint(x, y);
    const label = e.closest('label') ?? (e.id && document.querySelector(`label[for="${e.id}"]`));
    if (!hit || !(e.contains(hit) || hit.contains(e) || label?.contains(hit)))
      faults.push(`${name(e)}: beneath ${hit ? name(hit) : 'nothing'}`);
    else if (hit !== e && hit.contains(e) && !label) faults.push(`${name(e)}: no pointer reaches it`);
  }
  root.scrollTo(0, 0);
  return [...new Set(faults)];
}

/**
 * Runs in the page: pairs of panels and messages over the field that cover one another. A dialog may lie over panels,
 * and nothing over a dialog.
 */
export function panelsOverlap() {
  const shown = (e) => e.checkVisibility({ visibilityProperty: true });
  const dialog = [...document.querySelectorAll('.dialog')].find(shown);
  const panels = [...document.querySelectorAll('.panel:not(.dialog), .message.on')].filter(shown);
  if (dialog) panels.splice(0, panels.length, dialog, ...panels.filter((e) => e.matches('.message')));
  const faults = [];
  for (const [k, a] of panels.entries())
    for (const b of panels.slice(k + 1)) {
      if (a.contains(b) || b.contains(a)) continue;
      const [p, q] = [a.getBoundingClientRect(), b.getBoundingClientRect()];
      const wide = Math.min(p.right, q.right) - Math.max(p.left, q.left);
      const high = Math.min(p.bottom, q.bottom) - Math.max(p.top, q.top);
      if (wide > 2 && high > 2) faults.push(`${a.className} and ${b.className} overlap by ${wide} x ${high}`);
    }
  return faults;
}

/**
 * Runs in the page that speaks the language of pseudo_language.mjs: visible texts outside of brackets. names: what is
 * nobody's text, such as names and units.
 */
export function textsOutside(names) {
  const found = new Set();
  const walk = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let n = walk.nextNode(); n; n = walk.nextNode()) {
    const e = n.parentElement;
    // Names of languages are in their own.
    if (!e.checkVisibility() || e.closest('script, style, [lang]:not(html), code')) continue;
    let rest = n.textContent;
    for (let last = ''; last !== rest;) [last, rest] = [rest, rest.replace(/\[[^[\]]*\]/g, '')];
    for (const name of names) rest = rest.replaceAll(name, '');
    if (/\p{L}{3}/u.test(rest)) found.add(rest.trim());
  }
  return [...found];
}
