// SPDX-License-Identifier: GPL-3.0-or-later
// The running picture of the scene in a frame: `insula view`, which loads the scene again after each save and goes on
// with the one before if it has errors.
import { el, setText } from '../../hud/dom';
import { text } from '../../languages/text';
import { reason } from '../wording';
import type { SceneCopy, ScenesApi } from './api';
import { placedFrom, type Seen, viewFrom } from './seen';

const waitMs = 500;
const followMs = 1000;

export interface Hears {
  /** Where the microscope stands. */
  taken(seen: Seen): void;
  /** Where the point is after a drag, m. */
  placed(at: readonly number[]): void;
  /** The picture is there, or gone. */
  shown(on: boolean): void;
}

export class LiveView {
  readonly root = el('section', { class: 'live', 'aria-label': text('Picture of the scene') });
  readonly open = el('button', { type: 'button', class: 'main look' }, text('Look at it'));
  private readonly close = el('button', { type: 'button' }, text('Close the picture'));
  private readonly take = el('button', { type: 'button', class: 'take' }, text('Take the present view'));
  private readonly say = el('p', { role: 'status' });
  private readonly fault = el('p', { class: 'bad', role: 'alert' });
  private frame: HTMLIFrameElement | null = null;
  private ended = false;
  private readonly hear = (e: MessageEvent) => {
    if (!this.frame || e.source !== this.frame.contentWindow) return;
    const [seen, at] = [viewFrom(e.data), placedFrom(e.data)];
    if (seen) this.hears.taken(seen);
    if (at) this.hears.placed(at);
  };

  constructor(
    private readonly api: ScenesApi,
    private readonly name: string,
    private readonly scene: () => string,
    private readonly hears: Hears,
  ) {
    this.open.onclick = () => void this.start();
    this.close.onclick = () => void this.leave();
    this.take.onclick = () => this.tell({ insula: 'where' });
    this.root.append(el('div', { class: 'buttons' }, this.take, this.close, this.say), this.fault);
    this.root.hidden = true;
    window.addEventListener('message', this.hear);
  }

  private tell(message: object): void {
    this.frame?.contentWindow?.postMessage(message, new URL(this.frame.src).origin);
  }

  /** Lets a point be moved with the mouse, m; null: none. */
  place(at: readonly number[] | null): void {
    this.tell({ insula: 'place', at });
    if (at) setText(this.say, text('Drag an arrow or a square of the point.'));
  }

  end(): void {
    this.ended = true;
    window.removeEventListener('message', this.hear);
    if (this.frame) void this.api.leave(this.name).catch(() => undefined);
  }

  private async start(): Promise<void> {
    this.open.disabled = true;
    this.root.hidden = false;
    setText(this.say, text('The picture is being started …'));
    try {
      let copy = await this.api.look(this.name, this.scene());
      while (!this.ended && copy.look.state === 'starting') {
        await new Promise((r) => setTimeout(r, waitMs));
        copy = await this.api.scene(this.name);
      }
      this.show(copy);
    } catch (e) {
      setText(this.say, reason(e));
    }
    this.open.disabled = this.frame !== null;
  }

  private show({ look }: SceneCopy): void {
    if (look.state !== 'running' || !/^https?:\/\//.test(look.url)) {
      setText(this.say, look.error === '' ? text('The picture did not start.') : reason(new Error(look.error)));
      return;
    }
    setText(this.say, text('It is loaded again whenever the scene is saved.'));
    this.frame?.remove();
    // What is wrong is told by the list of problems.
    this.frame = el('iframe', { src: `${look.url}?nohud`, title: text('Picture of the scene') });
    this.root.append(this.frame);
    this.hears.shown(true);
    void this.follow(this.frame);
  }

  /** Tells when the picture has ended. */
  private async follow(frame: HTMLIFrameElement): Promise<void> {
    while (!this.ended && this.frame === frame) {
      const look = await this.api.scene(this.name).then(
        (copy) => copy.look,
        () => null,
      );
      const fault =
        !look || this.frame !== frame ? '' : look.state === 'ended' ? text('The picture has ended.') : look.error;
      setText(this.fault, fault);
      await new Promise((r) => setTimeout(r, followMs));
    }
  }

  private async leave(): Promise<void> {
    this.frame?.remove();
    this.frame = null;
    setText(this.fault, '');
    this.hears.shown(false);
    this.root.hidden = true;
    this.open.disabled = false;
    await this.api.leave(this.name).catch(() => undefined);
  }
}
