// SPDX-License-Identifier: GPL-3.0-or-later
// The patient's monitor: the pulse, and the channels that a scene shows as vital signs. Channels of a group are a row
// of a table with the names as columns. The others follow their component's name, and a number among them that is not
// known takes no room.
import type { Bundle } from '../bundle_types';
import { spoken } from '../bundle';
import {
  barShare,
  byComponent,
  channelText,
  type Channels,
  isShare,
  level,
  numberText,
  shortName,
} from '../step_data/channels';
import type { ChannelData } from '../step_data/declarations';
import { el, setText } from './dom';
import { said } from '../languages/said';
import { text } from '../languages/text';

interface Cell {
  channel: ChannelData;
  text: HTMLElement;
  bar: HTMLElement | null;
  /** What takes the colour of the channel's bands. */
  row: HTMLElement;
  write: (c: ChannelData, value: number | null) => string;
  /** Whether it goes while its number is not known. */
  mayHide: boolean;
}

/** Of a component's channels: lines without a group, and groups with their columns' names. */
export function tableOf(channels: readonly ChannelData[]): {
  lines: ChannelData[];
  columns: string[];
  rows: { group: string; cells: (ChannelData | null)[] }[];
} {
  const grouped = channels.filter((c) => c.group !== '');
  const columns = [...new Set(grouped.map(shortName))];
  const groups = [...new Set(grouped.map((c) => c.group))];
  const find = (group: string, name: string) => grouped.find((c) => c.group === group && shortName(c) === name) ?? null;
  return {
    lines: channels.filter((c) => c.group === ''),
    columns,
    rows: groups.map((group) => ({ group, cells: columns.map((name) => find(group, name)) })),
  };
}

export class Vitals {
  readonly root = el('section', { class: 'panel vitals' });
  private readonly beat = el('span', { class: 'beat', title: text('heartbeat') }, '♥');
  private readonly rate = el('span', { class: 'rate' });
  /** Numbers of the component that beats. */
  private readonly beside = el('span', { class: 'beside' });
  private readonly head = el('header', {}, el('span', {}, this.beat, this.rate), this.beside);
  private readonly parts = el('div');
  private components: { id: string; root: HTMLElement; cells: Cell[] }[] = [];
  private pulseChannel = '';
  private phase: number | null = null;
  private beats: number[] = [];

  constructor() {
    this.root.append(this.head, this.parts);
    this.root.hidden = true;
  }

  showScene(bundle: Bundle): void {
    this.phase = null;
    this.beats = [];
    this.pulseChannel = bundle.bodies.find((b) => b.pulseChannel !== '')?.pulseChannel ?? '';
    const vital = byComponent(bundle.channels.filter((c) => c.shown === 'vital'));
    const beating = bundle.channels.find((c) => c.id === this.pulseChannel)?.component;
    this.components = [...vital].map(([id, channels]) => this.makeComponent(id, channels, id !== beating));
    this.beside.replaceChildren(...this.components.filter((c) => c.id === beating).map((c) => c.root));
    this.parts.replaceChildren(...this.components.filter((c) => c.id !== beating).map((c) => c.root));
    this.head.hidden = this.pulseChannel === '';
    this.root.hidden = this.components.length === 0 && this.pulseChannel === '';
  }

  /** stowed: components that are tools on the tray; nobody looks at their numbers. */
  show(channels: Channels, stowed: ReadonlySet<string>, timeS: number): void {
    if (this.root.hidden) return;
    this.showPulse(channels.value(this.pulseChannel), timeS);
    for (const { id, root, cells } of this.components) {
      root.hidden = stowed.has(id);
      if (!root.hidden) for (const cell of cells) showCell(cell, channels);
    }
  }

  private showPulse(phase: number | null, timeS: number): void {
    if (phase === null) return;
    if (this.phase !== null && phase < this.phase - 0.5) this.onBeat(timeS);
    this.phase = phase;
    this.beat.style.transform = `scale(${(1 + 0.35 * Math.exp(-phase * 6)).toFixed(3)})`;
  }

  private onBeat(timeS: number): void {
    this.beats = [...this.beats.filter((t) => t < timeS), timeS].slice(-6);
    const n = this.beats.length;
    // At a few pictures a second beats are missed: then no number is better than a wrong one.
    const rate = n > 2 ? (60 * (n - 1)) / Math.max(0.1, this.beats[n - 1]! - this.beats[0]!) : 0;
    setText(this.rate, rate > 30 && rate < 220 ? text('{rate} /min', { rate: Math.round(rate) }) : '');
  }

  private makeComponent(
    id: string,
    channels: readonly ChannelData[],
    named: boolean,
  ): { id: string; root: HTMLElement; cells: Cell[] } {
    const { lines, columns, rows } = tableOf(channels);
    const cells: Cell[] = [];
    const heading = named ? [el('h2', {}, spoken(id))] : [];
    const parts: HTMLElement[] = [];
    if (lines.length > 0)
      parts.push(el('div', { class: 'lines' }, ...heading, ...lines.map((c) => makeLine(c, cells))));
    if (rows.length > 0) {
      const unitOf = (k: number) => rows.map((r) => r.cells[k]).find((c) => c)?.display.unit ?? '';
      const names = columns.map((name, k) => el('td', {}, el('b', {}, said(name)), unitOf(k)));
      const corner = el('th', {}, ...(lines.length > 0 ? [] : heading));
      const body = rows.map((r) => makeRow(r.group, r.cells, cells));
      parts.push(el('table', {}, el('tr', { class: 'units' }, corner, ...names), ...body));
    }
    return { id, root: el('div', { class: 'component', 'data-component': id }, ...parts), cells };
  }
}

function makeRow(group: string, channels: readonly (ChannelData | null)[], cells: Cell[]): HTMLElement {
  const row = el('tr', { 'data-group': group }, el('th', {}, spoken(group)));
  for (const channel of channels) {
    const text = el('span');
    const bar = channel && isShare(channel) ? el('i') : null;
    const place = el('td', channel ? { title: said(channel.doc), 'data-channel': channel.id } : {});
    place.append(...(bar ? [el('span', { class: 'line' }, bar)] : []), text);
    row.append(place);
    if (channel) cells.push({ channel, text, bar, row: place, write: numberText, mayHide: false });
  }
  return row;
}

function makeLine(channel: ChannelData, cells: Cell[]): HTMLElement {
  const text = el('span', { class: 'value' });
  const bar = isShare(channel) ? el('i') : null;
  const row = el(
    'div',
    { class: 'vital', 'data-channel': channel.id, title: said(channel.doc) },
    el('span', {}, said(shortName(channel))),
    text,
  );
  if (bar) row.append(el('span', { class: 'line' }, bar));
  cells.push({ channel, text, bar, row, write: channelText, mayHide: true });
  return row;
}

function showCell({ channel, text, bar, row, write, mayHide }: Cell, channels: Channels): void {
  const value = channels.value(channel);
  row.hidden = mayHide && value === null;
  setText(text, write(channel, value));
  if (bar) bar.style.width = `${100 * barShare(channel, value)}%`;
  row.dataset.level = level(channel, value);
}
