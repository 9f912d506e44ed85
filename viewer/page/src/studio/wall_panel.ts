// SPDX-License-Identifier: GPL-3.0-or-later
// Thickness and stiffness of the wall, region by region: a calcified neck, a dome that tears.
import { el, setText } from '../hud/dom';
import { text } from '../languages/text';
import type { Project, RegionWall } from './api';
import type { Asks } from './editor';
import { replaceRows } from './fields';
import { parameterField } from './parameter_field';
import type { ScenesApi } from './scene_editor/api';
import type { ElementKind } from './scene_editor/declarations';
import { chosenValue, proposedValue, regionOf, type WallParameter, withWall } from './wall_changes';
import { reason } from './wording';

function regionText(region: string): string {
  switch (region) {
    case 'neck':
      return text('Neck');
    case 'sac':
      return text('Sac');
    case 'bleb':
      return text('Weak spot of the dome');
    default:
      return text('Vessels');
  }
}

const parameterText = (p: WallParameter): string =>
  p === 'thickness' ? text('Thickness') : text('Stiffness (Young’s modulus)');

export class WallPanel {
  readonly root: HTMLElement;
  private readonly rows = el('div', { class: 'rules' });
  private readonly proposed = el('button', { type: 'button' }, text('All as proposed'));
  private readonly say = el('p', { class: 'say', role: 'status' });
  private membrane: ElementKind | undefined;
  private shown = '';

  constructor(
    private readonly asks: Asks,
    private readonly api: ScenesApi,
  ) {
    this.proposed.onclick = () => void asks.choose({ walls: [] });
    this.root = el(
      'section',
      { class: 'walls' },
      el('h3', {}, text('8. The wall')),
      el('p', { class: 'hint' }, text('A calcified neck is stiff, a weak spot thin. Build again afterwards.')),
      this.rows,
      this.proposed,
      this.say,
    );
  }

  show(p: Project): void {
    const walls = p.built?.walls ?? [];
    this.root.hidden = walls.length === 0;
    this.proposed.disabled = p.choices.walls.length === 0;
    if (walls.length > 0) void this.fill(p, walls);
  }

  /** The declaration of the wall is asked for when it is first needed. */
  private async fill(p: Project, walls: RegionWall[]): Promise<void> {
    try {
      this.membrane ??= (await this.api.declarations()).get('membrane');
    } catch (e) {
      return setText(this.say, reason(e));
    }
    const now = JSON.stringify([p.name, walls, p.choices.walls]);
    if (now === this.shown) return;
    this.shown = now;
    replaceRows(
      this.rows,
      walls.map((wall) => this.row(wall, p.choices.walls)),
    );
  }

  private row(wall: RegionWall, changes: string[]): HTMLElement {
    const region = regionOf(wall);
    const fields = (['thickness', 'young'] as const).flatMap((name) => {
      const parameter = this.membrane?.parameters.find((p) => p.name === name);
      if (!parameter) return [];
      const value = {
        proposed: proposedValue(wall, name),
        chosen: chosenValue(changes, region, name),
        choose: (chosen: string | null) =>
          void this.asks.choose((now) => ({ walls: withWall(now.walls, region, name, chosen) })),
      };
      return [parameterField(parameter, `wall-${region}-${name}`, parameterText(name), value)];
    });
    const words = regionText(region);
    return el('div', { class: 'rule', role: 'group', 'aria-label': words }, el('strong', {}, words), ...fields);
  }
}
