// SPDX-License-Identifier: GPL-3.0-or-later
// A recorded session in memory: what it says of itself, its scene, pictures and timeline. Times are seconds since the
// recording began.
import type { BundleSource } from '../bundle';
import { Container, ContainerError, unpacked } from './container';
import { Pictures } from './pictures';
import { Timeline } from './timeline';

const bundlePrefix = 'bundle/';

/** The viewer's scene bundle inside the recording. */
class RecordedBundle implements BundleSource {
  constructor(private readonly container: Container) {}

  address(name: string): string {
    const type = name.endsWith('.svg') ? 'image/svg+xml' : 'application/octet-stream';
    return URL.createObjectURL(new Blob([this.bytes(name)], { type }));
  }

  read(name: string): Promise<ArrayBuffer> {
    return Promise.resolve(this.bytes(name).buffer);
  }

  private bytes(name: string): Uint8Array<ArrayBuffer> {
    const packed = this.container.attachments.get(`${bundlePrefix}${name}.zst`);
    if (!packed) throw new ContainerError(`${name} is missing in the recording`);
    return Uint8Array.from(unpacked(packed));
  }
}

export class RecordedSession {
  readonly title: string;
  readonly began: string;
  readonly pictures: Pictures;
  readonly timeline: Timeline;
  readonly durationS: number;
  readonly bundle: BundleSource;
  private readonly container: Container;

  /** Throws ContainerError when the bytes are no session, or one without pictures. */
  constructor(
    readonly name: string,
    bytes: Uint8Array,
  ) {
    this.container = new Container(bytes);
    const about = this.container.metadata.get('session');
    if (!about) throw new ContainerError('the recording does not say which scene it has');
    if (!this.container.attachments.has(`${bundlePrefix}scene.json.zst`))
      throw new ContainerError('this recording has no pictures; it was made by an earlier version');
    this.title = about.get('title') ?? '';
    this.began = about.get('began') ?? '';
    this.pictures = new Pictures(this.container);
    this.timeline = new Timeline(this.container);
    this.timelineChunks = this.container.unpackedChunks;
    this.durationS = this.container.chunks.reduce((t, c) => Math.max(t, c.lastS), 0);
    this.bundle = new RecordedBundle(this.container);
  }

  /** What of the file cannot be shown, one line each. */
  get damage(): readonly string[] {
    return this.container.damage;
  }
  /** Chunks of the file that were unpacked until now, and those that the timeline needs. */
  get unpackedChunks(): number {
    return this.container.unpackedChunks;
  }
  readonly timelineChunks: number;
  get ended(): boolean {
    return this.container.ended;
  }
}
