// SPDX-License-Identifier: GPL-3.0-or-later
// Parts of the wall that are painted on the vessel: a plaque, a thin spot. Each has a thickness and a stiffness of its
// own.
import { el, setText } from '../../hud/dom';
import { text } from '../../languages/text';
import type { Point, Project } from '../api';
import type { Asks } from '../editor';
import { replaceRows } from '../fields';
import { asPoint } from '../neck_plane';
import { parameterField } from '../parameter_field';
import type { ScenesApi } from '../scene_editor/api';
import type { ElementKind } from '../scene_editor/declarations';
import { patchColour, type SurfaceView } from '../surface_view';
import { reason } from '../wording';
import { Brush } from './brush';
import { adds, freshPatch, mostPatches, type WallPatch, withoutPlaces, withStroke, withValue } from './patches';

/** What a drag on the vessel does to a part; part: may be one more than there are. */
interface Tool {
  part: number;
  erases: boolean;
}

/** What becomes of all parts. */
type Paints = (now: readonly WallPatch[]) => WallPatch[];

const valueNames = ['thickness', 'young'] as const;
const units = { thickness: 'mm', young: 'MPa' };

export class PaintPanel {
  readonly root: HTMLElement;
  private readonly rows = el('div', { class: 'rules' });
  private readonly fresh = el('button', { type: 'button', class: 'paint-new' }, text('Paint a new part'));
  private readonly say = el('p', { class: 'say', role: 'status' });
  private readonly brush: Brush;
  private patches: WallPatch[] = [];
  private tool: Tool | null = null;
  private membrane: ElementKind | undefined;

  constructor(
    private readonly asks: Asks,
    private readonly view: SurfaceView,
    private readonly api: ScenesApi,
  ) {
    this.brush = new Brush({
      at: (x, y) => this.placeAt(x, y),
      adds: (stroke, p) => adds(stroke, p, this.radius()),
      drawn: (stroke) => this.view.showPatches(this.changed(stroke)(this.patches)),
      done: (stroke) => this.choose(this.changed(stroke)),
    });
    view.root.append(this.brush.root);
    this.fresh.onclick = () => this.take({ part: this.patches.length, erases: false });
    this.root = el(
      'section',
      { class: 'wall-paint' },
      el('h3', {}, text('9. Painted parts of the wall')),
      el('p', { class: 'hint' }, text('Paint a plaque or a thin spot onto the vessel. Build again afterwards.')),
      this.rows,
      el('div', { class: 'buttons' }, this.fresh),
      this.say,
    );
  }

  show(p: Project): void {
    this.patches = p.choices.wallPatches;
    this.root.hidden = !p.facts;
    if (this.tool && this.tool.part > this.patches.length) this.tool = null;
    if (!this.brush.drawing) this.view.showPatches(this.patches);
    if (p.facts) void this.fill();
  }

  /** The declaration of the wall is asked for when it is first needed. */
  private async fill(): Promise<void> {
    try {
      this.membrane ??= (await this.api.declarations()).get('membrane');
    } catch (e) {
      return setText(this.say, reason(e));
    }
    const { tool } = this;
    replaceRows(
      this.rows,
      this.patches.map((patch, k) => this.row(patch, k)),
    );
    const painting = tool !== null && tool.part === this.patches.length;
    setText(this.fresh, painting ? text('Stop painting') : text('Paint a new part'));
    this.fresh.disabled = this.patches.length >= mostPatches;
    this.brush.on = tool !== null;
    setText(this.say, tool === null ? '' : text('Drag over the vessel. To turn it, stop painting first.'));
  }

  private radius(): number {
    return (this.patches[this.tool?.part ?? 0] ?? freshPatch()).radius_mm;
  }

  private placeAt(x: number, y: number): Point | null {
    const hit = this.view.hitAt(x, y);
    return hit && asPoint(hit);
  }

  /** What a stroke does with the tool that is held now. */
  private changed(stroke: readonly Point[]): Paints {
    const { part, erases } = this.tool ?? { part: this.patches.length, erases: false };
    return (now) => (erases ? withoutPlaces(now, part, stroke) : withStroke(now, part, stroke));
  }

  private choose(paints: Paints): void {
    void this.asks.choose((now) => ({ wall_patches: paints(now.wallPatches) }));
  }

  /** The same tool again: it is put down. */
  private take(tool: Tool): void {
    const same = this.tool?.part === tool.part && this.tool.erases === tool.erases;
    this.tool = same ? null : tool;
    if (this.tool) this.asks.toSurface();
    void this.fill();
  }

  private toolButton(part: number, erases: boolean): HTMLElement {
    const on = this.tool?.part === part && this.tool.erases === erases;
    const idle = erases ? text('Erase') : text('Paint more');
    const words = !on ? idle : erases ? text('Stop erasing') : text('Stop painting');
    const button = el('button', { type: 'button', id: `patch-${part}-${erases ? 'erase' : 'paint'}` }, words);
    button.onclick = () => this.take({ part, erases });
    return button;
  }

  private row(patch: WallPatch, k: number): HTMLElement {
    const choose = (value: Partial<WallPatch>) => this.choose((now) => withValue(now, k, value));
    const words = text('Part {n}', { n: k + 1 });
    const swatch = el('span', { class: 'swatch', 'aria-hidden': 'true', style: `background: ${patchColour(k)}` });
    const remove = el('button', { type: 'button' }, text('Remove'));
    remove.onclick = () => {
      this.tool = null;
      this.choose((now) => now.filter((_p, other) => other !== k));
    };
    const buttons = el('div', { class: 'buttons' }, this.toolButton(k, false), this.toolButton(k, true), remove);
    const fields = [
      ...valueNames.map((name) => this.valueField(patch, k, name, choose)),
      this.radiusField(patch, k, choose),
    ];
    return el(
      'div',
      { class: 'rule', role: 'group', 'aria-label': words },
      el('strong', {}, swatch, words),
      ...fields.filter((f) => f !== null),
      buttons,
    );
  }

  private valueField(
    patch: WallPatch,
    k: number,
    name: 'thickness' | 'young',
    choose: (value: Partial<WallPatch>) => void,
  ): HTMLElement | null {
    const parameter = this.membrane?.parameters.find((p) => p.name === name);
    const words = name === 'thickness' ? text('Thickness') : text('Stiffness (Young’s modulus)');
    const value = {
      proposed: '',
      unit: units[name],
      chosen: patch[name] === '' ? null : patch[name],
      choose: (chosen: string | null) => choose({ [name]: chosen ?? '' }),
    };
    return parameter ? parameterField(parameter, `patch-${k}-${name}`, words, value) : null;
  }

  private radiusField(patch: WallPatch, k: number, choose: (value: Partial<WallPatch>) => void): HTMLElement | null {
    const parameter = this.membrane?.parameters.find((p) => p.name === 'spot_radius');
    const value = {
      proposed: `${freshPatch().radius_mm} mm`,
      chosen: `${patch.radius_mm} mm`,
      choose: (chosen: string | null) =>
        choose({ radius_mm: chosen === null ? freshPatch().radius_mm : Number(chosen.split(' ')[0]) }),
    };
    return parameter ? parameterField(parameter, `patch-${k}-radius`, text('Radius of the brush'), value) : null;
  }
}
