// SPDX-License-Identifier: GPL-3.0-or-later
// The buttons of talking by voice, and the sign that stays over the picture while it is on.
import { el, setText } from '../hud/dom';
import { text } from '../languages/text';
import { nameOf } from './talk_panel';
import { canTalk, type Voice, type VoiceEnd } from './voice';

function endText(why: VoiceEnd): string {
  if (why === 'no microphone') return text('No microphone can be used.');
  if (why === 'no answer') return text('Nobody has answered.');
  if (why === 'declined') return text('The other side does not talk now.');
  return why === 'lost' ? text('The voice connection is lost.') : '';
}

export class VoicePanel {
  readonly root = el('div', { class: 'voice' });
  /** Over the picture: who rings, or whether the microphone is open. */
  readonly sign = el('p', { class: 'voice-sign', role: 'status' });
  private readonly note = el('p', { role: 'status' });
  private readonly level = el('meter', { min: '0', max: '1', 'aria-label': text('sound of the other side') });
  private readonly talk = button(text('Talk by voice'), () => void this.voice.call());
  private readonly accept = button(text('Accept'), () => void this.voice.accept());
  private readonly mute = button(text('Mute'), () => this.voice.mute(this.voice.microphone === 'open'));
  private readonly end = button(text('Hang up'), () => this.voice.hangUp());
  private others = 0;

  /** called: when somebody rings. */
  constructor(
    private readonly voice: Voice,
    private readonly called: () => void,
  ) {
    const row = el('div', { class: 'controls' }, this.talk, this.accept, this.mute, this.end);
    this.root.append(row, this.note, this.level);
    voice.changed = () => this.show();
    this.show();
  }

  /** How many pages of the other side are connected. */
  setOthers(count: number): void {
    this.others = count;
    this.show();
  }

  private show(): void {
    const { state, microphone } = this.voice;
    if (state === 'ringing') this.called();
    this.talk.hidden = state !== 'off';
    this.talk.disabled = !canTalk() || this.others === 0;
    this.accept.hidden = state !== 'ringing';
    this.mute.hidden = state !== 'open' || microphone === 'none';
    this.end.hidden = state === 'off';
    this.level.hidden = state !== 'open';
    this.level.value = this.voice.level;
    setText(this.mute, microphone === 'muted' ? text('Unmute') : text('Mute'));
    setText(this.end, state === 'ringing' ? text('Decline') : text('Hang up'));
    setText(this.note, this.noteText());
    const sign = this.signText();
    setText(this.sign, sign);
    this.sign.hidden = sign === '';
    this.sign.dataset.open = String(state === 'open' && microphone === 'open');
  }

  private noteText(): string {
    const { state, ended } = this.voice;
    if (!canTalk()) return text('Voice needs an encrypted page (https), or a browser on the station itself.');
    if (state === 'off')
      return ended === '' && this.others === 0 ? text('Nobody is there to talk with.') : endText(ended);
    if (state === 'calling') return text('It rings at the other side.');
    return state === 'joining' ? text('The voice connection begins.') : '';
  }

  private signText(): string {
    const { state, microphone, from } = this.voice;
    if (state === 'ringing') return text('{who} wants to talk by voice', { who: nameOf(from) });
    if (state !== 'open') return '';
    if (microphone === 'open') return text('Your microphone is open');
    return microphone === 'muted' ? text('Your microphone is muted') : text('You listen without a microphone');
  }
}

function button(label: string, pressed: () => void): HTMLButtonElement {
  const b = el('button', { type: 'button' }, label);
  b.onclick = pressed;
  return b;
}
