// SPDX-License-Identifier: GPL-3.0-or-later
// The vessel between the lobes, with a gizmo that moves or turns it about its neck. Millimetres, frame of the approach.
import {
  AmbientLight,
  type BufferGeometry,
  Color,
  DirectionalLight,
  DoubleSide,
  Group,
  Mesh,
  MeshBasicMaterial,
  MeshStandardMaterial,
  PerspectiveCamera,
  Scene,
  Vector3,
  type Vector3Tuple,
  WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { TransformControls } from 'three/examples/jsm/controls/TransformControls.js';
import { PLYLoader } from 'three/examples/jsm/loaders/PLYLoader.js';
import { el } from '../../hud/dom';
import { text } from '../../languages/text';
import { placedAt, type Pose, poseFrom, type PoseFacts, rotationOf } from './pose';

const vessel = 'vessel';
const far = 75; // mm, of the eye from the neck
const looks: Record<string, [string, number]> = {
  vessel: ['#c8443b', 1],
  insula: ['#b9a08d', 1],
  retractors: ['#9fb0bd', 0.8],
};
const lobe: [string, number] = ['#d9b8a6', 0.4];

async function geometryAt(url: string): Promise<BufferGeometry> {
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

export class PoseView {
  private readonly canvas = el('canvas', { tabindex: '0', role: 'img' });
  readonly root = el('div', { class: 'pose-view' }, this.canvas);
  private readonly renderer = new WebGLRenderer({ canvas: this.canvas, antialias: true });
  private readonly scene = new Scene();
  private readonly camera = new PerspectiveCamera(35, 1, 1, 1000);
  /** At the neck; what is in it turns about it. */
  private readonly pivot = new Group();
  private readonly orbit: OrbitControls;
  private readonly gizmo: TransformControls;
  private readonly watch = new ResizeObserver(() => this.resize());
  private waiting = false;
  private readonly named = new Map<string, Mesh>();
  /** Geometries before anything is parted. */
  private readonly whole = new Map<Mesh, BufferGeometry>();
  /** Counts what was asked to be shown. */
  private looks = 0;

  /** moved: while it is dragged; placed: after the release. */
  constructor(
    private readonly facts: PoseFacts,
    moved: (pose: Pose) => void,
    placed: (pose: Pose) => void,
  ) {
    this.canvas.setAttribute('aria-label', text('The vessel between the lobes, to be moved and turned'));
    this.scene.background = new Color('#14181c');
    this.camera.add(new DirectionalLight('#ffffff', 2.2));
    this.scene.add(this.camera, new AmbientLight('#ffffff', 0.8), this.pivot);
    const neck = placedAt(facts.pose, facts.neck);
    this.camera.up.set(0, 0, 1);
    this.camera.position.copy(neck).addScaledVector(new Vector3(...facts.toSurgeon), far);
    this.orbit = new OrbitControls(this.camera, this.canvas);
    this.orbit.target.copy(neck);
    this.orbit.update();
    this.orbit.addEventListener('change', () => this.draw());
    this.gizmo = new TransformControls(this.camera, this.canvas);
    this.gizmo.attach(this.pivot);
    this.gizmo.size = 0.8;
    this.gizmo.space = 'local';
    this.scene.add(this.gizmo.getHelper());
    this.gizmo.addEventListener('change', () => this.draw());
    this.gizmo.addEventListener('objectChange', () => moved(this.pose));
    this.gizmo.addEventListener('mouseUp', () => placed(this.pose));
    this.gizmo.addEventListener('dragging-changed', (e) => (this.orbit.enabled = e.value !== true));
    this.watch.observe(this.root);
  }

  end(): void {
    this.watch.disconnect();
    this.gizmo.dispose();
    this.orbit.dispose();
    this.renderer.dispose();
    this.root.remove();
    Object.assign(window, { __pose: undefined });
  }

  /** url: of a surface by its name. */
  async load(url: (surface: string) => string): Promise<void> {
    const loaded = await Promise.all(
      this.facts.surfaces.map(async (name) => [name, await geometryAt(url(name))] as const),
    );
    for (const [name, geometry] of loaded) {
      const mesh = meshOf(geometry, ...(looks[name] ?? lobe));
      if (name === vessel) mesh.position.set(...this.facts.neck).negate();
      (name === vessel ? this.pivot : this.scene).add(mesh);
      this.whole.set(mesh, geometry);
      this.named.set(name, mesh);
    }
    const seen = { handle: (mm?: Vector3Tuple) => this.handle(mm), pose: () => this.pose, parted: () => this.parted };
    Object.assign(window, { __pose: seen });
    this.draw();
  }

  /** Lobes as they would be parted. url: of a surface by its name. */
  async showParted(surfaces: readonly string[], url: (surface: string) => string): Promise<void> {
    const number = ++this.looks;
    const parted = await Promise.all(
      surfaces.map(async (name) => [name, await geometryAt(url(`parted_${name}`))] as const),
    );
    if (number !== this.looks) return;
    for (const [name, geometry] of parted) this.shape(this.named.get(name), geometry);
    this.draw();
  }

  /** Lobes as they are before. */
  showWhole(): void {
    this.looks++;
    for (const [mesh, geometry] of this.whole) this.shape(mesh, geometry);
    this.draw();
  }

  private shape(mesh: Mesh | undefined, geometry: BufferGeometry): void {
    if (!mesh || mesh.geometry === geometry) return;
    if (mesh.geometry !== this.whole.get(mesh)) mesh.geometry.dispose();
    mesh.geometry = geometry;
    for (const front of mesh.children) (front as Mesh).geometry = geometry;
  }

  get pose(): Pose {
    return poseFrom(this.pivot.quaternion, this.facts.neck, this.pivot.position);
  }

  get dragging(): boolean {
    return this.gizmo.dragging;
  }

  set pose(pose: Pose) {
    if (this.dragging) return;
    this.pivot.quaternion.copy(rotationOf(pose));
    this.pivot.position.copy(placedAt(pose, this.facts.neck));
    this.draw();
  }

  set turns(turns: boolean) {
    this.gizmo.setMode(turns ? 'rotate' : 'translate');
    this.draw();
  }

  private get parted(): boolean {
    return [...this.whole].some(([mesh, geometry]) => mesh.geometry !== geometry);
  }

  /** Place of the gizmo's middle on the page, px, or of what is so far from it along the gizmo's axes, mm. */
  private handle(mm: Vector3Tuple = [0, 0, 0]): [number, number] {
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    const at = new Vector3(...mm).applyQuaternion(this.pivot.quaternion).add(this.pivot.position).project(this.camera);
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
