// SPDX-License-Identifier: GPL-3.0-or-later
// The vessel that the present choices give, as a surface that can be turned.
import {
  AmbientLight,
  BufferAttribute,
  BufferGeometry,
  Color,
  DirectionalLight,
  DoubleSide,
  Matrix4,
  Mesh,
  MeshLambertMaterial,
  PerspectiveCamera,
  Scene,
  Vector3,
  WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { el } from '../../hud/dom';
import { text } from '../../languages/text';
import type { Block, Vec } from './block';
import type { Preview } from './preview.worker';

const fieldOfView = 35;

export class PreviewView {
  readonly canvas = el('canvas', { tabindex: '0', role: 'img' });
  readonly root = el('div', { class: 'slice' }, this.canvas);
  private readonly renderer = new WebGLRenderer({ canvas: this.canvas, antialias: true });
  private readonly scene = new Scene();
  private readonly camera = new PerspectiveCamera(fieldOfView, 1, 0.1, 2000);
  private readonly controls: OrbitControls;
  private readonly mesh = new Mesh(
    new BufferGeometry(),
    // Its cost counts where the browser draws without a graphics processor.
    new MeshLambertMaterial({ color: '#ff6f5a', side: DoubleSide }),
  );
  private box = '';

  constructor(private readonly block: Block) {
    this.canvas.setAttribute('aria-label', text('The vessel at this threshold'));
    this.scene.background = new Color('#14181c');
    const lamp = new DirectionalLight('#ffffff', 2.2);
    this.camera.add(lamp);
    this.scene.add(this.camera, new AmbientLight('#ffffff', 0.7), this.mesh);
    this.mesh.matrixAutoUpdate = false;
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.addEventListener('change', () => this.draw());
    this.controls.listenToKeyEvents(this.canvas);
  }

  end(): void {
    this.controls.dispose();
    this.mesh.geometry.dispose();
    this.renderer.dispose();
  }

  /** Drawn with the next frame. */
  show({ grid, positions, triangles }: Preview): void {
    // Positions are in nodes of the grid.
    const { step, from } = grid;
    const [x, y, z] = from.map((voxel) => voxel + (step - 1) / 2) as Vec;
    const nodes = new Matrix4().makeScale(step, step, step).setPosition(x, y, z);
    this.mesh.matrix.set(...this.block.toWorld(), 0, 0, 0, 1).multiply(nodes);
    this.mesh.geometry.dispose();
    this.mesh.geometry = new BufferGeometry();
    this.mesh.geometry.setAttribute('position', new BufferAttribute(positions, 3));
    this.mesh.geometry.setIndex(new BufferAttribute(triangles, 1));
    this.mesh.geometry.computeVertexNormals();
    const box = JSON.stringify([grid.from, grid.size, grid.step]);
    if (box !== this.box) this.stand(grid);
    this.box = box;
  }

  /** Sees the part that is taken from the front. */
  private stand(grid: Preview['grid']): void {
    const ends = [grid.from, grid.from.map((x, a) => x + grid.size[a]! * grid.step) as [number, number, number]];
    const [low, high] = ends.map((p) => new Vector3(...this.block.world(p)));
    const centre = low!.clone().add(high!).multiplyScalar(0.5);
    const far = (0.42 * low!.distanceTo(high!)) / Math.sin((fieldOfView / 2) * (Math.PI / 180));
    this.camera.up.set(0, 0, 1);
    this.camera.position.copy(centre).addScaledVector(new Vector3(0.2, 1, 0.25).normalize(), far);
    this.camera.near = far / 100;
    this.camera.far = 10 * far;
    this.controls.target.copy(centre);
    this.controls.update();
  }

  draw(): void {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (width === 0 || height === 0) return;
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.renderer.render(this.scene, this.camera);
  }
}
