// SPDX-License-Identifier: GPL-3.0-or-later
// A recorded session: what it says of itself, its scene, pictures and timeline. Times are seconds since the
// recording began.
import type { BundleSource } from '../bundle';
import type { ByteSource } from './byte_source';
import { Container, unpacked } from './container';
import { ContainerError } from './mcap_records';
import { Pictures } from './pictures';
import { Timeline } from './timeline';
import { said } from '../languages/said';
import { text } from '../languages/text';

const bundlePrefix = 'bundle/';

/** The viewer's scene bundle inside the recording. */
class RecordedBundle implements BundleSource {
  constructor(private readonly container: Container) {}

  async address(name: string): Promise<string> {
    const type = name.endsWith('.svg') ? 'image/svg+xml' : 'application/octet-stream';
    return URL.createObjectURL(new Blob([await this.read(name)], { type }));
  }

  async read(name: string): Promise<ArrayBuffer> {
    return Uint8Array.from(unpacked(await this.container.attachment(`${bundlePrefix}${name}.zst`))).buffer;
  }
}

export class RecordedSession {
  readonly title: string;
  readonly began: string;
  readonly pictures: Pictures;
  readonly durationS: number;
  readonly bundle: BundleSource;
  private read: Timeline | null = null;

  /** Throws ContainerError when the bytes are no session, or one without pictures. */
  static async open(name: string, source: ByteSource): Promise<RecordedSession> {
    const container = await Container.open(source);
    const about = container.metadata.get('session');
    if (!about) throw new ContainerError(text('the recording does not say which scene it has'));
    if (!container.has(`${bundlePrefix}scene.json.zst`))
      throw new ContainerError(text('this recording has no pictures; it was made by an earlier version'));
    return new RecordedSession(name, about, container);
  }

  private constructor(
    readonly name: string,
    about: ReadonlyMap<string, string>,
    private readonly container: Container,
  ) {
    this.title = said(about.get('title') ?? '');
    this.began = about.get('began') ?? '';
    this.pictures = new Pictures(container);
    this.durationS = this.container.chunks.reduce((t, c) => Math.max(t, c.lastS), 0);
    this.bundle = new RecordedBundle(this.container);
  }

  /** Reads what the timeline has, which may lie all over the file. */
  async readTimeline(): Promise<void> {
    const before = this.container.unpackedChunks;
    this.read = await Timeline.read(this.container);
    this.timelineChunks = this.container.unpackedChunks - before;
  }

  /** Throws before it has been read. */
  get timeline(): Timeline {
    if (!this.read) throw new Error('the timeline has not been read');
    return this.read;
  }

  /** What of the file cannot be shown, one line each. */
  get damage(): readonly string[] {
    return this.container.damage;
  }
  /** Chunks of the file that were unpacked until now, and those that the timeline needs. */
  get unpackedChunks(): number {
    return this.container.unpackedChunks;
  }
  timelineChunks = 0;
  get ended(): boolean {
    return this.container.ended;
  }
}
