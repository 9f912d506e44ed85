// SPDX-License-Identifier: GPL-3.0-or-later
// What the exercise's page has of the room: talk, strokes over the picture, and the picture for the overview.
import './talk.css';
import type { Connection } from '../connection';
import type { Role } from '../options';
import type { Stage } from '../stage';
import { status } from '../status';
import type { StereoMode } from '../stereo_modes';
import type { Drawing, RoomMessage } from './messages';
import { Overlay } from './overlay';
import { Pencil } from './pencil';
import { Strokes } from './strokes';
import { TalkPanel } from './talk_panel';
import { Thumbnail } from './thumbnail';
import { Voice } from './voice';
import { VoicePanel } from './voice_panel';

export class RoomDesk {
  readonly strokes = new Strokes();
  private readonly overlay = new Overlay();
  private readonly talk: TalkPanel;
  private readonly thumbnail: Thumbnail;
  private sideBySide = false;
  private presenting = false;
  private readonly voice: { call: Voice; panel: VoicePanel } | null = null;

  constructor(
    private readonly stage: Stage,
    hudRoot: HTMLElement,
    link: () => Connection,
    private readonly role: Role,
  ) {
    const send = (m: Drawing) => {
      link().sendRoom(m);
      this.take(m);
    };
    const { canvas, scope } = stage;
    canvas.after(this.overlay.canvas, ...this.overlay.rings);
    const sight = { camera: scope.camera, focus: () => scope.target, pick: (x: number, y: number) => stage.pick(x, y) };
    const pencil = new Pencil(this.overlay.canvas, sight, send);
    this.talk = new TalkPanel(role, {
      say: (text) => link().sendRoom({ kind: 'say', text }),
      pencil: (mode) => pencil.set(mode),
      clear: () => send({ kind: 'clear' }),
    });
    const column = hudRoot.querySelector(role === 'instructor' ? '.column.right' : '.column.left');
    column?.append(this.talk.root);
    this.thumbnail = new Thumbnail(new URL('api/station/picture', location.href).href, role === 'trainee', () => {
      status.thumbnails++;
    });
    if (role === 'observer') return;
    const voice = new Voice(role, (m) => link().sendRoom(m));
    this.voice = { call: voice, panel: new VoicePanel(voice, () => this.talk.show()) };
    this.talk.below.append(this.voice.panel.root);
    hudRoot.append(this.voice.panel.sign);
  }

  hear(m: RoomMessage): void {
    if (m.kind === 'say') this.talk.add(m.from, m.text);
    else if (m.kind === 'voice') this.voice?.call.hear(m);
    else if (m.kind === 'picture') this.thumbnail.want();
    else if (m.kind === 'pages') this.others(this.role === 'instructor' ? m.trainees : m.instructors);
    else this.take(m);
  }

  reconnected(): void {
    this.voice?.call.reconnected();
  }

  /** How many pages of the other side there are. */
  private others(count: number): void {
    this.voice?.panel.setOthers(count);
    if (count > 0 && this.role === 'trainee') this.talk.show();
  }

  /** Strokes lie in the field of the scene that they were drawn in. */
  showScene(): void {
    this.take({ kind: 'clear' });
  }

  private take(m: Drawing): void {
    this.strokes.take(m, performance.now());
    this.show();
    status.strokes = this.strokes.list.length;
    if (m.kind === 'stroke') status.stroke_ms = performance.timeOrigin + performance.now();
  }

  /** After each picture. */
  draw(mode: StereoMode, presenting: boolean): void {
    this.sideBySide = mode === 'sbs';
    this.presenting = presenting;
    if (!presenting) this.thumbnail.take(this.stage.canvas);
    this.show();
  }

  /** At once, not only with the next picture: a page that draws slowly would show late where somebody points. */
  private show(): void {
    if (this.presenting) return; // a headset has pictures of its own
    this.overlay.draw(this.strokes, this.stage.scope.camera, this.sideBySide, performance.now());
  }
}
