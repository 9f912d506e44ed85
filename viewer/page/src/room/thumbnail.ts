// SPDX-License-Identifier: GPL-3.0-or-later
// A small picture of the trainee's page for the overview of stations, every few seconds. The gateway takes it only from
// pages on its own machine; a page that is refused sends no more.

const everyMs = 3000;
const wide = 320;

export class Thumbnail {
  private sentMs = -everyMs;
  private open: boolean;
  private readonly small = document.createElement('canvas');

  constructor(
    private readonly url: string,
    sends: boolean,
  ) {
    this.open = sends;
  }

  /** Right after the picture was drawn, while the canvas still has it. */
  take(canvas: HTMLCanvasElement, nowMs: number): void {
    if (!this.open || nowMs - this.sentMs < everyMs || canvas.width === 0) return;
    this.sentMs = nowMs;
    const { small } = this;
    small.width = wide;
    small.height = Math.min(wide, Math.round((wide * canvas.height) / canvas.width));
    small.getContext('2d')!.drawImage(canvas, 0, 0, small.width, small.height);
    small.toBlob((jpeg) => void this.send(jpeg), 'image/jpeg', 0.7);
  }

  private async send(jpeg: Blob | null): Promise<void> {
    if (!jpeg) return;
    try {
      const answer = await fetch(this.url, { method: 'PUT', headers: { 'Content-Type': 'image/jpeg' }, body: jpeg });
      if (answer.status >= 400 && answer.status < 500) this.open = false;
    } catch {
      // The gateway is away for a moment; the next picture tells.
    }
  }
}
