// SPDX-License-Identifier: GPL-3.0-or-later
// The retractors between the lobes: one is chosen by a click and moved or turned by a gizmo at its tip. An arrow shows
// how far each draws its lobe.
import {
  ArrowHelper,
  type BufferGeometry,
  Group,
  Mesh,
  MeshStandardMaterial,
  Raycaster,
  Vector2,
  Vector3,
  type Vector3Tuple,
} from 'three';
import { text } from '../../languages/text';
import { FieldPicture, geometryAt, surfaceMesh } from '../pose/field_picture';
import { placedAt, type Pose, type PoseFacts, rotationOf } from '../pose/pose';
import { placedAs, type Retractor, turnOf } from './retractors';

const colours = { idle: '#9fb0bd', chosen: '#ffd166', way: '#6ec6ff' };
const stillPx = 5;
const [vessel, together] = ['vessel', 'retractors'];

interface Deeds {
  /** While it is dragged. */
  moved(k: number, r: Retractor): void;
  /** After the release. */
  placed(k: number, r: Retractor): void;
  chosen(k: number): void;
}

export class RetractorView extends FieldPicture {
  private blade: BufferGeometry | null = null;
  private all: Retractor[] = [];
  private stands: Group[] = [];
  private at = -1;
  private readonly pressed = new Vector2();

  constructor(
    private readonly facts: PoseFacts,
    pose: Pose,
    private readonly deeds: Deeds,
  ) {
    super(
      text('The retractors between the lobes, to be moved and turned'),
      placedAt(pose, facts.neck),
      facts.toSurgeon,
    );
    this.gizmo.addEventListener('objectChange', () => this.deeds.moved(this.at, this.now));
    this.gizmo.addEventListener('mouseUp', () => this.deeds.placed(this.at, this.now));
    this.canvas.addEventListener('pointerdown', (e) => this.pressed.set(e.clientX, e.clientY));
    this.canvas.addEventListener('pointerup', (e) => this.released(e));
  }

  override end(): void {
    super.end();
    Object.assign(window, { __retractors: undefined });
  }

  /** url: of a surface by its name. */
  async load(url: (surface: string) => string, pose: Pose): Promise<void> {
    const names = this.facts.surfaces.filter((name) => name !== together);
    const loaded = await Promise.all(names.map(async (name) => [name, await geometryAt(url(name))] as const));
    this.blade = await geometryAt(url('retractor'));
    for (const [name, geometry] of loaded) {
      const mesh = surfaceMesh(name, geometry);
      if (name === vessel) {
        mesh.position.set(pose[0]!, pose[1]!, pose[2]!);
        mesh.quaternion.copy(rotationOf(pose));
      }
      this.scene.add(mesh);
    }
    const handle = (k: number, mm: Vector3Tuple = [0, 0, 0]) => this.handle(k, mm);
    Object.assign(window, { __retractors: { handle, all: () => this.all, chosen: () => this.at } });
    this.show(this.all, this.at);
  }

  /** at: the chosen one; -1: none. */
  show(all: readonly Retractor[], at: number): void {
    this.all = [...all];
    this.at = at < all.length ? at : -1;
    if (!this.blade || this.dragging) return;
    this.gizmo.detach();
    for (const stand of this.stands) this.scene.remove(stand);
    this.stands = this.all.map((r, k) => this.stand(r, k === this.at));
    this.scene.add(...this.stands);
    const chosen = this.stands[this.at];
    if (chosen) this.gizmo.attach(chosen);
    this.draw();
  }

  private stand(r: Retractor, chosen: boolean): Group {
    const look = { color: chosen ? colours.chosen : colours.idle, roughness: 0.5, metalness: 0.2 };
    const stand = new Group().add(new Mesh(this.blade!, new MeshStandardMaterial(look)));
    stand.position.set(...r.tip_mm);
    stand.quaternion.copy(turnOf(r));
    const from = new Vector3(-r.pull_mm, 0, 0);
    if (r.pull_mm > 0) stand.add(new ArrowHelper(new Vector3(1, 0, 0), from, r.pull_mm, colours.way, 2, 1.2));
    return stand;
  }

  private get now(): Retractor {
    const stand = this.stands[this.at]!;
    return placedAs(this.all[this.at]!, stand.position, stand.quaternion);
  }

  private released(e: PointerEvent): void {
    if (this.dragging || this.pressed.distanceTo(new Vector2(e.clientX, e.clientY)) > stillPx) return;
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    const ray = new Raycaster();
    ray.setFromCamera(
      new Vector2(((e.clientX - left) / width) * 2 - 1, 1 - ((e.clientY - top) / height) * 2),
      this.camera,
    );
    const blades = this.stands.map((stand) => stand.children[0]!);
    const hit = ray.intersectObjects(blades, false)[0];
    const k = hit ? blades.indexOf(hit.object) : -1;
    if (k >= 0 && k !== this.at) this.deeds.chosen(k);
  }

  /** Place on the page, px, of what is so far from a tip along the blade's axes, mm. */
  private handle(k: number, mm: Vector3Tuple): [number, number] {
    const stand = this.stands[k]!;
    return this.onPage(new Vector3(...mm).applyQuaternion(stand.quaternion).add(stand.position));
  }
}
