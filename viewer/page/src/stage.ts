// SPDX-License-Identifier: GPL-3.0-or-later
// The renderer with its scene, microscope and lens, and how much effort a quality level puts into them.
import * as THREE from 'three';
import { Microscope } from './camera';
import { answerTheFrame } from './framed';
import { Lens } from './lens';
import { makeEnvironment, plainRoom } from './materials/environment';
import type { Level } from './quality';
import type { StereoMode } from './stereo_modes';
import { text } from './languages/text';

/** Share of the room's light that reaches the field. */
const roomIntensity = 0.42;

/** Between two questions to the graphics card. */
const pollMs = 2;

/** What is seen through a gap between the tissues: the depth of the field, not a hole. */
const depths = { eye: new THREE.Color(0x38100c), infrared: new THREE.Color(0x020303) };

export class Stage {
  readonly renderer: THREE.WebGLRenderer;
  readonly scene = new THREE.Scene();
  readonly scope = new Microscope();
  private readonly lens: Lens;
  private readonly plain = plainRoom();
  private room: THREE.Texture | null = null;
  /** Of the last picture, until the graphics card is done with it. */
  private fence: WebGLSync | null = null;
  private drawn = 0;
  private doneUpTo = 0;

  constructor(readonly canvas: HTMLCanvasElement) {
    this.renderer = makeRenderer(canvas);
    this.scene.background = depths.eye;
    this.scene.environmentIntensity = roomIntensity;
    this.plain.intensity = Math.PI * roomIntensity;
    this.scope.addTo(this.scene);
    this.scene.add(this.plain);
    this.lens = new Lens(this.renderer);
    answerTheFrame(this);
  }

  /** Of the last picture, shadows included. */
  get triangles(): number {
    return this.lens.triangles;
  }

  /** Draw calls of the last picture, shadows included. */
  get calls(): number {
    return this.lens.calls;
  }

  /** The room that metal mirrors, anew. */
  light(up: THREE.Vector3): THREE.Texture {
    const old = this.room;
    const room = makeEnvironment(this.renderer, this.scope.fieldAxis, up);
    if (!this.plain.visible) this.scene.environment = room;
    this.plain.position.copy(this.scope.fieldAxis);
    this.room = room;
    old?.dispose();
    return room;
  }

  setInfrared(on: boolean): void {
    this.scene.background = on ? depths.infrared : depths.eye;
  }

  setLevel(level: Level): void {
    const { renderer } = this;
    this.scene.environment = level.cheap ? null : this.room;
    this.plain.visible = level.cheap;
    renderer.setPixelRatio(Math.min(window.devicePixelRatio * Math.min(1, level.pixelRatio), level.pixelRatio));
    this.lens.configure(level.lens);
    const lamp = this.scope.lamp;
    const shadow = lamp.shadow;
    const shadows = level.shadowSize > 0;
    if (renderer.shadowMap.enabled !== shadows) {
      renderer.shadowMap.enabled = shadows;
      this.scene.traverse((o) => {
        if (o instanceof THREE.Mesh) (o.material as THREE.Material).needsUpdate = true;
      });
    }
    lamp.castShadow = shadows;
    if (!shadows || shadow.mapSize.x === level.shadowSize) return;
    shadow.mapSize.set(level.shadowSize, level.shadowSize);
    shadow.map?.dispose();
    shadow.map = null;
  }

  /** Follows the window's size and moves the microscope on; presenting: a headset has its own size. */
  update(dt: number, mode: StereoMode, presenting: boolean): void {
    const wide = this.canvas.clientWidth;
    const high = this.canvas.clientHeight;
    const size = this.renderer.getSize(new THREE.Vector2());
    if (!presenting && (size.x !== wide || size.y !== high)) this.renderer.setSize(wide, high, false);
    const halves = mode === 'sbs' && !presenting ? 2 : 1;
    this.scope.update(dt, presenting ? 1 : wide / halves / Math.max(1, high));
  }

  /** scale: of the picture in pixels each way; below 1, for one that has to come soon, the old shadows stay. */
  render(mode: StereoMode, angleRad: number, scale = 1): void {
    this.renderer.shadowMap.autoUpdate = scale === 1;
    this.lens.render(this.scene, this.scope.camera, this.scope.distance, mode, angleRad, scale);
    this.fenceNow();
  }

  /** Draws a picture of that scale for one eye, with the old shadows, and shows nothing. */
  rehearse(scale: number): void {
    this.renderer.shadowMap.autoUpdate = false;
    this.lens.rehearse(this.scene, this.scope.camera, this.scope.distance, scale);
    this.fenceNow();
  }

  private fenceNow(): void {
    const { gl } = this;
    gl.deleteSync(this.fence);
    this.fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    this.drawn++;
    gl.flush();
  }

  /** Ends when the graphics card is done with what is the last picture now. */
  async whenDone(): Promise<void> {
    const { drawn } = this;
    while (!this.done && this.doneUpTo < drawn) await new Promise((resolve) => setTimeout(resolve, pollMs));
  }

  /** The graphics card is done with the last picture. */
  get done(): boolean {
    const { gl } = this;
    if (!this.fence || gl.isContextLost()) return true;
    if (gl.getSyncParameter(this.fence, gl.SYNC_STATUS) !== gl.SIGNALED) return false;
    gl.deleteSync(this.fence);
    this.fence = null;
    this.doneUpTo = this.drawn;
    return true;
  }

  private get gl(): WebGL2RenderingContext {
    return this.renderer.getContext() as WebGL2RenderingContext;
  }

  /** The point of the scene under the pointer, once the graphics card tells; null where there is nothing. */
  pick(x: number, y: number): Promise<THREE.Vector3 | null> {
    return this.lens.pick(x, y, this.canvas.clientWidth, this.canvas.clientHeight);
  }

  /** The point under the pointer becomes the focus. */
  async focusAt(x: number, y: number): Promise<void> {
    const point = await this.pick(x, y);
    if (point) this.scope.focus(point);
  }
}

function makeRenderer(canvas: HTMLCanvasElement): THREE.WebGLRenderer {
  let renderer: THREE.WebGLRenderer;
  try {
    renderer = new THREE.WebGLRenderer({ canvas, antialias: false, powerPreference: 'high-performance' });
  } catch (e) {
    document.body.textContent =
      text('This browser offers no WebGL 2, which the picture needs.') +
      ' ' +
      text('Switch on hardware acceleration or use another browser.');
    throw e;
  }
  renderer.toneMapping = THREE.ACESFilmicToneMapping;
  renderer.toneMappingExposure = 1.0;
  renderer.shadowMap.type = THREE.PCFSoftShadowMap;
  renderer.debug.onShaderError = (gl, program, vs, fs) => {
    console.error('shader:', gl.getProgramInfoLog(program), gl.getShaderInfoLog(vs), gl.getShaderInfoLog(fs));
  };
  return renderer;
}
