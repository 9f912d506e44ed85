// SPDX-License-Identifier: GPL-3.0-or-later
// What admits other machines: the PINs of this station and the key of the room. Pages on its own machine see them here,
// and make them, so that nobody needs a terminal.
import { el, setText } from '../hud/dom';
import { said } from '../languages/said';
import { text } from '../languages/text';

/** As the gateway says it (viewer/gateway/room_access.h). */
export interface AccessView {
  pin: string;
  observerPin: string;
  key: string;
  keyKept: boolean;
  reachable: boolean;
}

export function accessOf(json: unknown): AccessView {
  const j = (typeof json === 'object' && json !== null ? json : {}) as Record<string, unknown>;
  const string = (v: unknown): string => (typeof v === 'string' ? v : '');
  return {
    pin: string(j.pin),
    observerPin: string(j.observer_pin),
    key: string(j.key),
    keyKept: j.key_kept === true,
    reachable: j.reachable === true,
  };
}

/** What the gateway may answer, for the catalogues (viewer/gateway/room_access.cpp). */
export const accessRefusals = (): string[] => [
  text('there are PINs already'),
  text('there is a key already'),
  text('this gateway was started with its key'),
  text('a key is one line of 32 to 128 letters, digits, - and _'),
  text('the key cannot be kept'),
];

type Change = { make: 'pins' | 'key' } | { key: string };

export class AccessDialog {
  /** Hidden until the gateway says that this page may see the secrets. */
  readonly button = el('button', { type: 'button', class: 'access', hidden: '' }, text('PINs and key'));
  readonly root = el('dialog', { class: 'station-form', 'aria-labelledby': 'access-title' });
  private readonly body = el('div', { class: 'secrets' });
  private readonly why = el('p', { class: 'why', role: 'alert' });
  private readonly url: URL;

  constructor(base: URL) {
    this.url = new URL('api/room/access', base);
    const close = el('button', { type: 'button' }, text('Close'));
    close.onclick = () => this.root.close();
    this.root.append(
      el('h2', { id: 'access-title' }, text('What admits other machines')),
      this.body,
      this.why,
      el('div', { class: 'buttons' }, close),
    );
    this.button.onclick = () => {
      setText(this.why, '');
      this.root.showModal();
      void this.ask();
    };
  }

  /** Shows the button to who may see the secrets. */
  async offer(): Promise<void> {
    const answer = await fetch(this.url).catch(() => null);
    this.button.hidden = !answer?.ok;
  }

  private async ask(change?: Change): Promise<void> {
    setText(this.why, '');
    try {
      const answer = await fetch(this.url, change ? { method: 'POST', body: JSON.stringify(change) } : {});
      const json: unknown = await answer.json();
      if (answer.ok) return this.show(accessOf(json));
      const { error } = json as { error?: unknown };
      setText(this.why, said(typeof error === 'string' ? error : String(answer.status)));
    } catch {
      setText(this.why, text('The gateway does not answer.'));
    }
  }

  /** Who works by keys goes on at what took the place of the pressed button. */
  private show(view: AccessView): void {
    const place = this.places().indexOf(document.activeElement as HTMLElement);
    this.fill(view);
    if (place >= 0)
      this.places()
        .at(Math.min(place, this.places().length - 1))
        ?.focus();
  }

  /** What keys reach in the body of the dialog, in order. */
  private places(): HTMLElement[] {
    return [...this.body.querySelectorAll<HTMLElement>('button, summary, input')];
  }

  private fill(view: AccessView): void {
    const notice = view.reachable ? '' : text('Other machines do not reach this one: it was started without --listen.');
    this.body.replaceChildren(
      el('p', { class: 'hint' }, notice),
      el('h3', {}, text('PINs of this station')),
      ...this.pins(view),
      el('h3', {}, text('Key of the room')),
      ...this.key(view),
    );
  }

  private maker(label: string, what: 'pins' | 'key'): HTMLElement {
    const make = el('button', { type: 'button' }, label);
    make.onclick = () => void this.ask({ make: what });
    return make;
  }

  private pins({ pin, observerPin }: AccessView): HTMLElement[] {
    const lasting = el(
      'p',
      { class: 'hint lasting' },
      text('PINs are good until this program ends. Its next start needs new ones.'),
    );
    if (pin !== '')
      return [
        el('p', {}, text('Instructors: {pin}', { pin })),
        el('p', {}, observerPin === '' ? '' : text('Observers: {pin}', { pin: observerPin })),
        lasting,
      ];
    return [el('p', { class: 'hint' }, text('There are none.')), lasting, this.maker(text('Make PINs'), 'pins')];
  }

  private key({ key, keyKept }: AccessView): HTMLElement[] {
    const what = el('p', { class: 'hint' }, text('All stations of a room have the same key. Tell it to nobody else.'));
    const shown = el('details', {}, el('summary', {}, text('Show the key')), el('code', {}, key));
    const parts: HTMLElement[] = [what, key === '' ? this.maker(text('Make a key'), 'key') : shown];
    if (keyKept) parts.push(this.keyForm());
    return parts;
  }

  private keyForm(): HTMLElement {
    const input = el('input', { type: 'password', autocomplete: 'off', maxlength: '128', required: '' });
    const label = el('label', {}, text('Key of another station of the room'), input);
    const form = el('form', {}, label, el('button', { type: 'submit' }, text('Use this key')));
    form.onsubmit = (e) => {
      e.preventDefault();
      void this.ask({ key: input.value.trim() });
    };
    return form;
  }
}
