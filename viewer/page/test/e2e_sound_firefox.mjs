// SPDX-License-Identifier: GPL-3.0-or-later
// The sound of the page in Firefox. Exit status 77: no Firefox, or no screen or sound for it, skipped.
process.env.INSULA_BROWSER = 'firefox';
await import('./e2e_sound.mjs');
