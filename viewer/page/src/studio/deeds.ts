// SPDX-License-Identifier: GPL-3.0-or-later
// What an author does to a project. One request goes after the other, and a change of choices is made of what the
// answer before it says. So two quick changes of one list both stay. Each request names the revision that the page
// shows. If the case was changed in another window since, nothing is done, and the author is told.
import { isRefusal, preconditionFailed } from '../start/api';
import type { Act, Choices, Project } from './api';

/** New values of choices, or what makes them of the present ones. */
export type Change = object | ((now: Choices) => object);

export interface Gateway {
  project(): Promise<Project>;
  act(act: Act, more: object): Promise<Project>;
}

/** Why a deed was not done. */
export interface Failures {
  failed(e: unknown): void;
  /** The case was changed elsewhere. again: does what was not done; null: that must be pressed again. */
  overtaken(again: (() => void) | null): void;
}

interface Deed {
  act: Act;
  more(now: Choices): object;
}

export class Deeds {
  private last: Promise<unknown> = Promise.resolve();
  private now: Project | null = null;
  private begun = 0;
  private done = 0;
  /** Changes of others that were shown. */
  private ofOthers = 0;
  /** ofOthers when a hand began; null: none is at work. */
  private atBegin: number | null = null;
  /** Times that the author was told that a deed was overtaken, and the deeds that were lost the last time. */
  private overtakings = 0;
  private lost: Deed[] = [];

  /** told: gets each answer, and whether it is that to a deed. */
  constructor(
    private readonly gateway: Gateway,
    private readonly told: (project: Project, ofDeed: boolean) => void,
    private readonly failures: Failures,
  ) {}

  /** null: it was refused. */
  act(act: Act, more: object = {}): Promise<Project | null> {
    return this.queue({ act, more: () => more });
  }

  choose(change: Change): Promise<Project | null> {
    const choices = (now: Choices): object => (typeof change === 'function' ? (change(now) as object) : change);
    return this.queue({ act: 'choose', more: (now) => ({ choices: choices(now) }) });
  }

  /** A hand begins what will be a deed: a drag, a text. What others change from now on overtakes it. */
  begin(): void {
    this.atBegin ??= this.ofOthers;
  }

  end(): void {
    this.atBegin = null;
  }

  /** How the project is. What was asked before a deed, and is answered after it, tells of the past. */
  async follow(): Promise<void> {
    const { begun } = this;
    if (begun !== this.done) return;
    try {
      const project = await this.gateway.project();
      if (begun !== this.begun) return;
      if (this.now && this.now.revision !== project.revision) this.ofOthers++;
      this.take(project, false);
    } catch (e) {
      if (begun === this.begun) this.failures.failed(e);
    }
  }

  private queue(deed: Deed): Promise<Project | null> {
    this.begun++;
    const { overtakings } = this;
    const unseen = this.atBegin !== null && this.atBegin !== this.ofOthers;
    const run = async () => {
      try {
        // What was asked for before the author was told was meant for the case as it had been.
        if (overtakings !== this.overtakings) return this.lose(deed);
        return (unseen ? null : await this.asked(deed)) ?? (await this.overtaken(deed));
      } catch (e) {
        this.failures.failed(e);
        return null;
      } finally {
        this.done++;
      }
    };
    const next = this.last.then(run);
    this.last = next;
    return next;
  }

  /** null: it was overtaken. */
  private async asked(deed: Deed): Promise<Project | null> {
    const now = (this.now ??= await this.gateway.project());
    try {
      const project = await this.gateway.act(deed.act, { ...deed.more(now.choices), revision: now.revision });
      this.take(project, true);
      return project;
    } catch (e) {
      if (isRefusal(e, preconditionFailed)) return null;
      throw e;
    }
  }

  private async overtaken(deed: Deed): Promise<null> {
    this.take(await this.gateway.project(), true);
    this.overtakings++;
    this.lost = [];
    if (this.atBegin !== null) this.atBegin = this.ofOthers;
    return this.lose(deed);
  }

  /** Changes can be made again, of what is there now. An undo or a build is for the author to look at first. */
  private lose(deed: Deed): null {
    const lost = [...this.lost, deed];
    this.lost = lost;
    const again = () => lost.forEach((one) => void this.queue(one));
    this.failures.overtaken(lost.every(({ act }) => act === 'choose') ? again : null);
    return null;
  }

  private take(project: Project, ofDeed: boolean): void {
    this.now = project;
    this.told(project, ofDeed);
  }
}
