// SPDX-License-Identifier: GPL-3.0-or-later
// The vessel between the lobes, with a gizmo that moves or turns it about its neck. Millimetres, frame of the approach.
import {
  AmbientLight,
  Color,
  DirectionalLight,
  DoubleSide,
  Group,
  Mesh,
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
import { text } from '../../languages/text';
import { placedAt, type Pose, poseFrom, type PoseFacts, rotationOf } from './pose';

const vessel = 'vessel';
const far = 75; // mm, of the eye from the neck
const looks: Record<string, [string, number]> = {
  vessel: ['#c8443b', 1],
  insula: ['#b9a08d', 0.9],
  retractors: ['#9fb0bd', 0.9],
};
const lobe: [string, number] = ['#d9b8a6', 0.4];

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
      this.facts.surfaces.map(async (name) => [name, await new PLYLoader().loadAsync(url(name))] as const),
    );
    for (const [name, geometry] of loaded) {
      geometry.computeVertexNormals();
      const [color, opacity] = looks[name] ?? lobe;
      const material = new MeshStandardMaterial({
        color,
        opacity,
        transparent: opacity < 1,
        depthWrite: opacity === 1,
        roughness: 0.6,
        side: DoubleSide,
      });
      const mesh = new Mesh(geometry, material);
      if (name === vessel) mesh.position.set(...this.facts.neck).negate();
      (name === vessel ? this.pivot : this.scene).add(mesh);
    }
    Object.assign(window, { __pose: { handle: () => this.handle(), pose: () => this.pose } });
    this.draw();
  }

  get pose(): Pose {
    return poseFrom(this.pivot.quaternion, this.facts.neck, this.pivot.position);
  }

  set pose(pose: Pose) {
    if (this.gizmo.dragging) return;
    this.pivot.quaternion.copy(rotationOf(pose));
    this.pivot.position.copy(placedAt(pose, this.facts.neck));
    this.draw();
  }

  set turns(turns: boolean) {
    this.gizmo.setMode(turns ? 'rotate' : 'translate');
    this.draw();
  }

  /** Place of the gizmo's middle on the page, px. */
  private handle(): [number, number] {
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    const at = this.pivot.position.clone().project(this.camera);
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
