// SPDX-License-Identifier: GPL-3.0-or-later
// The vessel between the lobes, with a gizmo that moves or turns it about its neck. Millimetres, frame of the approach.
import { type BufferGeometry, Group, type Mesh, Vector3, type Vector3Tuple } from 'three';
import { text } from '../../languages/text';
import { FieldPicture, geometryAt, surfaceMesh } from './field_picture';
import { placedAt, type Pose, poseFrom, type PoseFacts, rotationOf } from './pose';

const vessel = 'vessel';

export class PoseView extends FieldPicture {
  /** At the neck; what is in it turns about it. */
  private readonly pivot = new Group();
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
    const words = text('The vessel between the lobes, to be moved and turned');
    super(words, placedAt(facts.pose, facts.neck), facts.toSurgeon);
    this.scene.add(this.pivot);
    this.gizmo.attach(this.pivot);
    this.gizmo.addEventListener('objectChange', () => moved(this.pose));
    this.gizmo.addEventListener('mouseUp', () => placed(this.pose));
  }

  override end(): void {
    super.end();
    Object.assign(window, { __pose: undefined });
  }

  /** url: of a surface by its name. */
  async load(url: (surface: string) => string): Promise<void> {
    const loaded = await Promise.all(
      this.facts.surfaces.map(async (name) => [name, await geometryAt(url(name))] as const),
    );
    for (const [name, geometry] of loaded) {
      const mesh = surfaceMesh(name, geometry);
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

  set pose(pose: Pose) {
    if (this.dragging) return;
    this.pivot.quaternion.copy(rotationOf(pose));
    this.pivot.position.copy(placedAt(pose, this.facts.neck));
    this.draw();
  }

  private get parted(): boolean {
    return [...this.whole].some(([mesh, geometry]) => mesh.geometry !== geometry);
  }

  /** Place of the gizmo's middle on the page, px, or of what is so far from it along the gizmo's axes, mm. */
  private handle(mm: Vector3Tuple = [0, 0, 0]): [number, number] {
    return this.onPage(new Vector3(...mm).applyQuaternion(this.pivot.quaternion).add(this.pivot.position));
  }
}
