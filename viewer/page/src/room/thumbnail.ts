// SPDX-License-Identifier: GPL-3.0-or-later
// A small picture of the trainee's page for the overview of stations. It is read back only when the gateway asks for
// one, since reading it back costs time of the page. The gateway takes it only from pages on its own machine; a page
// that is refused sends no more.

const wide = 320;

export class Thumbnail {
  private wanted = false;
  private open: boolean;
  private readonly small = document.createElement('canvas');

  constructor(
    private readonly url: string,
    sends: boolean,
    private readonly taken: () => void,
  ) {
    this.open = sends;
  }

  /** The next picture is sent. */
  want(): void {
    this.wanted = true;
  }

  /** Right after the picture was drawn, while the canvas still has it. */
  take(canvas: HTMLCanvasElement): void {
    if (!this.open || !this.wanted || canvas.width === 0) return;
    this.wanted = false;
    this.taken();
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
      // The gateway is away for a moment; it asks again.
    }
  }
}
