// SPDX-License-Identifier: GPL-3.0-or-later
// A dialog in which the instructor lists a station by its address.
import { el, setText } from '../hud/dom';
import { said } from '../languages/said';
import { text } from '../languages/text';

const exampleUrl = 'https://192.0.2.11:8080/';

export interface NewStation {
  name: string;
  url: string;
  fingerprint: string;
}

/** An address as a person types it, as the gateway wants it: "table3.local:8080" is plain HTTP. */
export function addressOf(typed: string): string {
  const address = typed.trim();
  return address === '' || address.includes('://') ? address : `http://${address}`;
}

/** Digits of a SHA-256 as they are often written, in pairs with colons between them; others as they are. */
export function fingerprintOf(typed: string): string {
  const digits = typed.replace(/[\s:]/g, '').toUpperCase();
  return /^[0-9A-F]{64}$/.test(digits) ? digits.match(/../g)!.join(':') : typed.trim();
}

/** What the gateway may answer, for the catalogues (viewer/gateway/room_edits.cpp, station_list.cpp). */
export const refusals = (): string[] => [
  text('a name has 1 to 63 bytes'),
  text('an address begins with http:// or https://'),
  text('this is no address of a station'),
  text('a SHA-256 has 32 pairs of digits such as AB, with colons between them'),
  text('only https:// has a certificate'),
  text('a station with this address is listed already'),
  text('a station with this name is listed already'),
  text('the room is full'),
  text('this gateway has no folder of its own to keep the list in'),
  text('the list cannot be written'),
  text('only for pages on this machine'),
];

/** Asks the gateway to change its list. '' if it did; else why not, in the reader's language. */
export async function change(url: URL, method: 'POST' | 'DELETE', station?: NewStation): Promise<string> {
  try {
    const answer = await fetch(url, { method, ...(station ? { body: JSON.stringify(station) } : {}) });
    if (answer.ok) return '';
    const { error } = (await answer.json()) as { error?: unknown };
    return said(typeof error === 'string' ? error : String(answer.status));
  } catch {
    return text('The gateway does not answer.');
  }
}

export class StationForm {
  readonly root = el('dialog', { class: 'station-form', 'aria-labelledby': 'station-form-title' });
  private readonly name = el('input', { type: 'text', maxlength: '40', required: '' });
  private readonly url = el('input', {
    type: 'text',
    required: '',
    placeholder: text('for example {example}', { example: exampleUrl }),
  });
  private readonly print = el('input', { type: 'text' });
  private readonly why = el('p', { class: 'why', role: 'alert' });

  /** add: '' if the station is listed; else why not. */
  constructor(private readonly add: (station: NewStation) => Promise<string>) {
    const field = (label: string, input: HTMLInputElement) => el('label', {}, label, input);
    const cancel = el('button', { type: 'button' }, text('Cancel'));
    cancel.onclick = () => this.root.close();
    const form = el(
      'form',
      {},
      el('h2', { id: 'station-form-title' }, text('Add a station')),
      field(text('Name'), this.name),
      field(text('Address'), this.url),
      field(text('SHA-256 of its certificate, as the station prints it (for https)'), this.print),
      el(
        'p',
        { class: 'hint' },
        text('The key of this room is shown to the station. Add only stations that you know.'),
      ),
      this.why,
      el('div', { class: 'buttons' }, el('button', { type: 'submit' }, text('Add')), cancel),
    );
    form.onsubmit = (e) => {
      e.preventDefault();
      void this.submit();
    };
    this.root.append(form);
  }

  open(name = '', url = ''): void {
    Object.assign(this.name, { value: name });
    Object.assign(this.url, { value: url });
    this.print.value = '';
    setText(this.why, '');
    this.root.showModal();
    (name === '' ? this.name : this.print).focus();
  }

  private async submit(): Promise<void> {
    const station = {
      name: this.name.value.trim(),
      url: addressOf(this.url.value),
      fingerprint: fingerprintOf(this.print.value),
    };
    setText(this.why, '');
    const why = await this.add(station);
    setText(this.why, why);
    if (why === '') this.root.close();
  }
}
