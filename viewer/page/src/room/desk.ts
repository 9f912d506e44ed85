// SPDX-License-Identifier: GPL-3.0-or-later
// What the exercise's page has of the room: talk, strokes over the picture, and the picture for the overview.
import './talk.css';
import type { Connection } from '../connection';
import type { Role } from '../options';
import type { Stage } from '../stage';
import { status } from '../status';
import type { StereoMode } from '../stereo_modes';
import type { OwnMessage, RoomMessage } from './messages';
import { Overlay } from './overlay';
import { Pencil } from './pencil';
import { Strokes } from './strokes';
import { TalkPanel } from './talk_panel';
import { Thumbnail } from './thumbnail';

export class RoomDesk {
  readonly strokes = new Strokes();
  private readonly overlay = new Overlay();
  private readonly talk: TalkPanel;
  private readonly thumbnail: Thumbnail;

  constructor(
    private readonly stage: Stage,
    hudRoot: HTMLElement,
    link: () => Connection,
    role: Role,
  ) {
    const send = (m: OwnMessage) => {
      link().sendRoom(m);
      this.take(m);
    };
    const { canvas, scope } = stage;
    canvas.after(this.overlay.canvas);
    const sight = { camera: scope.camera, focus: () => scope.target, pick: (x: number, y: number) => stage.pick(x, y) };
    const pencil = new Pencil(this.overlay.canvas, sight, send);
    this.talk = new TalkPanel(role, {
      say: (text) => link().sendRoom({ kind: 'say', text }),
      pencil: (mode) => pencil.set(mode),
      clear: () => send({ kind: 'clear' }),
    });
    const column = hudRoot.querySelector(role === 'instructor' ? '.column.right' : '.column.left');
    column?.append(this.talk.root);
    this.thumbnail = new Thumbnail(new URL('api/station/picture', location.href).href, role === 'trainee');
  }

  hear(m: RoomMessage): void {
    if (m.kind === 'say') this.talk.add(m.from, m.text);
    else this.take(m);
  }

  private take(m: OwnMessage): void {
    this.strokes.take(m, performance.now());
    status.strokes = this.strokes.list.length;
    if (m.kind === 'stroke') status.stroke_ms = performance.timeOrigin + performance.now();
  }

  /** After each picture. */
  draw(mode: StereoMode, presenting: boolean, nowMs: number): void {
    if (presenting) return; // a headset has pictures of its own
    this.thumbnail.take(this.stage.canvas, nowMs);
    this.overlay.draw(this.strokes, this.stage.scope.camera, mode === 'sbs', nowMs);
  }
}
