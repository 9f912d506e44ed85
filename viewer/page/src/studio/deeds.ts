// SPDX-License-Identifier: GPL-3.0-or-later
// What an author does to a project. One request goes after the other, and a change of choices is made of what the
// answer before it says. So two quick changes of one list both stay.
import type { Act, Choices, Project } from './api';

/** New values of choices, or what makes them of the present ones. */
export type Change = object | ((now: Choices) => object);

export interface Gateway {
  project(): Promise<Project>;
  act(act: Act, more: object): Promise<Project>;
}

export class Deeds {
  private last: Promise<unknown> = Promise.resolve();
  private now: Project | null = null;
  private begun = 0;
  private done = 0;

  /** told: gets each answer, and whether it is that to a deed; failed: why there is none. */
  constructor(
    private readonly gateway: Gateway,
    private readonly told: (project: Project, ofDeed: boolean) => void,
    private readonly failed: (e: unknown) => void,
  ) {}

  /** null: it was refused. */
  act(act: Act, more: object = {}): Promise<Project | null> {
    return this.queue(() => this.gateway.act(act, more));
  }

  choose(change: Change): Promise<Project | null> {
    return this.queue(async () => {
      const choices =
        typeof change === 'function' ? (change((this.now ??= await this.gateway.project()).choices) as object) : change;
      return this.gateway.act('choose', { choices });
    });
  }

  /** How the project is. What was asked before a deed, and is answered after it, tells of the past. */
  async follow(): Promise<void> {
    const { begun } = this;
    if (begun !== this.done) return;
    try {
      const project = await this.gateway.project();
      if (begun === this.begun) this.take(project, false);
    } catch (e) {
      if (begun === this.begun) this.failed(e);
    }
  }

  private queue(deed: () => Promise<Project>): Promise<Project | null> {
    this.begun++;
    const run = async () => {
      try {
        const project = await deed();
        this.take(project, true);
        return project;
      } catch (e) {
        this.failed(e);
        return null;
      } finally {
        this.done++;
      }
    };
    const next = this.last.then(run);
    this.last = next;
    return next;
  }

  private take(project: Project, ofDeed: boolean): void {
    this.now = project;
    this.told(project, ofDeed);
  }
}
