// SPDX-License-Identifier: GPL-3.0-or-later
// The operating microscope: turns about a focus point, zooms, pans; every change glides. Its lamp travels with it.
import * as THREE from 'three';
import type { ViewData } from './bundle_types';

interface Pose {
  target: THREE.Vector3;
  yaw: number;
  pitch: number;
  distance: number;
}

/** A glide is over when this share of the picture's distance is left, and this angle, rad. */
const glideEnd = 5e-4;

/** How the field is looked at, for what is drawn as large as the picture is. */
export interface Sight {
  /** Of the picture in the scene: x right, y up, z to the viewer. */
  axes: { x: THREE.Vector3; y: THREE.Vector3; z: THREE.Vector3 };
  /** A hundredth of the picture's height at its focus, m. */
  percentM: number;
  eye: THREE.Vector3;
}

export class Microscope {
  readonly camera = new THREE.PerspectiveCamera(30, 1, 0.01, 3);
  readonly lamp = new THREE.SpotLight(0xfff2e2, 3.3, 0, 0.2, 0.8, 0);
  readonly fill = new THREE.SpotLight(0xe8eeff, 0.55, 0, 0.4, 0.9, 0);
  private home: Pose;
  private wanted: Pose;
  private now: Pose;
  private readonly right = new THREE.Vector3();
  private readonly up = new THREE.Vector3();
  private readonly out = new THREE.Vector3();

  constructor() {
    this.home = { target: new THREE.Vector3(), yaw: 0, pitch: 0, distance: 0.25 };
    this.wanted = clone(this.home);
    this.now = clone(this.home);
    this.lamp.castShadow = true;
    this.lamp.shadow.bias = -0.0012;
    this.lamp.shadow.normalBias = 0.0005;
    this.lamp.shadow.radius = 3;
    this.setFrame(new THREE.Vector3(0, 0, 1), new THREE.Vector3(0, 1, 0));
  }

  addTo(scene: THREE.Scene): void {
    scene.add(this.camera, this.lamp, this.lamp.target, this.fill, this.fill.target);
  }

  /** Starts at the scene's view. */
  setHome(view: ViewData): void {
    const eye = new THREE.Vector3(...view.eye);
    const target = new THREE.Vector3(...view.target);
    const out = eye.clone().sub(target);
    const distance = Math.max(0.02, out.length());
    this.setFrame(out.normalize(), new THREE.Vector3(...view.up));
    this.camera.fov = view.fovDeg;
    this.home = { target, yaw: 0, pitch: 0, distance };
    this.reset(true);
  }

  reset(atOnce = false): void {
    this.wanted = clone(this.home);
    if (atOnce) this.now = clone(this.home);
  }

  orbit(dx: number, dy: number): void {
    this.wanted.yaw = clamp(this.wanted.yaw - dx * 0.005, -1.4, 1.4);
    this.wanted.pitch = clamp(this.wanted.pitch + dy * 0.005, -1.3, 1.3);
  }

  /** Pixels; moves the focus in the picture plane. */
  pan(dx: number, dy: number, heightPx: number): void {
    const s = this.metresPerPixel(this.wanted.distance, heightPx);
    const { x, y } = this.axes();
    const t = this.wanted.target
      .clone()
      .addScaledVector(x, -dx * s)
      .addScaledVector(y, dy * s);
    const away = t.clone().sub(this.home.target);
    if (away.length() > 0.08) away.setLength(0.08);
    this.wanted.target.copy(this.home.target).add(away);
  }

  zoom(factor: number): void {
    this.wanted.distance = clamp(this.wanted.distance * factor, this.home.distance * 0.18, this.home.distance * 2.2);
  }

  focus(point: THREE.Vector3): void {
    this.wanted.target.copy(point);
  }

  get target(): THREE.Vector3 {
    return this.now.target;
  }
  get homeTarget(): THREE.Vector3 {
    return this.home.target;
  }
  get distance(): number {
    return this.now.distance;
  }
  /** Direction from the field to the microscope at the home view. */
  get fieldAxis(): THREE.Vector3 {
    return this.out;
  }

  /** Axes of the picture in the scene: x right, y up, z to the viewer. */
  axes(): { x: THREE.Vector3; y: THREE.Vector3; z: THREE.Vector3 } {
    const x = new THREE.Vector3();
    const y = new THREE.Vector3();
    const z = new THREE.Vector3();
    this.camera.matrixWorld.extractBasis(x, y, z);
    return { x, y, z };
  }

  metresPerPixel(distance: number, heightPx: number): number {
    return (2 * distance * Math.tan(THREE.MathUtils.degToRad(this.camera.fov) / 2)) / heightPx;
  }

  /** A hundredth of the picture's height at its focus, m. */
  get percentM(): number {
    return this.metresPerPixel(this.distance, 100);
  }

  get sight(): Sight {
    return { axes: this.axes(), percentM: this.percentM, eye: this.camera.position };
  }

  /** The picture still moves to where it was asked to be. */
  get gliding(): boolean {
    const { now, wanted } = this;
    const angle = Math.abs(wanted.yaw - now.yaw) + Math.abs(wanted.pitch - now.pitch);
    const length = now.target.distanceTo(wanted.target) + Math.abs(wanted.distance - now.distance);
    return angle > glideEnd || length > glideEnd * now.distance;
  }

  update(dt: number, aspect: number): void {
    const k = 1 - Math.exp(-dt * 11);
    this.now.target.lerp(this.wanted.target, k);
    this.now.yaw += (this.wanted.yaw - this.now.yaw) * k;
    this.now.pitch += (this.wanted.pitch - this.now.pitch) * k;
    this.now.distance *= (this.wanted.distance / this.now.distance) ** k;
    const c = Math.cos(this.now.pitch);
    const s = Math.sin(this.now.pitch);
    const direction = this.out
      .clone()
      .multiplyScalar(c * Math.cos(this.now.yaw))
      .addScaledVector(this.right, c * Math.sin(this.now.yaw))
      .addScaledVector(this.up, s);
    const camera = this.camera;
    camera.position.copy(this.now.target).addScaledVector(direction, this.now.distance);
    camera.up.copy(this.up);
    camera.lookAt(this.now.target);
    camera.aspect = aspect;
    camera.near = Math.max(0.004, this.now.distance * 0.25);
    camera.far = this.now.distance + 0.6;
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld();
    this.placeLights();
  }

  /** The lamp sits beside the lens: nearly coaxial, so the depth is lit, but not quite, so relief and shadows show. */
  private placeLights(): void {
    const { x, y, z } = this.axes();
    const d = Math.max(0.16, this.home.distance);
    this.lamp.position
      .copy(this.now.target)
      .addScaledVector(z, d)
      .addScaledVector(x, -0.17 * d)
      .addScaledVector(y, 0.21 * d);
    this.lamp.target.position.copy(this.now.target);
    this.lamp.angle = Math.atan2(0.058, d);
    this.fill.position
      .copy(this.now.target)
      .addScaledVector(z, d * 0.7)
      .addScaledVector(x, 0.5 * d)
      .addScaledVector(y, -0.25 * d);
    this.fill.target.position.copy(this.now.target);
    this.lamp.target.updateMatrixWorld();
    this.fill.target.updateMatrixWorld();
    const shadow = this.lamp.shadow.camera;
    shadow.near = d * 0.45;
    shadow.far = d * 1.05 + 0.09;
  }

  private setFrame(out: THREE.Vector3, up: THREE.Vector3): void {
    this.out.copy(out);
    this.right.crossVectors(up, out).normalize();
    this.up.crossVectors(out, this.right).normalize();
  }
}

const clone = (p: Pose): Pose => ({ ...p, target: p.target.clone() });
const clamp = (v: number, a: number, b: number) => Math.max(a, Math.min(b, v));
