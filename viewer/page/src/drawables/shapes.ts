// SPDX-License-Identifier: GPL-3.0-or-later
// Triangle patches, planes, labels and rigid links, drawn plainly.
import * as THREE from 'three';
import { creased } from '../geometry';
import type { DrawableContext, Drawn } from './drawn';
import { lookOf, moving } from './look';

export class Patch implements Drawn {
  readonly root: THREE.Mesh;
  private readonly geometry = new THREE.BufferGeometry();
  private readonly material: THREE.MeshPhysicalMaterial;

  constructor(context: DrawableContext) {
    const mesh = context.meshes[0]!;
    this.geometry.setAttribute('position', new THREE.BufferAttribute(Float32Array.from(mesh.positions), 3));
    this.geometry.setIndex(new THREE.BufferAttribute(mesh.indices, 1));
    this.geometry.computeVertexNormals();
    this.material = lookOf(context);
    this.root = moving(new THREE.Mesh(this.geometry, this.material));
  }

  update(data: Float32Array): void {
    this.root.visible = data.length > 0;
    if (!this.root.visible) return;
    const p = this.geometry.attributes.position!;
    for (let v = 0; v < p.count; v++) p.setXYZ(v, data[4 * v]!, data[4 * v + 1]!, data[4 * v + 2]!);
    p.needsUpdate = true;
    this.geometry.computeVertexNormals();
  }

  dispose(): void {
    this.root.removeFromParent();
    this.geometry.dispose();
    this.material.dispose();
  }
}

/** A disc at the plane's origin; radius 0: nothing. */
export class Disc implements Drawn {
  readonly root: THREE.Mesh;
  private readonly geometry = new THREE.CircleGeometry(1, 64);
  private readonly material: THREE.MeshPhysicalMaterial;

  constructor(context: DrawableContext) {
    this.material = lookOf(context);
    this.root = moving(new THREE.Mesh(this.geometry, this.material));
    this.root.castShadow = false;
  }

  update(data: Float32Array): void {
    this.root.visible = data.length > 0 && data[6]! > 0;
    if (this.root.visible) placeDisc(this.root, data);
  }

  dispose(): void {
    this.root.removeFromParent();
    this.geometry.dispose();
    this.material.dispose();
  }
}

/** Puts a unit disc where the numbers of a plane say; returns its unit normal. */
export function placeDisc(disc: THREE.Object3D, data: Float32Array): THREE.Vector3 {
  const normal = new THREE.Vector3().fromArray(data, 3);
  if (normal.lengthSq() < 1e-12) normal.set(0, 0, 1);
  normal.normalize();
  disc.position.fromArray(data, 0);
  disc.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), normal);
  disc.scale.set(data[6]!, data[6]!, 1);
  return normal;
}

/** Text of a label: "{}" is replaced by the value in its unit. */
export function labelText(text: string, value: number, unit: string): string {
  const shown = Number.isFinite(value) ? `${Number(value.toPrecision(3))}${unit ? ` ${unit}` : ''}` : '–';
  return text.replaceAll('{}', shown);
}

const labelHeightM = 0.0035;

export class Label implements Drawn {
  readonly root: THREE.Sprite;
  private readonly paper = document.createElement('canvas');
  private readonly writing = new THREE.CanvasTexture(this.paper);
  private readonly material = new THREE.SpriteMaterial({ map: this.writing, depthTest: false, toneMapped: false });
  private written: string | null = null;

  constructor(private readonly context: DrawableContext) {
    this.root = new THREE.Sprite(this.material);
    this.root.renderOrder = 900;
    this.root.center.set(0.5, -0.2);
  }

  update(data: Float32Array): void {
    this.root.visible = data.length > 0;
    if (!this.root.visible) return;
    this.root.position.fromArray(data, 0);
    const { declared } = this.context;
    this.write(labelText(declared.text, data[3]!, declared.value.unit));
  }

  dispose(): void {
    this.root.removeFromParent();
    this.writing.dispose();
    this.material.dispose();
  }

  private write(text: string): void {
    if (text === this.written) return;
    this.written = text;
    const c = this.paper.getContext('2d')!;
    const font = '44px sans-serif';
    c.font = font;
    this.paper.width = Math.ceil(c.measureText(text).width) + 32;
    this.paper.height = 64;
    c.font = font;
    c.fillStyle = 'rgba(12, 15, 18, 0.7)';
    c.fillRect(0, 0, this.paper.width, this.paper.height);
    const [r, g, b] = this.context.material.rgba.map((x) => Math.round(255 * x));
    c.fillStyle = `rgb(${r} ${g} ${b})`;
    c.fillText(text, 16, 47);
    this.root.scale.set((labelHeightM * this.paper.width) / this.paper.height, labelHeightM, 1);
    this.writing.dispose();
    this.writing.needsUpdate = true;
  }
}

/** Rigid parts, each at its pose; the last mesh serves all links beyond. */
export class Links implements Drawn {
  readonly root = new THREE.Group();
  private readonly parts: { geometry: THREE.BufferGeometry; material: THREE.MeshPhysicalMaterial }[];
  private readonly placed: THREE.Mesh[] = [];

  constructor(context: DrawableContext) {
    this.parts = context.meshes.map((m) => {
      const shape = creased(m.positions, m.indices, 0.6);
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute('position', new THREE.BufferAttribute(shape.positions, 3));
      geometry.setAttribute('normal', new THREE.BufferAttribute(shape.normals, 3));
      return { geometry, material: lookOf(context, m.rgba) };
    });
  }

  update(data: Float32Array): void {
    const n = this.parts.length > 0 ? data.length / 8 : 0;
    while (this.placed.length < n) {
      const part = this.parts[Math.min(this.placed.length, this.parts.length - 1)]!;
      const mesh = moving(new THREE.Mesh(part.geometry, part.material));
      this.placed.push(mesh);
      this.root.add(mesh);
    }
    this.placed.forEach((mesh, k) => {
      mesh.visible = k < n;
      if (!mesh.visible) return;
      mesh.position.fromArray(data, 8 * k);
      mesh.quaternion.set(data[8 * k + 4]!, data[8 * k + 5]!, data[8 * k + 6]!, data[8 * k + 3]!).normalize();
    });
  }

  dispose(): void {
    this.root.removeFromParent();
    for (const p of this.parts) {
      p.geometry.dispose();
      p.material.dispose();
    }
  }
}
