// SPDX-License-Identifier: GPL-3.0-or-later
// The surface with its openings and its neck, to be turned and clicked on. Millimetres.
import {
  AmbientLight,
  BufferAttribute,
  type BufferGeometry,
  Color,
  DirectionalLight,
  DoubleSide,
  Group,
  Mesh,
  MeshStandardMaterial,
  type Object3D,
  PerspectiveCamera,
  Raycaster,
  Scene,
  Vector2,
  Vector3,
  WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { PLYLoader } from 'three/examples/jsm/loaders/PLYLoader.js';
import { el } from '../hud/dom';
import { text } from '../languages/text';
import type { Facts, Point } from './api';
import { ball, ring, solidDisc } from './marks';
import type { NeckPlane } from './neck_plane';
import { type Cut, cutThrough, partBeyond } from './scan/cut_plane';
import { PatchRegion } from './wall_paint/patch_region';
import type { WallPatch } from './wall_paint/patches';

const stillPx = 4; // a press that moves farther turns the view
const fieldOfView = 35;
const colours = {
  wall: '#c8756b',
  inlet: '#5aa9ff',
  outlet: '#9fd0a8',
  neck: '#ffffff',
  point: '#ffd54a',
  goes: '#4b8fe0',
};

/** Of the painted parts of the wall, one after the other and then again. */
const patchColours = ['#ffd166', '#7bdff2', '#b388eb', '#90be6d', '#f4978e'];
export const patchColour = (k: number): string => patchColours[k % patchColours.length]!;

export class SurfaceView {
  readonly canvas = el('canvas', { tabindex: '0', role: 'img' });
  readonly root = el('div', { class: 'view' }, this.canvas);
  private readonly renderer = new WebGLRenderer({ canvas: this.canvas, antialias: true });
  private readonly scene = new Scene();
  private readonly camera = new PerspectiveCamera(fieldOfView, 1, 0.1, 2000);
  private readonly marks = new Group();
  private readonly lamp = new DirectionalLight('#ffffff', 2.2);
  private controls: OrbitControls | null = null;
  private mesh: Mesh<BufferGeometry, MeshStandardMaterial> | null = null;
  private readonly cut = new Group();
  private gone: ArrayLike<number | boolean> | null = null;
  private patches: readonly WallPatch[] = [];
  private region: PatchRegion | null = null;
  private readonly clip = new Group();
  private pressed = new Vector2();
  private waiting = false;
  private readonly watch = new ResizeObserver(() => this.resize());
  /** Gets the points that are clicked on the surface; null: clicks only turn it. */
  onPoint: ((p: Vector3) => void) | null = null;

  constructor() {
    this.canvas.setAttribute('aria-label', text('The vessel with its openings and the plane of the neck'));
    this.scene.background = new Color('#14181c');
    this.camera.add(this.lamp);
    this.scene.add(this.camera, new AmbientLight('#ffffff', 0.7), this.marks, this.cut, this.clip);
    this.canvas.addEventListener('pointerdown', (e) => this.pressed.set(e.clientX, e.clientY));
    this.canvas.addEventListener('pointerup', (e) => this.released(e));
    this.watch.observe(this.root);
    Object.assign(window, {
      __studio: {
        screenOf: (p: Point) => this.screenOf(p),
        placeAt: (x: number, y: number) => this.hitAt(x, y)?.toArray() ?? null,
        colourAt: (x: number, y: number) => this.colourAt(x, y),
        ready: () => this.mesh !== null,
      },
    });
  }

  end(): void {
    this.watch.disconnect();
    this.controls?.dispose();
    this.renderer.dispose();
  }

  /** Shows another surface, seen from the side of the neck with the dome up. */
  async load(url: string, neck: NeckPlane | null): Promise<void> {
    const geometry = await new PLYLoader().loadAsync(url);
    geometry.computeVertexNormals();
    geometry.computeBoundingSphere();
    const before = this.mesh?.geometry.boundingSphere;
    if (this.mesh) {
      this.scene.remove(this.mesh);
      this.mesh.geometry.dispose();
    }
    this.mesh = new Mesh(geometry, new MeshStandardMaterial({ vertexColors: true, roughness: 0.55, side: DoubleSide }));
    this.scene.add(this.mesh);
    this.region = null;
    this.showCut(null);
    const now = geometry.boundingSphere!;
    if (!before || before.center.distanceTo(now.center) > now.radius || now.radius > 1.5 * before.radius)
      this.stand(geometry, neck?.normal ?? new Vector3(0, 0, 1));
  }

  /** null: none is loaded. */
  get surface(): { positions: ArrayLike<number>; triangles: ArrayLike<number> } | null {
    if (!this.mesh) return null;
    const { attributes, index } = this.mesh.geometry;
    return { positions: attributes.position!.array, triangles: index!.array };
  }

  /** The cut along a line between two places of the window. Null: there is no vessel. */
  cutAlong(from: readonly [number, number], to: readonly [number, number]): Cut | null {
    const { mesh } = this;
    if (!mesh) return null;
    const ray = (share: number) => this.ray(from[0] + share * (to[0] - from[0]), from[1] + share * (to[1] - from[1]));
    return cutThrough({
      direction: (share) => ray(share).ray.direction.clone(),
      hits: (share) =>
        ray(share)
          .intersectObject(mesh)
          .map((hit) => hit.point),
    });
  }

  /** The plane of a cut, and the part that goes in another colour. Null: none. */
  showCut(cut: Cut | null): void {
    this.cut.clear();
    const { mesh, surface } = this;
    if (!mesh || !surface) return;
    this.gone = cut ? partBeyond(surface.positions, surface.triangles, cut) : null;
    this.colour();
    const radius = mesh.geometry.boundingSphere!.radius / 6;
    if (cut) this.cut.add(...solidDisc(cut.point, cut.normal, radius, colours.goes));
    this.draw();
  }

  /** Painted parts of the wall, in colours. */
  showPatches(patches: readonly WallPatch[]): void {
    this.patches = patches;
    this.colour();
    this.draw();
  }

  private colour(): void {
    const { mesh, surface, gone, patches } = this;
    if (!mesh || !surface) return;
    if (patches.length > 0) this.region ??= new PatchRegion(surface.positions, surface.triangles);
    const of = patches.length > 0 ? this.region!.patchOfVertices(patches) : null;
    const [wall, goes] = [new Color(colours.wall), new Color(colours.goes)];
    const painted = patches.map((_p, k) => new Color(patchColour(k)));
    const paint = new Float32Array(surface.positions.length);
    for (let v = 0; 3 * v < paint.length; v++)
      (gone?.[v] ? goes : (painted[of?.[v] ?? -1] ?? wall)).toArray(paint, 3 * v);
    mesh.geometry.setAttribute('color', new BufferAttribute(paint, 3));
  }

  private stand(geometry: BufferGeometry, up: Vector3): void {
    const { center, radius } = geometry.boundingSphere!;
    const side = new Vector3(up.y, up.z, up.x).cross(up).normalize().addScaledVector(up, 0.3).normalize();
    const far = (1.1 * radius) / Math.sin((fieldOfView / 2) * (Math.PI / 180));
    this.camera.up.copy(up);
    this.camera.position.copy(center).addScaledVector(side, far);
    this.camera.near = far / 100;
    this.camera.far = 10 * far;
    this.camera.updateProjectionMatrix();
    this.controls?.dispose();
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.target.copy(center);
    this.controls.addEventListener('change', () => this.draw());
    this.controls.listenToKeyEvents(this.canvas);
    this.controls.update();
    this.resize();
  }

  /** points: those clicked so far. inlet: index of the opening where blood comes in. */
  mark(facts: Facts, inlet: number, neck: NeckPlane | null, points: readonly Vector3[]): void {
    const marks: Object3D[] = facts.openings.map((o, k) =>
      ring(
        new Vector3(...o.centre),
        new Vector3(...o.normal),
        o.calibreMm / 2,
        k === inlet ? colours.inlet : colours.outlet,
      ),
    );
    if (neck) marks.push(...solidDisc(neck.centre, neck.normal, 1.25 * neck.radius, colours.neck));
    marks.push(...points.map((p) => ball(p, Math.hypot(...facts.sizeMm) / 120, colours.point)));
    this.marks.clear();
    this.marks.add(...marks);
    this.draw();
  }

  /** Of clip_marks.ts; empty: none. */
  showClip(marks: readonly Object3D[]): void {
    if (marks.length === 0 && this.clip.children.length === 0) return;
    this.clip.clear();
    this.clip.add(...marks);
    this.draw();
  }

  private released(e: PointerEvent): void {
    if (!this.onPoint || this.pressed.distanceTo(new Vector2(e.clientX, e.clientY)) > stillPx) return;
    const hit = this.hitAt(e.clientX, e.clientY);
    if (hit) this.onPoint(hit);
  }

  /** The place of the surface at a place of the window; null: there is none. */
  hitAt(x: number, y: number): Vector3 | null {
    return (this.mesh && this.ray(x, y).intersectObject(this.mesh)[0]?.point.clone()) ?? null;
  }

  /** Red, green and blue of the surface at a place of the window; null: there is none. */
  private colourAt(x: number, y: number): number[] | null {
    const hit = this.mesh && this.ray(x, y).intersectObject(this.mesh)[0];
    const colour = this.mesh?.geometry.attributes.color;
    if (!hit?.face || !colour) return null;
    return [colour.getX(hit.face.a), colour.getY(hit.face.a), colour.getZ(hit.face.a)];
  }

  /** Through a place of the window. */
  private ray(x: number, y: number): Raycaster {
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    const out = new Raycaster();
    out.setFromCamera(new Vector2(((x - left) / width) * 2 - 1, 1 - ((y - top) / height) * 2), this.camera);
    return out;
  }

  /** Place of a point on the page, px. */
  private screenOf(p: Point): [number, number] {
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    const at = new Vector3(...p).project(this.camera);
    return [left + ((at.x + 1) / 2) * width, top + ((1 - at.y) / 2) * height];
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.root;
    if (width === 0 || height === 0) return;
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  /** Once a frame at most. */
  private draw(): void {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.renderer.render(this.scene, this.camera);
    });
  }
}
