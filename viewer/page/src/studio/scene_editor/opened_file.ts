// SPDX-License-Identifier: GPL-3.0-or-later
// A file that is edited here. One request goes after the other, and each says how the file was when this page last
// heard of it. If it was changed in another window since, the gateway does nothing and answers 412.
import type { Checked, ScenesApi, Version } from './api';

export class OpenedFile {
  private last: Promise<unknown> = Promise.resolve();

  constructor(
    private readonly api: ScenesApi,
    private readonly copy: string,
    readonly file: string,
    private seen: string,
  ) {}

  get revision(): string {
    return this.seen;
  }

  write(content: string): Promise<Version[]> {
    return this.inTurn(async () => {
      const { versions, revision } = await this.api.write(this.copy, this.file, content, this.seen);
      this.seen = revision;
      return versions;
    });
  }

  /** The gateway keeps the text apart from the scene. Null: another check of this file was begun meanwhile. */
  async check(scene: string, content: string): Promise<Checked | null> {
    const wanted = await this.inTurn(async () => {
      const { number, revision } = await this.api.beginCheck(this.copy, scene, this.file, content, this.seen);
      this.seen = revision;
      return number;
    });
    return this.api.checked(this.copy, this.file, wanted);
  }

  private inTurn<T>(ask: () => Promise<T>): Promise<T> {
    const next = this.last.then(ask, ask);
    this.last = next;
    return next;
  }
}
