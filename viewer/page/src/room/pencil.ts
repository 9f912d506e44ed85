// SPDX-License-Identifier: GPL-3.0-or-later
// The instructor's pencil and pointer: where the pen is on the picture becomes a place in the field.
import * as THREE from 'three';
import { type Drawing, mostPoints, type Point } from './messages';

export type PencilMode = 'off' | 'draw' | 'point';

const sendEveryMs = 33;

export interface Sight {
  camera: THREE.PerspectiveCamera;
  /** The microscope's focus. */
  focus(): THREE.Vector3;
  /** What lies under a pixel of the picture. */
  pick(x: number, y: number): THREE.Vector3 | null;
}

export class Pencil {
  private mode: PencilMode = 'off';
  private readonly plane = new THREE.Plane();
  private readonly ray = new THREE.Raycaster();
  private id = 0;
  private down = false;
  private waiting: Point[] = [];
  private sentMs = 0;
  private timer = 0;

  /** send: also shows it here. */
  constructor(
    private readonly surface: HTMLElement,
    private readonly sight: Sight,
    private readonly send: (m: Drawing) => void,
  ) {
    surface.addEventListener('pointerdown', (e) => this.begin(e));
    surface.addEventListener('pointermove', (e) => this.move(e));
    for (const end of ['pointerup', 'pointercancel'] as const) surface.addEventListener(end, () => this.end());
  }

  set(mode: PencilMode): void {
    this.end();
    this.mode = mode;
    this.surface.classList.toggle('on', mode !== 'off');
  }

  /** The plane across the view at the depth of what is under the pen, so that a stroke stays in one depth. */
  private begin(e: PointerEvent): void {
    if (e.button !== 0) return;
    this.surface.setPointerCapture(e.pointerId);
    this.aimPlane(e);
    this.id = Math.floor(Math.random() * 2 ** 40);
    this.down = true;
    this.move(e);
  }

  private aimPlane(e: PointerEvent): void {
    const towards = this.sight.camera.getWorldDirection(new THREE.Vector3());
    const at = this.sight.pick(e.offsetX, e.offsetY) ?? this.sight.focus();
    this.plane.setFromNormalAndCoplanarPoint(towards, at);
  }

  private move(e: PointerEvent): void {
    const now = performance.now();
    if (this.mode === 'point') {
      if (now - this.sentMs < sendEveryMs) return;
      this.aimPlane(e);
      const at = this.place(e);
      if (at) this.send({ kind: 'point', at });
      this.sentMs = now;
      return;
    }
    const at = this.mode === 'draw' && this.down ? this.place(e) : null;
    if (!at) return;
    this.waiting.push(at);
    if (this.timer === 0) this.timer = window.setTimeout(() => this.flush(), sendEveryMs - (now - this.sentMs));
  }

  private end(): void {
    this.down = false;
    this.flush();
  }

  private flush(): void {
    window.clearTimeout(this.timer);
    this.timer = 0;
    this.sentMs = performance.now();
    while (this.waiting.length > 0)
      this.send({ kind: 'stroke', id: this.id, points: this.waiting.splice(0, mostPoints) });
  }

  private place(e: PointerEvent): Point | null {
    const { clientWidth, clientHeight } = this.surface;
    const across = (2 * e.offsetX) / clientWidth - 1;
    this.ray.setFromCamera(new THREE.Vector2(across, 1 - (2 * e.offsetY) / clientHeight), this.sight.camera);
    const at = this.ray.ray.intersectPlane(this.plane, new THREE.Vector3());
    // A tenth of a micrometre is enough.
    return at ? (at.toArray().map((x) => Number(x.toFixed(7))) as Point) : null;
  }
}
