// SPDX-License-Identifier: GPL-3.0-or-later
// A picture of the opened field, with a gizmo that moves or turns a thing in it. Millimetres, frame of the approach.
import {
  AmbientLight,
  type BufferGeometry,
  Color,
  DirectionalLight,
  DoubleSide,
  Mesh,
  MeshBasicMaterial,
  MeshStandardMaterial,
  PerspectiveCamera,
  Scene,
  Vector3,
  WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { TransformControls } from 'three/examples/jsm/controls/TransformControls.js';
import { PLYLoader } from 'three/examples/jsm/loaders/PLYLoader.js';
import { el } from '../../hud/dom';
import type { Point } from '../api';

const far = 75; // mm, of the eye from the middle
const looks: Record<string, [string, number]> = {
  vessel: ['#c8443b', 1],
  insula: ['#b9a08d', 1],
  retractors: ['#9fb0bd', 0.8],
};
const lobe: [string, number] = ['#d9b8a6', 0.4];

export async function geometryAt(url: string): Promise<BufferGeometry> {
  const geometry = await new PLYLoader().loadAsync(url);
  geometry.computeVertexNormals();
  return geometry;
}

/** Of what is transparent, only the nearest surface is seen: its depth is drawn before its colour. */
function meshOf(geometry: BufferGeometry, color: string, opacity: number): Mesh {
  const transparent = opacity < 1;
  const look = { color, opacity, transparent, depthWrite: !transparent, roughness: 0.6, side: DoubleSide };
  const mesh = new Mesh(geometry, new MeshStandardMaterial(look));
  if (!transparent) return mesh;
  const front = new Mesh(geometry, new MeshBasicMaterial({ colorWrite: false, side: DoubleSide }));
  front.renderOrder = 1; // after what is seen through it
  return mesh.add(front);
}

/** A surface of the field by its name. */
export const surfaceMesh = (name: string, geometry: BufferGeometry): Mesh => meshOf(geometry, ...(looks[name] ?? lobe));

export class FieldPicture {
  protected readonly canvas = el('canvas', { tabindex: '0', role: 'img' });
  readonly root = el('div', { class: 'pose-view' }, this.canvas);
  private readonly renderer = new WebGLRenderer({ canvas: this.canvas, antialias: true });
  protected readonly scene = new Scene();
  protected readonly camera = new PerspectiveCamera(35, 1, 1, 1000);
  private readonly orbit: OrbitControls;
  protected readonly gizmo: TransformControls;
  private readonly watch = new ResizeObserver(() => this.resize());
  private waiting = false;

  /** middle: that is looked at from the surgeon's side. */
  constructor(words: string, middle: Vector3, toSurgeon: Point) {
    this.canvas.setAttribute('aria-label', words);
    this.scene.background = new Color('#14181c');
    this.camera.add(new DirectionalLight('#ffffff', 2.2));
    this.scene.add(this.camera, new AmbientLight('#ffffff', 0.8));
    this.camera.up.set(0, 0, 1);
    this.camera.position.copy(middle).addScaledVector(new Vector3(...toSurgeon), far);
    this.orbit = new OrbitControls(this.camera, this.canvas);
    this.orbit.target.copy(middle);
    this.orbit.update();
    this.orbit.addEventListener('change', () => this.draw());
    this.gizmo = new TransformControls(this.camera, this.canvas);
    this.gizmo.size = 0.8;
    this.gizmo.space = 'local';
    this.scene.add(this.gizmo.getHelper());
    this.gizmo.addEventListener('change', () => this.draw());
    this.gizmo.addEventListener('dragging-changed', (e) => (this.orbit.enabled = e.value !== true));
    this.watch.observe(this.root);
  }

  end(): void {
    this.watch.disconnect();
    this.gizmo.dispose();
    this.orbit.dispose();
    this.renderer.dispose();
    this.root.remove();
  }

  get dragging(): boolean {
    return this.gizmo.dragging;
  }

  set turns(turns: boolean) {
    this.gizmo.setMode(turns ? 'rotate' : 'translate');
    this.draw();
  }

  /** On the page, px. */
  protected onPage(at: Vector3): [number, number] {
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    const seen = at.clone().project(this.camera);
    return [left + ((seen.x + 1) / 2) * width, top + ((1 - seen.y) / 2) * height];
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
  protected draw(): void {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.renderer.render(this.scene, this.camera);
    });
  }
}
