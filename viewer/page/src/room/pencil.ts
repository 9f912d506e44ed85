// SPDX-License-Identifier: GPL-3.0-or-later
// The instructor's pencil and pointer: where the pen is on the picture becomes a place in the field. Nothing here waits
// for the graphics card, which may be busy with pictures for long.
import * as THREE from 'three';
import { type Drawing, mostPoints, type Point } from './messages';

export type PencilMode = 'off' | 'draw' | 'point';

export const sendEveryMs = 33;
/** A stroke that begins where no depth is known waits so long for it. Then it lies at the last one that was known. */
export const depthWaitMs = 35;
/** The depth is known about the place where it was read back, pixels. */
export const nearPx = 12;

export interface Sight {
  camera: THREE.PerspectiveCamera;
  /** The microscope's focus. */
  focus(): THREE.Vector3;
  /** What lies under a pixel of the picture, once the graphics card tells; null: nothing. */
  pick(x: number, y: number): Promise<THREE.Vector3 | null>;
}

type At = { x: number; y: number };

export class Pencil {
  private mode: PencilMode = 'off';
  private readonly caster = new THREE.Raycaster();
  /** What lay under the pen when that was last read back. */
  private under: THREE.Vector3 | null = null;
  /** Where the pen was then. */
  private underAt: At | null = null;
  private looking = false;
  /** Where the pen is over the picture, and whether the pointer is still to be sent. */
  private at: At | null = null;
  private unsent = false;
  /** Of the stroke: what is to be sent, and the plane that it lies in, once its depth is known. */
  private id = 0;
  private down = false;
  private waiting: THREE.Ray[] = [];
  private plane: THREE.Plane | null = null;
  private sentMs = -sendEveryMs;
  private timer: ReturnType<typeof setTimeout> | undefined;

  /** send: also shows it here. */
  constructor(
    private readonly surface: HTMLElement,
    private readonly sight: Sight,
    private readonly send: (m: Drawing) => void,
  ) {
    surface.addEventListener('pointerdown', (e) => this.begin(e));
    // Browsers hold a "pointermove" back until the next picture. The other event comes at once, but only some browsers
    // have it, and only on pages that are encrypted or on their own machine.
    const move = 'onpointerrawupdate' in surface ? 'pointerrawupdate' : 'pointermove';
    surface.addEventListener(move, (e) => this.move(e as PointerEvent));
    for (const end of ['pointerup', 'pointercancel'] as const) surface.addEventListener(end, () => this.end());
  }

  set(mode: PencilMode): void {
    this.end();
    this.at = null;
    this.unsent = false;
    this.mode = mode;
    this.surface.classList.toggle('on', mode !== 'off');
    // So that the first place already has a depth, and the graphics card what it needs to tell one.
    const { clientWidth, clientHeight } = this.surface;
    if (mode !== 'off') void this.look({ x: clientWidth / 2, y: clientHeight / 2 }).then(() => this.follow());
  }

  private begin(e: PointerEvent): void {
    if (e.button !== 0) return;
    this.surface.setPointerCapture(e.pointerId);
    if (this.mode === 'draw') this.beginStroke({ x: e.offsetX, y: e.offsetY });
    this.move(e);
  }

  /**
   * In the plane across the view at the depth of what is under the pen, so that a stroke stays in one depth. A pen that
   * came over the picture has asked for it on the way.
   */
  private beginStroke(at: At): void {
    this.settle(this.id);
    this.down = true;
    this.plane = null;
    const id = (this.id = Math.floor(Math.random() * 2 ** 40));
    if (this.underAt && Math.hypot(at.x - this.underAt.x, at.y - this.underAt.y) <= nearPx) return this.settle(id);
    setTimeout(() => this.settle(id), depthWaitMs);
    void this.look(at).then(() => this.settle(id));
  }

  /** The stroke gets its plane, unless it has one or another one has begun. */
  private settle(id: number): void {
    if (id !== this.id || this.plane) return;
    this.plane = this.planeNow();
    this.flush();
  }

  private planeNow(): THREE.Plane {
    const towards = this.sight.camera.getWorldDirection(new THREE.Vector3());
    return new THREE.Plane().setFromNormalAndCoplanarPoint(towards, this.under ?? this.sight.focus());
  }

  private async look({ x, y }: At): Promise<void> {
    this.looking = true;
    this.under = await this.sight.pick(x, y);
    this.underAt = { x, y };
    this.looking = false;
  }

  private move(e: PointerEvent): void {
    const at = { x: e.offsetX, y: e.offsetY };
    if (this.mode === 'off') return;
    if (this.down) {
      this.waiting.push(this.ray(at));
      return this.sendSoon();
    }
    this.at = at;
    if (this.mode === 'point') {
      this.unsent = true;
      this.sendSoon();
    }
    this.follow();
  }

  /**
   * Asks for the depth under the pen. The pointer is sent at the depth that is known, and once more when that of its
   * own place is. While a stroke is drawn, nothing is asked.
   */
  private follow(): void {
    const { at } = this;
    if (this.looking || this.down || !at) return;
    void this.look(at).then(() => {
      if (!this.at) return;
      if (this.mode === 'point') {
        this.unsent = true;
        this.sendSoon();
      }
      if (this.at !== at) this.follow();
    });
  }

  private end(): void {
    this.down = false;
    this.flush();
  }

  private sendSoon(): void {
    if (this.timer !== undefined) return;
    const waitMs = this.sentMs + sendEveryMs - performance.now();
    if (waitMs <= 0) this.flush();
    else this.timer = setTimeout(() => this.flush(), waitMs);
  }

  private flush(): void {
    clearTimeout(this.timer);
    this.timer = undefined;
    const at = this.unsent && this.at ? place(this.ray(this.at), this.planeNow()) : null;
    this.unsent = false;
    if (at) this.tell({ kind: 'point', at });
    const { plane } = this;
    if (!plane) return;
    const points = this.waiting.splice(0).map((ray) => place(ray, plane));
    const seen = points.filter((p) => p !== null);
    while (seen.length > 0) this.tell({ kind: 'stroke', id: this.id, points: seen.splice(0, mostPoints) });
  }

  private tell(m: Drawing): void {
    this.sentMs = performance.now();
    this.send(m);
  }

  private ray({ x, y }: At): THREE.Ray {
    const { clientWidth, clientHeight } = this.surface;
    const across = (2 * x) / clientWidth - 1;
    this.caster.setFromCamera(new THREE.Vector2(across, 1 - (2 * y) / clientHeight), this.sight.camera);
    return this.caster.ray.clone();
  }
}

function place(ray: THREE.Ray, plane: THREE.Plane): Point | null {
  const at = ray.intersectPlane(plane, new THREE.Vector3());
  // A tenth of a micrometre is enough.
  return at ? (at.toArray().map((x) => Number(x.toFixed(7))) as Point) : null;
}
