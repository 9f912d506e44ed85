// SPDX-License-Identifier: GPL-3.0-or-later
// What somebody sets before he begins: sound, picture quality, colours, devices. The browser keeps it.
import { browserStore } from '../browser_store';
import { el } from '../hud/dom';
import { SoundPanel } from '../hud/sound_panel';
import { keepQuality, keptQuality } from '../kept_quality';
import { text } from '../languages/text';
import { type QualityName, qualityNames } from '../options';
import { applyPalette, keepPalette, keptPalette, paletteNames } from '../palette';
import type { PaletteName } from '../palette';
import { readSettings, writeSettings } from '../sound/settings';
import { DevicePanel } from './device_panel';

function qualityText(name: QualityName): string {
  switch (name) {
    case 'draft':
      return text('Draft, without a graphics card');
    case 'low':
      return text('Low');
    case 'medium':
      return text('Medium');
    case 'high':
      return text('High');
    case 'ultra':
      return text('Ultra, with depth of field');
  }
}

const paletteText = (name: PaletteName): string =>
  name === 'usual' ? text('Green, amber, red') : text('Blue, yellow, vermillion: safe for colour-blind eyes');

export class Settings {
  readonly button = el('button', { type: 'button', class: 'plain' }, text('Settings'));
  readonly root = el('dialog', { class: 'progress settings', 'aria-labelledby': 'settings-title' });
  private readonly store = browserStore();
  private readonly sound = new SoundPanel({ sound: (change) => this.changeSound(change) }, '');
  private readonly devices = new DevicePanel();
  private heard = readSettings(this.store);

  constructor() {
    const close = el('button', { type: 'button' }, text('Close'));
    close.onclick = () => this.root.close();
    this.root.append(
      el('h2', { id: 'settings-title' }, text('Settings')),
      this.part(text('Sound'), this.sound.root),
      this.part(text('Picture quality'), this.quality()),
      this.part(text('Colours'), this.colours(), this.swatches()),
      this.part(text('Devices'), this.devices.root),
      close,
    );
    this.button.onclick = () => {
      this.root.showModal();
      this.devices.open();
    };
    this.root.onclose = () => this.devices.close();
    this.sound.show(this.heard, false);
    applyPalette(keptPalette(this.store));
  }

  private part(title: string, ...content: HTMLElement[]): HTMLElement {
    return el('section', {}, el('h3', {}, title), ...content);
  }

  private changeSound(change: Partial<typeof this.heard>): void {
    this.heard = { ...this.heard, ...change };
    writeSettings(this.store, this.heard);
    this.sound.show(this.heard, false);
  }

  private quality(): HTMLElement {
    const select = el(
      'select',
      { id: 'quality', 'aria-label': text('picture quality') },
      el('option', { value: '' }, text('Automatic')),
      ...qualityNames.map((name) => el('option', { value: name }, qualityText(name))),
    );
    select.value = keptQuality(this.store) ?? '';
    select.onchange = () => keepQuality(this.store, qualityNames.find((name) => name === select.value) ?? null);
    return select;
  }

  private colours(): HTMLElement {
    const select = el(
      'select',
      { id: 'colours', 'aria-label': text('colours') },
      ...paletteNames.map((name) => el('option', { value: name }, paletteText(name))),
    );
    select.value = keptPalette(this.store);
    select.onchange = () => {
      const name = paletteNames.find((n) => n === select.value) ?? 'usual';
      keepPalette(this.store, name);
      applyPalette(name);
    };
    return select;
  }

  private swatches(): HTMLElement {
    const swatch = (kind: string, label: string) => el('span', { class: `swatch ${kind}` }, label);
    return el(
      'p',
      { class: 'swatches' },
      swatch('good', text('good')),
      swatch('high', text('attention')),
      swatch('bad', text('bad')),
    );
  }
}
