// SPDX-License-Identifier: GPL-3.0-or-later
// The devices that there are, each with a live check: both hands of the haptic server, gamepads, pointers and keys.
import { hapticText } from '../hud/haptic';
import { el, setText } from '../hud/dom';
import { text } from '../languages/text';
import { DeviceLink } from './device_link';
import { handLive, KeyWatch, type Live, padLive, type PointerKind, pointerKinds, PointerWatch } from './device_live';

class Row {
  readonly root = el('li');
  private readonly says = el('span', { class: 'says' });
  private readonly bars = el('span', { class: 'bars', 'aria-hidden': 'true' });
  private readonly lamps = el('span', { class: 'lamps', 'aria-hidden': 'true' });

  constructor(name: string) {
    this.root.append(el('b', {}, name), this.says, this.bars, this.lamps);
  }

  show({ says, bars, lamps }: Live): void {
    setText(this.says, says);
    fit(this.bars, bars.length, () => el('i', {}, el('b')));
    bars.forEach((x, k) => {
      const fill = this.bars.children[k]!.firstElementChild as HTMLElement;
      fill.style.left = `${50 + 50 * Math.min(0, x)}%`;
      fill.style.width = `${50 * Math.abs(x)}%`;
    });
    fit(this.lamps, lamps.length, () => el('i'));
    lamps.forEach((on, k) => this.lamps.children[k]!.classList.toggle('on', on));
  }
}

/** As many children as there are values. */
function fit(parent: HTMLElement, count: number, make: () => HTMLElement): void {
  while (parent.childElementCount > count) parent.lastElementChild!.remove();
  while (parent.childElementCount < count) parent.append(make());
}

const pointerNames: Record<PointerKind, () => string> = {
  mouse: () => text('Mouse'),
  pen: () => text('Pen'),
  touch: () => text('Finger'),
};

export class DevicePanel {
  readonly root = el('div', { class: 'devices' });
  private readonly link = new DeviceLink();
  private readonly pointers = new PointerWatch();
  private readonly keys = new KeyWatch();
  private readonly hands = [text('Left hand'), text('Right hand')].map((name) => new Row(name));
  private from: (Float64Array | null)[] = [null, null];
  private readonly pads = el('ul');
  private readonly padRows = new Map<string, Row>();
  private readonly noPad = el('li', {}, text('No gamepad is seen. Plug it in and press one of its buttons.'));
  private readonly pointerRows = pointerKinds.map((kind) => new Row(pointerNames[kind]()));
  private readonly keyRow = new Row(text('Keyboard'));
  private readonly servo = el('p', { class: 'hint' });
  private stop = new AbortController();

  constructor() {
    const rows = [...this.pointerRows, this.keyRow].map((r) => r.root);
    const hint = text('Move each device: its bars follow. Press its buttons: their lamps light up.');
    const chosen = text('The haptic devices are those with which this session was started.');
    this.root.append(
      el('p', { class: 'hint' }, hint),
      el('ul', {}, ...this.hands.map((h) => h.root)),
      this.servo,
      el('p', { class: 'hint' }, chosen),
      this.pads,
      el('ul', {}, ...rows),
    );
  }

  open(): void {
    this.close();
    this.link.open();
    this.from = [null, null];
    this.stop = new AbortController();
    const on = { signal: this.stop.signal, capture: true };
    for (const kind of ['pointermove', 'pointerdown', 'pointerup'] as const)
      window.addEventListener(kind, (e) => this.pointers.take(e), on);
    window.addEventListener('keydown', (e) => this.keys.down(e), on);
    window.addEventListener('keyup', (e) => this.keys.up(e), on);
    window.addEventListener('blur', () => this.keys.leave(), on);
    this.follow(this.stop.signal);
  }

  close(): void {
    this.stop.abort();
    this.keys.leave();
    this.link.close();
  }

  private follow(stop: AbortSignal): void {
    if (stop.aborted) return;
    this.show(performance.now());
    requestAnimationFrame(() => this.follow(stop));
  }

  private show(nowMs: number): void {
    this.showHands(nowMs);
    this.showPads();
    const reported = { fine: matchMedia('(any-pointer: fine)').matches, touchPoints: navigator.maxTouchPoints };
    this.pointerRows.forEach((row, k) =>
      row.show(this.pointers.live(pointerKinds[k]!, innerWidth, innerHeight, reported)),
    );
    this.keyRow.show(this.keys.live());
  }

  private showHands(nowMs: number): void {
    const hands = this.link.hands(nowMs);
    this.hands.forEach((row, k) => {
      const hand = hands?.find((h) => h.hand === k);
      // Another exercise has a haptic server of its own, whose hands are elsewhere.
      if (!hand) this.from[k] = null;
      if (!hand) return row.show({ says: text('no haptic server is heard'), bars: [], lamps: [] });
      row.show(handLive(hand, (this.from[k] ??= hand.p_m)));
    });
    const servo = this.link.servo(nowMs);
    setText(this.servo, servo ? hapticText(servo) : '');
  }

  private showPads(): void {
    const pads = (navigator.getGamepads?.() ?? []).filter((p) => p !== null);
    const rows = pads.map((pad) => {
      const key = `${pad.index} ${pad.id}`;
      const row = this.padRows.get(key) ?? new Row(text('Gamepad'));
      this.padRows.set(key, row);
      row.show(padLive(pad));
      return row.root;
    });
    const wanted = rows.length > 0 ? rows : [this.noPad];
    if (wanted.some((r, k) => this.pads.children[k] !== r) || this.pads.childElementCount !== wanted.length)
      this.pads.replaceChildren(...wanted);
  }
}
