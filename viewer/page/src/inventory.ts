// SPDX-License-Identifier: GPL-3.0-or-later
// What is in a scene that is looked at (`insula view`): inventory.json of the bundle, and the chosen thing drawn over
// the picture.
import * as THREE from 'three';

export interface InventoryItem {
  group: string;
  name: string;
  element: string;
  /** Measured, with units. */
  size: string;
  /** Parameters as written in the scene. */
  values: [string, string][];
  /** Where it is written. */
  file: string;
  /** Pairs of points, m. */
  lines: Float32Array;
  points: Float32Array;
}

type Json = Record<string, unknown>;

/** Reads items; what is not of the right shape is left out. */
export function parseInventory(json: unknown): InventoryItem[] {
  const items = (json as Json | null)?.items;
  if (!Array.isArray(items)) return [];
  const text = (v: unknown): string => (typeof v === 'string' ? v : '');
  const numbers = (v: unknown, each: number): Float32Array => {
    const a = Array.isArray(v) ? v.filter((x) => typeof x === 'number' && Number.isFinite(x)) : [];
    return new Float32Array(a.length % each === 0 ? a : []);
  };
  return (items as Json[])
    .filter((i) => text(i.name) !== '')
    .map((i) => ({
      group: text(i.group),
      name: text(i.name),
      element: text(i.element),
      size: text(i.size),
      file: text(i.file),
      values: (Array.isArray(i.values) ? i.values : [])
        .filter((v): v is [string, string] => Array.isArray(v) && v.length === 2)
        .map((v) => [text(v[0]), text(v[1])]),
      lines: numbers(i.lines_m, 6),
      points: numbers(i.points_m, 3),
    }));
}

/** The chosen item's lines and points, seen through everything. */
export class Highlight {
  readonly root = new THREE.Group();
  private readonly line = new THREE.LineBasicMaterial({
    color: 0x7dff9b,
    transparent: true,
    opacity: 0.8,
    depthTest: false,
    depthWrite: false,
    toneMapped: false,
  });
  private readonly dot = new THREE.PointsMaterial({
    color: 0xffd34d,
    size: 5,
    sizeAttenuation: false,
    depthTest: false,
    depthWrite: false,
    toneMapped: false,
  });

  show(item: InventoryItem | null): void {
    for (const o of [...this.root.children]) {
      (o as THREE.Points).geometry.dispose();
      o.removeFromParent();
    }
    if (!item) return;
    const add = (o: THREE.LineSegments | THREE.Points, values: Float32Array): void => {
      o.geometry.setAttribute('position', new THREE.BufferAttribute(values, 3));
      o.renderOrder = 1000;
      o.frustumCulled = false;
      this.root.add(o);
    };
    if (item.lines.length > 0) add(new THREE.LineSegments(new THREE.BufferGeometry(), this.line), item.lines);
    if (item.points.length > 0) add(new THREE.Points(new THREE.BufferGeometry(), this.dot), item.points);
  }
}

/** Where it is: the middle of all its points, m; null when it has no place. */
export function middle(item: InventoryItem): THREE.Vector3 | null {
  const box = new THREE.Box3();
  for (const a of [item.lines, item.points])
    for (let i = 0; i + 2 < a.length; i += 3) box.expandByPoint(new THREE.Vector3(a[i]!, a[i + 1]!, a[i + 2]!));
  return box.isEmpty() ? null : box.getCenter(new THREE.Vector3());
}
