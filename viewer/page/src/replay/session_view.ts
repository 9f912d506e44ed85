// SPDX-License-Identifier: GPL-3.0-or-later
// The field of a recorded session at any time, in a canvas of its own.
import * as THREE from 'three';
import { loadBundle } from '../bundle';
import type { Bundle } from '../bundle_types';
import { Graphics } from '../graphics';
import type { QualityName } from '../options';
import { Playback } from '../playback';
import { levels, QualityWatch } from '../quality';
import { softwareAdvice } from '../software_rendering';
import { Stage } from '../stage';
import { Reading } from '../step_data/reading';
import { Unveiling } from '../unveiling';
import { vector, World } from '../world';
import { ForceArrows } from './force_arrows';
import type { Moment } from './pictures';
import type { RecordedSession } from './session';

/** Of the first picture after a jump, on slow machines: pixels each way, and how far its surfaces are off, m. */
const soonScale = 0.4;
const soonCoarseM = 2.5e-4;
/**
 * A software renderer compiles each program when it is first drawn into a picture of another kind, and again once its
 * final form was linked in the background. A jump would wait for it, for up to half a second. So pictures of jumps to
 * that many times, spread over the recording, are drawn before.
 */
const rehearsalCount = 16;

export class SessionView {
  readonly stage: Stage;
  readonly reading = new Reading();
  readonly arrows = new ForceArrows();
  readonly graphics: Graphics;
  world: World | null = null;
  /** The picture that is shown; null: none. */
  moment: Moment | null = null;
  /** Draws plumb lines and contact marks. */
  cues = true;
  /** From the page's start until there was a picture. */
  firstPictureMs = 0;
  /** What the first pictures leave out; null: nothing. */
  private unveiling: Unveiling | null = null;
  /** Still to be done. */
  private rehearsals = rehearsalCount;
  private session: RecordedSession | null = null;
  private readonly playback = new Playback();
  private readonly watch: QualityWatch;

  constructor(canvas: HTMLCanvasElement, quality: QualityName | null) {
    this.stage = new Stage(canvas);
    const advice = softwareAdvice(this.stage.renderer.getContext());
    this.watch = new QualityWatch(quality, advice === '' ? 'high' : 'draft');
    this.stage.scene.add(this.arrows.root);
    this.graphics = new Graphics(canvas, () => {
      if (this.world) this.world.setEnvironment(this.stage.light(vector(this.world.bundle.view.up)));
    });
  }

  /** Builds the recorded scene. Throws if the recording lacks a part of it. */
  async open(session: RecordedSession): Promise<Bundle> {
    const bundle = await loadBundle(session.bundle, session.name);
    this.session = session;
    this.stage.scope.setHome(bundle.view);
    this.reading.begin(bundle);
    this.build(bundle);
    this.unveiling = new Unveiling(this.world!.later);
    return bundle;
  }

  /** What the recording has at a time; null: no picture there that can be read. */
  async find(timeS: number): Promise<Moment | null> {
    return (await this.session?.pictures.at(timeS)) ?? null;
  }

  /** False: there is nothing to show. */
  show(moment: Moment | null): boolean {
    this.moment = moment;
    if (!moment) return false;
    const { before, after, share } = moment;
    this.playback.hold(before.frame, after.frame, share);
    this.reading.read(share > 0.5 ? after.frame : before.frame);
    return true;
  }

  /**
   * dtS: of the wall clock, for what glides and fades. settled: what fades has done so. soon: fewer pixels on slow
   * machines.
   */
  draw(nowMs: number, dtS: number, { settled = true, soon = false } = {}): void {
    this.stage.update(dtS, 'off', false);
    this.updateWorld(nowMs, settled);
    const unveiling = this.firstPictureMs > 0 ? this.unveiling : null;
    unveiling?.begin();
    const soonest = soon && this.cheap;
    this.world?.setCoarse(soonest ? soonCoarseM : levels[this.watch.level]!.coarseM);
    this.stage.render('off', 0, soonest ? soonScale : 1);
    if (unveiling?.end() === false) this.unveiling = null;
  }

  /** Draws the picture of a jump elsewhere, and shows nothing. The time of the next picture has to be set anew. */
  async rehearse(): Promise<void> {
    if (!this.rehearses || !this.session) return;
    const share = (this.rehearsals - 0.5) / rehearsalCount;
    this.rehearsals--;
    if (!this.show(await this.find(share * this.session.durationS))) return;
    this.updateWorld(performance.now(), true);
    this.world?.setCoarse(soonCoarseM);
    this.stage.rehearse(soonScale);
  }

  /** The first picture, of plain tissue and walls. What else the scene has appears in the next ones. */
  async drawFirst(timeS: number): Promise<void> {
    this.show(await this.find(timeS));
    this.draw(performance.now(), 0);
    // Until the browser has shown it.
    await new Promise((resolve) => requestAnimationFrame(() => setTimeout(resolve)));
    this.firstPictureMs = performance.now();
    this.world?.shade();
  }

  /** A further picture differs from the last one, whatever a person does. */
  get moves(): boolean {
    return this.unveiling !== null || this.stage.scope.gliding;
  }

  /** Everything that the scene has is drawn, and a jump waits for no program. */
  get complete(): boolean {
    return this.unveiling === null && !this.rehearses;
  }

  /** Once a second; steps the quality down on a slow machine. */
  observe(fps: number, seconds: number): void {
    if (document.visibilityState === 'visible' && !this.graphics.lost && this.watch.observe(fps, seconds))
      this.applyQuality();
  }

  private get rehearses(): boolean {
    return this.cheap && this.unveiling === null && this.rehearsals > 0;
  }

  private get cheap(): boolean {
    return levels[this.watch.level]!.cheap;
  }

  private updateWorld(nowMs: number, settled: boolean): void {
    if (!this.world || !this.moment) return;
    this.world.cues.choice = { plumb: this.cues, ruler: 'off', hand: 1, within: null };
    this.world.update(this.playback, nowMs, this.reading.channels, this.stage.scope.sight, settled);
    this.arrows.update(this.moment, this.world.bundle);
  }

  private applyQuality(): void {
    const level = levels[this.watch.level]!;
    this.stage.setLevel(level);
    this.world?.setLevel(level);
  }

  private build(bundle: Bundle): void {
    this.world?.dispose();
    const room: THREE.Texture = this.stage.light(vector(bundle.view.up));
    this.world = new World(bundle, this.stage.scope.fieldAxis, room);
    this.stage.scene.add(this.world.root);
    this.applyQuality();
  }
}
