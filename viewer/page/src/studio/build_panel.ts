// SPDX-License-Identifier: GPL-3.0-or-later
// Building the case: how far it is, what went wrong, and the same as a command.
import { el, setText } from '../hud/dom';
import { text } from '../languages/text';
import type { Project, Work } from './api';
import type { Asks } from './editor';
import { forThePage } from './wording';

const stages = ['intake', 'wall', 'place', 'scenes', 'report'];

function stageText(stage: string): string {
  switch (stage) {
    case 'intake':
      return text('Read the surface');
    case 'wall':
      return text('Make the wall');
    case 'place':
      return text('Place it in the fissure');
    case 'scenes':
      return text('Write the exercises');
    default:
      return text('Measure');
  }
}

export class BuildPanel {
  readonly root: HTMLElement;
  private readonly build = el('button', { type: 'button', class: 'main build' }, text('Build'));
  private readonly cancel = el('button', { type: 'button' }, text('Cancel'));
  private readonly bar = el('progress', { max: '100', 'aria-label': text('Progress of the stage') });
  private readonly steps = el('ol', { class: 'stages' });
  private readonly say = el('p', { role: 'status' });
  private readonly command = el('code', {});

  constructor(asks: Asks) {
    this.build.onclick = () => void asks.act('build');
    this.cancel.onclick = () => void asks.act('cancel');
    this.root = el(
      'section',
      { class: 'build-step' },
      el('h3', {}, text('4. Build')),
      el('div', { class: 'buttons' }, this.build, this.cancel),
      this.steps,
      this.bar,
      this.say,
      el('details', {}, el('summary', {}, text('The same as a command')), this.command),
    );
  }

  show(p: Project): void {
    const { build } = p;
    const runs = build.state === 'running';
    this.root.hidden = !p.facts && !runs;
    this.build.disabled = runs || p.inspect.state !== 'done' || (p.facts?.openings.length ?? 0) < 2;
    this.cancel.hidden = !runs;
    this.bar.hidden = this.steps.hidden = !runs;
    this.bar.value = build.percent;
    this.steps.replaceChildren(...this.stageList(build));
    this.say.className = build.state === 'failed' ? 'bad' : build.state === 'interrupted' ? 'mended' : '';
    setText(this.say, this.words(build));
    setText(this.command, p.command);
  }

  private stageList({ stage }: Work): HTMLElement[] {
    const at = stages.indexOf(stage);
    return stages.map((s, k) => {
      const standing = k < at ? 'done' : k === at ? 'now' : 'later';
      const item = el('li', { class: standing }, stageText(s));
      if (k === at) item.setAttribute('aria-current', 'step');
      return item;
    });
  }

  private words(build: Work): string {
    switch (build.state) {
      case 'running':
        return text('{seconds, plural, one {# second} other {# seconds}}', { seconds: Math.round(build.seconds) });
      case 'failed':
        return forThePage(build.error);
      case 'cancelled':
        return text('The build was cancelled.');
      case 'interrupted':
        return text('The build was interrupted. Nothing is lost: build again.');
      default:
        return '';
    }
  }
}
