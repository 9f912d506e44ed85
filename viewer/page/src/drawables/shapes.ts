// SPDX-License-Identifier: GPL-3.0-or-later
// Triangle patches, planes, labels and rigid links, drawn plainly.
import * as THREE from 'three';
import { creased } from '../geometry';
import { indexedGeometry } from '../indexed_geometry';
import { TextSprite } from '../text_sprite';
import type { DrawableContext, Drawn } from './drawn';
import { lookOf, moving } from './look';
import { quantity, significant } from '../languages/numbers';
import { said } from '../languages/said';

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
  const shown = Number.isFinite(value) ? quantity(significant(value, 3), unit) : '–';
  return said(text).replaceAll('{}', shown);
}

const labelHeightM = 0.0035;

export class Label implements Drawn {
  readonly root: THREE.Sprite;
  private readonly text: TextSprite;

  constructor(private readonly context: DrawableContext) {
    this.text = new TextSprite(labelHeightM, context.material.rgba.slice(0, 3));
    this.root = this.text.sprite;
  }

  update(data: Float32Array): void {
    this.root.visible = data.length > 0;
    if (!this.root.visible) return;
    this.root.position.fromArray(data, 0);
    const { declared } = this.context;
    this.text.write(labelText(declared.text, data[3]!, declared.value.unit));
  }

  dispose(): void {
    this.text.dispose();
  }
}

/** Rigid parts, each at its pose; the last mesh serves all links beyond. */
export class Links implements Drawn {
  readonly root = new THREE.Group();
  private readonly parts: { geometry: THREE.BufferGeometry; material: THREE.MeshPhysicalMaterial }[];
  private readonly placed: THREE.Mesh[] = [];

  constructor(context: DrawableContext) {
    this.parts = context.meshes.map((m) => {
      const geometry = indexedGeometry(creased(m.positions, m.indices, 0.6));
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
