// SPDX-License-Identifier: GPL-3.0-or-later
// A point of the scene that is moved with the mouse, by three arrows and the planes between them.
import { Mesh, MeshBasicMaterial, type PerspectiveCamera, type Scene, SphereGeometry, Vector3 } from 'three';
import { TransformControls } from 'three/examples/jsm/controls/TransformControls.js';
import { status } from './status';

/** What TransformControls takes in place of its own events. */
const pointer = (e: PointerEvent, canvas: HTMLCanvasElement): PointerEvent => {
  const { left, top, width, height } = canvas.getBoundingClientRect();
  const [x, y] = [((e.clientX - left) / width) * 2 - 1, 1 - ((e.clientY - top) / height) * 2];
  return { x, y, button: e.button } as PointerEvent;
};

/** Of the picture's depth. */
const ballShare = 0.006;

export class Placing {
  private readonly controls: TransformControls;
  private readonly ball = new Mesh(
    new SphereGeometry(1, 16, 12),
    new MeshBasicMaterial({ color: 0xffd34d, depthTest: false, toneMapped: false }),
  );
  private readonly hear: [string, (e: PointerEvent) => void][] = [
    ['pointermove', (e) => this.moved(e)],
    ['pointerdown', (e) => this.pressed(e)],
    ['pointerup', (e) => this.released(e)],
  ];

  /** placed: gets the point after each drag, m. */
  constructor(
    private readonly scene: Scene,
    private readonly canvas: HTMLCanvasElement,
    camera: PerspectiveCamera,
    at: readonly [number, number, number],
    private readonly placed: (at: Vector3) => void,
  ) {
    this.ball.position.set(...at);
    this.ball.scale.setScalar(ballShare * camera.position.distanceTo(this.ball.position));
    this.ball.renderOrder = 1000;
    this.controls = new TransformControls(camera);
    this.controls.attach(this.ball);
    scene.add(this.ball, this.controls.getHelper());
    this.tell();
    // Before the page's own gestures, which turn the picture.
    for (const [name, f] of this.hear) window.addEventListener(name, f as EventListener, true);
  }

  end(): void {
    for (const [name, f] of this.hear) window.removeEventListener(name, f as EventListener, true);
    this.controls.detach();
    this.scene.remove(this.ball, this.controls.getHelper());
    this.controls.dispose();
    status.placing = null;
  }

  private tell(): void {
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    const { x, y } = this.ball.position.clone().project(this.controls.camera);
    status.placing = [left + ((x + 1) / 2) * width, top + ((1 - y) / 2) * height];
  }

  private moved(e: PointerEvent): void {
    if (!this.controls.dragging) return this.controls.pointerHover(pointer(e, this.canvas));
    e.stopImmediatePropagation();
    this.controls.pointerMove({ ...pointer(e, this.canvas), button: -1 });
  }

  private pressed(e: PointerEvent): void {
    if (e.target !== this.canvas || e.button !== 0) return;
    this.controls.pointerHover(pointer(e, this.canvas));
    this.controls.pointerDown(pointer(e, this.canvas));
    if (this.controls.dragging) e.stopImmediatePropagation();
  }

  private released(e: PointerEvent): void {
    if (!this.controls.dragging) return;
    e.stopImmediatePropagation();
    this.controls.pointerUp(pointer(e, this.canvas));
    this.tell();
    this.placed(this.ball.position.clone());
  }
}
