// SPDX-License-Identifier: GPL-3.0-or-later
// The instructor's view of all channels: a list by component with present values, and curves of those that are
// ticked, which at the start are those that their component shows. Channels of one component and unit
// share a chart.
import { spoken } from '../bundle';
import { byComponent, type Channels, channelText, shortName } from '../step_data/channels';
import type { ChannelData } from '../step_data/declarations';
import { TimeChart } from './curves';
import { el, setText } from './dom';
import { listed } from '../languages/lists';
import { said } from '../languages/said';

const period = 0.05;

/** "parent: pressure". */
const nameOf = (c: ChannelData): string =>
  c.group === '' ? said(shortName(c)) : `${spoken(c.group)}: ${said(shortName(c))}`;

/** Which channels share a chart: of one component and unit. */
export function chartGroups(channels: readonly ChannelData[]): ChannelData[][] {
  const out = new Map<string, ChannelData[]>();
  for (const c of channels) {
    const key = `${c.component} ${c.display.unit}`;
    out.set(key, [...(out.get(key) ?? []), c]);
  }
  return [...out.values()];
}

export class ChannelCurves {
  readonly root = el('div', { class: 'channel-curves' });
  private readonly charts = el('div');
  private readonly list = el('div');
  private all: readonly ChannelData[] = [];
  private readonly ticked = new Set<ChannelData>();
  private drawn: { component: string; channels: ChannelData[]; chart: TimeChart; root: HTMLElement }[] = [];
  private values: { channel: ChannelData; text: HTMLElement }[] = [];
  private last = -Infinity;

  constructor() {
    this.root.append(this.charts, this.list);
  }

  showScene(channels: readonly ChannelData[]): void {
    this.all = channels;
    this.ticked.clear();
    for (const c of channels) if (c.shown !== 'none') this.ticked.add(c);
    this.values = [];
    this.list.replaceChildren(
      ...[...byComponent(channels)].map(([component, of]) =>
        el(
          'details',
          { 'data-component': component },
          el('summary', {}, spoken(component), el('small', {}, String(of.length))),
          ...of.map((c) => this.makeEntry(c)),
        ),
      ),
    );
    this.arrange();
  }

  /** stowed: components that are tools on the tray; their curves are not shown. */
  show(channels: Channels, stowed: ReadonlySet<string>, timeS: number): void {
    if (timeS >= this.last && timeS < this.last + period) return;
    this.last = timeS;
    for (const { component, channels: of, chart, root } of this.drawn) {
      root.hidden = stowed.has(component);
      chart.add(
        timeS,
        of.map((c) => {
          const v = channels.value(c);
          return v === null ? null : v * c.display.scale;
        }),
      );
      if (!root.hidden) chart.draw();
    }
    for (const { channel, text } of this.values)
      if (text.offsetParent !== null) setText(text, channelText(channel, channels.value(channel)));
  }

  private makeEntry(channel: ChannelData): HTMLElement {
    const box = el('input', { type: 'checkbox', 'data-curve': channel.id });
    box.checked = this.ticked.has(channel);
    box.onchange = () => {
      if (box.checked) this.ticked.add(channel);
      else this.ticked.delete(channel);
      this.arrange();
    };
    const text = el('span', { class: 'value' }, '–');
    this.values.push({ channel, text });
    return el('label', { title: said(channel.doc) }, box, el('span', {}, nameOf(channel)), text);
  }

  /** Charts of what is ticked; they begin anew. */
  private arrange(): void {
    this.drawn = chartGroups(this.all.filter((c) => this.ticked.has(c))).map((channels) => {
      const { component, display } = channels[0]!;
      const names = channels.map(nameOf);
      const chart = new TimeChart(`${spoken(component)} ${listed(names)}`, display.unit, names);
      const ids = channels.map((c) => c.id).join(' ');
      const root = el('div', { 'data-channels': ids }, el('h2', {}, spoken(component)), chart.root);
      return { component, channels, chart, root };
    });
    this.charts.replaceChildren(...this.drawn.map((d) => d.root));
  }
}
