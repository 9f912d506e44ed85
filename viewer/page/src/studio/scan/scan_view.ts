// SPDX-License-Identifier: GPL-3.0-or-later
// Three slices of a scan and the vessel in it. The vessel is found in a worker; of several moves only the last one
// counts.
import { el } from '../../hud/dom';
import type { Stroke } from '../api';
import type { Block } from './block';
import { PreviewView } from './preview_view';
import type { Ask, Preview } from './preview.worker';
import { ScanState } from './scan_state';
import { SliceView } from './slice_view';

export class ScanView {
  readonly root: HTMLElement;
  readonly state: ScanState;
  private readonly slices: SliceView[];
  private readonly preview: PreviewView;
  private readonly worker = new Worker(new URL('./preview.worker.ts', import.meta.url), { type: 'module' });
  private readonly watch = new ResizeObserver(() => {
    this.previewChanged = true;
    this.draw();
  });
  private asked = '';
  private busy = false;
  private waiting = false;
  private previewChanged = false;

  constructor(
    block: Block,
    /** The crosshair or the window has moved. */
    private readonly moved: () => void,
    painted: (stroke: Stroke) => void,
  ) {
    this.state = new ScanState(block, () => this.changed(), painted);
    this.slices = ([2, 1, 0] as const).map((axis) => new SliceView(axis, this.state));
    this.preview = new PreviewView(block);
    this.root = el('div', { class: 'scan' }, ...this.slices.map((s) => s.root), this.preview.root);
    this.worker.onmessage = ({ data }: MessageEvent<Preview>) => this.take(data);
    this.tell({ stored: block.stored, size: block.size });
    this.watch.observe(this.root);
    Object.assign(window, { __scan: { found: () => this.state.found, state: this.state, busy: () => this.busy } });
    this.changed();
  }

  end(): void {
    this.watch.disconnect();
    this.worker.terminate();
    this.preview.end();
  }

  private tell(ask: Ask): void {
    this.worker.postMessage(ask);
  }

  /** Shows what the state says, and has the vessel found if another one is wanted. */
  changed(): void {
    const wanted = this.state.wanted();
    const words = JSON.stringify(wanted);
    if (words !== this.asked && !this.busy) {
      this.asked = words;
      this.busy = true;
      this.tell({ wanted });
    }
    this.draw();
    this.moved();
  }

  private take(found: Preview): void {
    this.busy = false;
    this.state.found = found;
    this.preview.show(found);
    this.previewChanged = true;
    this.changed();
  }

  /** Once a frame at most. */
  private draw(): void {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      for (const slice of this.slices) slice.draw();
      if (this.previewChanged) this.preview.draw();
      this.previewChanged = false;
    });
  }
}
