// SPDX-License-Identifier: GPL-3.0-or-later
// The first-use tour on the page: looks at each frame, and shows its panel.
import type { Microscope } from '../camera';
import { browserStore } from '../browser_store';
import type { Bundle } from '../bundle_types';
import type { RenderFrame, SimEvent } from '../lcm';
import { see } from './steps';
import { Tour } from './tour';
import { TourPanel } from './tour_panel';

export class Tutorial {
  readonly tour = new Tour(browserStore());
  readonly panel: TourPanel;
  private bundle: Bundle | null = null;
  private loads = 0;

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

  hear(e: Pick<SimEvent, 'kind'>): void {
    if (e.kind === 'clip_loaded') this.loads++;
  }

  /** practises: hands may be moved, and nothing is judged. */
  update(frame: RenderFrame | null, practises: boolean, nowMs: number): void {
    if (frame && this.bundle) {
      const now = see(frame, this.bundle, this.scope, this.loads);
      if (this.tour.see(now)) this.panel.praise(nowMs);
    }
    this.panel.show(practises && frame !== null, nowMs);
    this.panel.button.hidden = !practises;
  }
}
