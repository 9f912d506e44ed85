// SPDX-License-Identifier: GPL-3.0-or-later
// The login page: a PIN, or a ticket after the "#" of its address, admits this browser to the station.
import './login.css';
import '../screens.css';
import { el } from '../hud/dom';
import { text } from '../languages/text';
import { nextPage } from './next';

document.title = `Insula: ${text('Log in')}`;
const base = new URL('./', window.location.href);
const next = nextPage(new URLSearchParams(window.location.search).get('next') ?? '', base);

/** '' if the gateway admits this browser; else why it does not. */
async function logIn(secret: { pin: string; name: string } | { ticket: string }): Promise<string> {
  const answer = await fetch(new URL('api/login', base), {
    method: 'POST',
    headers: { 'Content-Type': 'application/json' },
    body: JSON.stringify(secret),
  });
  if (answer.ok) return '';
  if (answer.status === 429) return text('Too many wrong tries. Wait a minute.');
  return 'pin' in secret ? text('This is not the PIN.') : text('The way here has ended. Give the PIN.');
}

const pin = el('input', {
  id: 'pin',
  type: 'password',
  inputmode: 'numeric',
  autocomplete: 'off',
  maxlength: '12',
  required: '',
});
const called = el('input', { id: 'name', type: 'text', autocomplete: 'name', maxlength: '40' });
const say = el('p', { class: 'say', role: 'alert' });
const form = el(
  'form',
  {},
  el('label', { for: 'pin' }, text('PIN')),
  pin,
  el('button', {}, text('Log in')),
  el('label', { for: 'name', class: 'called' }, text('Your name, for the record (may stay empty)')),
  called,
  say,
);

async function enter(secret: { pin: string; name: string } | { ticket: string }): Promise<void> {
  say.textContent = '';
  try {
    const why = await logIn(secret);
    if (why === '') return window.location.replace(next);
    say.textContent = why;
  } catch {
    say.textContent = text('The gateway does not answer.');
  }
  pin.select();
}

form.onsubmit = (e) => {
  e.preventDefault();
  void enter({ pin: pin.value.trim(), name: called.value.trim() });
};

document
  .getElementById('login')!
  .append(
    el('h1', {}, 'Insula'),
    el('p', {}, text('This station asks for a PIN. It was printed where the session was started.')),
    form,
  );
pin.focus();

/** A browser that is logged in already goes on at once. */
async function begin(): Promise<void> {
  const ticket = /^#ticket=([0-9a-f]{64})$/.exec(window.location.hash)?.[1];
  window.history.replaceState(null, '', window.location.pathname + window.location.search);
  if (ticket) return enter({ ticket });
  const state = (await (await fetch(new URL('api/login', base))).json()) as { access?: unknown };
  if (state.access !== undefined && state.access !== 'none') window.location.replace(next);
}
void begin().catch(() => undefined);
