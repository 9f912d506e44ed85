// SPDX-License-Identifier: GPL-3.0-or-later
// The scan of a project: read by the case builder, then shown with its slices; or why that was not possible.
import { el, setText } from '../../hud/dom';
import { text } from '../../languages/text';
import type { Project, StudioApi } from '../api';
import type { Asks } from '../editor';
import { forThePage, reason } from '../wording';
import { Block, type ScanFacts } from './block';
import { BrushPanel } from './brush_panel';
import { ScanPanel } from './scan_panel';
import { ScanView } from './scan_view';

export class ScanStep {
  /** Beside the steps. */
  readonly view = el('div', { class: 'scan-place' });
  readonly root = el('div', {});
  private readonly say = el('p', { role: 'status' });
  private readonly again = el('button', { type: 'button' }, text('Try again'));
  private panel: ScanPanel | null = null;
  private brush: BrushPanel | null = null;
  private shown: ScanView | null = null;
  private loading = false;
  private ended = false;

  constructor(
    private readonly asks: Asks,
    private readonly api: StudioApi,
  ) {
    this.again.onclick = () => void asks.act('again');
    this.root.append(el('section', { class: 'scan-say' }, this.say, this.again));
  }

  end(): void {
    this.ended = true;
    this.shown?.end();
  }

  show(p: Project): void {
    this.root.hidden = p.scan === null;
    if (!p.scan) return;
    const { work, facts } = p.scan;
    const bad = work.state === 'failed' || work.state === 'cancelled';
    this.root.firstElementChild!.toggleAttribute('hidden', work.state === 'done' && this.shown !== null);
    this.again.hidden = !bad;
    this.say.className = bad ? 'bad' : '';
    setText(
      this.say,
      bad ? forThePage(work.error) : text('The scan is being read … {percent} %', { percent: work.percent }),
    );
    if (facts && !this.shown) void this.load(p, facts);
    // What the author moves just now is newer than what the gateway says.
    if (this.shown && !this.panel?.unsent && JSON.stringify(p.choices) !== this.choices) this.take(p);
  }

  private choices = '';
  private take(p: Project): void {
    this.choices = JSON.stringify(p.choices);
    this.shown?.state.take(p.choices);
    this.panel?.show(p.choices);
    this.brush?.show(p.choices);
  }

  private async load(p: Project, facts: ScanFacts): Promise<void> {
    if (this.loading) return;
    this.loading = true;
    try {
      const bytes = await (await fetch(this.api.file(p.name, 'scan', 1))).arrayBuffer();
      if (this.ended) return;
      this.shown = new ScanView(
        Block.of(facts, bytes),
        () => this.panel?.follow(),
        (stroke) => void this.asks.choose((now) => ({ paint: [...now.paint, stroke] })),
      );
      this.panel = new ScanPanel(this.asks, facts, this.shown.state);
      this.view.replaceChildren(this.shown.root);
      this.brush = new BrushPanel(this.asks, this.shown.state);
      this.root.append(this.panel.root, this.brush.root);
      this.root.firstElementChild!.toggleAttribute('hidden', true);
      this.take(p);
    } catch (e) {
      setText(this.say, reason(e));
    }
  }
}
