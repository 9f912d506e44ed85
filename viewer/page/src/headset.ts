// SPDX-License-Identifier: GPL-3.0-or-later
// WebXR: in a headset the microscope's stereo picture hangs before the head as a screen, each eye with its own
// picture, and under it the lines a trainee needs (timers, messages, the training note).
import * as THREE from 'three';
import { type Controller, readControllers } from './controller_hands';
import { Eyepiece, takeBoth, type LensSettings } from './lens';
import { text } from './languages/text';

const screenM = 1.5;
const distanceM = 1.35;
const picturePx = 1280;

export class Headset {
  readonly supported: Promise<boolean>;
  private readonly eyes = [new Eyepiece(true), new Eyepiece(true)];
  private readonly room = new THREE.Scene();
  private readonly camera = new THREE.PerspectiveCamera(70, 1, 0.05, 20);
  private readonly paper = document.createElement('canvas');
  private readonly writing = new THREE.CanvasTexture(this.paper);
  private written = '';
  private pixels = picturePx;
  private settings: LensSettings = { occlusion: false, depthOfField: false, samples: 0 };

  constructor(
    private readonly renderer: THREE.WebGLRenderer,
    private readonly ended: () => void,
  ) {
    this.supported = navigator.xr
      ? navigator.xr.isSessionSupported('immersive-vr').catch(() => false)
      : Promise.resolve(false);
    this.room.background = new THREE.Color(0x000000);
    this.eyes.forEach((eye, k) => {
      const screen = new THREE.Mesh(new THREE.PlaneGeometry(screenM, screenM), eye.material);
      screen.position.set(0, 0, -distanceM);
      // three shows layer 1 to the left eye and layer 2 to the right.
      screen.layers.set(k + 1);
      this.room.add(screen);
    });
    this.paper.width = 1024;
    this.paper.height = 160;
    const note = new THREE.Mesh(
      new THREE.PlaneGeometry(1.1, 0.172),
      new THREE.MeshBasicMaterial({ map: this.writing, toneMapped: false }),
    );
    note.position.set(0, -0.82, -distanceM + 0.08);
    note.rotation.x = -0.35;
    this.room.add(note);
  }

  get presenting(): boolean {
    return this.renderer.xr.isPresenting;
  }

  /** Those that are seen in the present picture. */
  get controllers(): Controller[] {
    const { xr } = this.renderer;
    const session = xr.isPresenting ? xr.getSession() : null;
    const room = xr.getReferenceSpace();
    const frame = session ? (xr.getFrame() as XRFrame | null) : null;
    return session && room && frame ? readControllers(session.inputSources, frame, room) : [];
  }

  /** pixel_ratio: of the quality level. */
  configure(settings: LensSettings, pixelRatio: number): void {
    this.settings = settings;
    this.pixels = Math.round(picturePx * Math.max(0.4, Math.min(1.25, pixelRatio)));
    for (const e of this.eyes) e.configure(settings);
  }

  /** Must be called from a click. Throws when the headset refuses. */
  async enter(): Promise<void> {
    if (!navigator.xr) throw new Error(text('this browser has no WebXR'));
    const session = await navigator.xr.requestSession('immersive-vr', { optionalFeatures: ['local-floor'] });
    this.renderer.xr.enabled = true;
    this.renderer.xr.setReferenceSpaceType('local');
    await this.renderer.xr.setSession(session);
    // After three's own listener: by then nothing is presented any more.
    session.addEventListener('end', () => {
      this.renderer.xr.enabled = false;
      this.ended();
    });
  }

  async leave(): Promise<void> {
    await this.renderer.xr
      .getSession()
      ?.end()
      .catch(() => undefined);
  }

  render(scene: THREE.Scene, middle: THREE.PerspectiveCamera, focus: number, angleRad: number, lines: string[]): void {
    const renderer = this.renderer;
    const headsetTarget = renderer.getRenderTarget();
    // The pictures are drawn by the microscope's cameras, not by the head's.
    renderer.xr.enabled = false;
    takeBoth(
      renderer,
      scene,
      middle,
      focus,
      angleRad,
      new THREE.Vector2(this.pixels, this.pixels),
      this.settings.samples,
      this.eyes,
    );
    renderer.xr.enabled = true;
    renderer.setRenderTarget(headsetTarget);
    this.write(lines);
    renderer.render(this.room, this.camera);
  }

  private write(lines: string[]): void {
    const text = lines.join('\n');
    if (text === this.written) return;
    this.written = text;
    const c = this.paper.getContext('2d')!;
    c.fillStyle = '#0c0f12';
    c.fillRect(0, 0, this.paper.width, this.paper.height);
    c.font = '34px sans-serif';
    c.textAlign = 'center';
    lines.slice(0, 3).forEach((line, i) => {
      c.fillStyle = i === 0 ? '#cfae6d' : '#e9edf0';
      c.fillText(line, this.paper.width / 2, 44 + i * 46, this.paper.width - 20);
    });
    this.writing.needsUpdate = true;
  }
}
