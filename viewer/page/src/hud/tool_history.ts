// SPDX-License-Identifier: GPL-3.0-or-later
// Which tool a hand had before its last exchange.

export class ToolHistory {
  private now = '';
  private last = '';

  /** id of the tool in hand; '': none, as for a moment within an exchange. */
  see(tool: string): void {
    if (tool === '' || tool === this.now) return;
    this.last = this.now;
    this.now = tool;
  }

  get held(): string {
    return this.now;
  }

  /** What an exchange would be undone to; '': there was none. */
  get before(): string {
    return this.last === this.now ? '' : this.last;
  }

  /** The hand begins anew. */
  forget(): void {
    this.now = this.last = '';
  }
}
