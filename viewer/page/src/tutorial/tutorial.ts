// SPDX-License-Identifier: GPL-3.0-or-later
// The first-use tour on the page: looks at each frame, and shows its panel.
import type { Microscope } from '../camera';
import { browserStore } from '../browser_store';
import type { Bundle } from '../bundle_types';
import type { RenderFrame } from '../lcm';
import { see } from './steps';
import { Tour } from './tour';
import { TourPanel } from './tour_panel';

export class Tutorial {
  readonly tour = new Tour(browserStore());
  readonly panel: TourPanel;
  private bundle: Bundle | null = null;

  constructor(
    private readonly scope: Microscope,
    field: HTMLElement,
  ) {
    this.panel = new TourPanel(this.tour, field);
  }

  begin(bundle: Bundle): void {
    this.bundle = bundle;
    this.tour.begin(bundle);
  }

  /** practises: hands may be moved, and nothing is judged. */
  update(frame: RenderFrame | null, practises: boolean, nowMs: number): void {
    if (frame && this.bundle && this.tour.see(see(frame, this.bundle, this.scope))) this.panel.praise(nowMs);
    this.panel.show(practises && frame !== null, nowMs);
    this.panel.button.hidden = !practises;
  }
}
