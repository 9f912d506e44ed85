// SPDX-License-Identifier: GPL-3.0-or-later
// What in the scan is the vessel: a threshold or a label, a point in it, and how much around that point.
import { el, setText } from '../../hud/dom';
import { fixed } from '../../languages/numbers';
import { text } from '../../languages/text';
import type { Choices } from '../api';
import type { Asks } from '../editor';
import { field, select } from '../fields';
import type { ScanFacts } from './block';
import type { ScanState } from './scan_state';

const parts = [15, 20, 25, 30, 40, 60]; // mm
const steps = 1000; // of a slider
const restMs = 500;
const slider = () => el('input', { type: 'range', min: '0', max: String(steps), step: '1' });

/** The histogram, its counts as roots of roots, since vessels are few. */
function drawing(counts: readonly number[]): SVGElement {
  const svg = document.createElementNS('http://www.w3.org/2000/svg', 'svg');
  svg.setAttribute('viewBox', `0 0 ${Math.max(1, counts.length)} 100`);
  svg.setAttribute('preserveAspectRatio', 'none');
  svg.setAttribute('class', 'histogram');
  svg.setAttribute('aria-hidden', 'true');
  const most = Math.max(1, ...counts) ** 0.25;
  const path = document.createElementNS('http://www.w3.org/2000/svg', 'path');
  const points = counts.map((n, k) => `L${k} ${100 - (100 * n ** 0.25) / most}h1`);
  path.setAttribute('d', `M0 100${points.join('')}V100Z`);
  svg.append(path);
  return svg;
}

export class ScanPanel {
  readonly root: HTMLElement;
  private readonly label = el('select', {});
  private readonly threshold = slider();
  private readonly value = el('output', {});
  private readonly take = el('button', { type: 'button', class: 'main' }, text('Take this threshold'));
  private readonly brightness = slider();
  private readonly contrast = slider();
  private readonly seedHere = el('button', { type: 'button' }, text('Put the seed at the crosshair'));
  private readonly noSeed = el('button', { type: 'button' }, text('Remove the seed'));
  private readonly seed = el('p', { class: 'hint' });
  private readonly around = select([
    ['', text('all of the scan')],
    ...parts.map((mm) => [String(mm), text('{mm} mm around the seed', { mm })] as const),
  ]);
  private readonly levels: HTMLElement;
  private rest = 0;
  /** The threshold was moved, and has not been sent yet. */
  unsent = false;

  constructor(
    private readonly asks: Asks,
    private readonly facts: ScanFacts,
    private readonly state: ScanState,
  ) {
    this.levels = el(
      'div',
      { class: 'levels' },
      drawing(facts.counts),
      field(text('Threshold: vessel from this value up'), this.threshold),
      this.value,
      this.take,
    );
    this.root = el(
      'section',
      { class: 'scan-step' },
      el('h3', {}, text('The vessel in the scan')),
      el('p', {}, this.found()),
      el('p', { class: 'hint' }, text('Names and all other tags of the file were not copied.')),
      ...(facts.labels.length > 0 ? [field(text('Label of the vessel'), this.label)] : []),
      this.levels,
      el('div', { class: 'buttons' }, this.seedHere, this.noSeed),
      this.seed,
      field(text('Part that is taken'), this.around),
      field(text('Brightness'), this.brightness),
      field(text('Contrast'), this.contrast),
      el('p', { class: 'hint' }, this.help()),
    );
    this.labels();
    this.listen();
  }

  private found(): string {
    const [x, y, z] = this.facts.size;
    const [a, b, c] = this.facts.spacingMm.map((mm) => fixed(mm, 2));
    return text('{x} × {y} × {z} voxels of {a} × {b} × {c} mm; axes of the file: {axes}', {
      x: String(x), y: String(y), z: String(z), a: a!, b: b!, c: c!, axes: this.facts.axes,
    }); // prettier-ignore
  }

  private readonly help = () =>
    [
      text('A click moves the crosshair. The wheel and the arrow keys go through the slices.'),
      text('Drag with the right button to change brightness and contrast.'),
      text('Red is kept, blue is another piece.'),
    ].join(' ');

  private labels(): void {
    const grey: [string, string] = ['', text('none: by a threshold')];
    const all = this.facts.labels.map(({ label, voxels }): [string, string] => [
      String(label),
      text('{label}, {voxels, number} voxels', { label, voxels }),
    ]);
    this.label.append(...[grey, ...all].map(([value, words]) => el('option', { value }, words)));
  }

  private listen(): void {
    const { asks, state } = this;
    this.label.onchange = () =>
      asks.choose(this.label.value === '' ? { label: null } : { label: Number(this.label.value), threshold: null });
    this.threshold.oninput = () => {
      this.unsent = true;
      state.label = null;
      state.threshold = this.valueAt(this.threshold);
      state.window(state.low, state.high);
    };
    const chosen = () => {
      this.unsent = false;
      asks.choose({ threshold: state.threshold, label: null });
    };
    // Each key is a change: the surface is made when the slider rests.
    this.threshold.onchange = () => {
      window.clearTimeout(this.rest);
      this.rest = window.setTimeout(chosen, restMs);
    };
    this.take.onclick = chosen;
    this.seedHere.onclick = () => asks.choose({ seed: state.block.world(state.cross) });
    this.noSeed.onclick = () => asks.choose({ seed: null, around_mm: null });
    this.around.onchange = () =>
      asks.choose({ around_mm: this.around.value === '' ? null : Number(this.around.value) });
    const look = () => {
      const [middle, half] = [this.valueAt(this.brightness, true), this.halfWidth()];
      state.window(middle - half, middle + half);
    };
    this.brightness.oninput = this.contrast.oninput = look;
  }

  /** Bright is to the right, so values run the other way. */
  private valueAt(input: HTMLInputElement, turned = false): number {
    const { least, most } = this.facts;
    const share = Number(input.value) / steps;
    return least + (turned ? 1 - share : share) * (most - least);
  }
  private halfWidth(): number {
    const range = this.facts.most - this.facts.least;
    return Math.max(range / 512, (1 - Number(this.contrast.value) / steps) * (range / 2));
  }

  /** What the state says; without it being changed. */
  follow(): void {
    const { state, facts } = this;
    const range = Math.max(1e-9, facts.most - facts.least);
    const share = (v: number) => String(Math.round((steps * (v - facts.least)) / range));
    if (Math.abs(this.valueAt(this.threshold) - state.threshold) > range / steps)
      this.threshold.value = share(state.threshold);
    setText(this.value, fixed(state.threshold, range > 20 ? 0 : 3));
    this.threshold.setAttribute('aria-valuetext', this.value.textContent);
    this.brightness.value = String(steps - Number(share((state.low + state.high) / 2)));
    this.contrast.value = String(Math.round(steps * (1 - (state.high - state.low) / range)));
  }

  show(choices: Choices): void {
    this.label.value = choices.label === null ? '' : String(choices.label);
    this.levels.hidden = choices.label !== null;
    this.take.hidden = choices.threshold !== null;
    this.noSeed.disabled = this.around.disabled = choices.seed === null;
    this.around.value = choices.aroundMm === null ? '' : String(choices.aroundMm);
    const place = choices.seed?.map((x) => fixed(x, 1)).join(', ') ?? '';
    setText(
      this.seed,
      choices.seed
        ? text('Seed at ({place}) mm. Only what is connected with it is kept.', { place })
        : text('No seed: the largest connected piece is kept.'),
    );
    this.follow();
  }
}
