// SPDX-License-Identifier: GPL-3.0-or-later
// An author's changes of thickness and stiffness by region (tools/case_builder/region_walls.h).
import type { RegionWall } from './api';
import { changedValue, withChanged } from './changes';

export type WallParameter = 'thickness' | 'young';

/** The name under which a proposed wall is changed: a region, or all vessels together. */
export function regionOf(wall: RegionWall): string {
  return ['neck', 'sac', 'bleb'].includes(wall.regions) ? wall.regions : 'vessels';
}

export const proposedValue = (wall: RegionWall, parameter: WallParameter): string =>
  parameter === 'thickness' ? `${wall.thicknessMm} mm` : `${wall.youngMpa} MPa`;

/** What was chosen in place of the proposal; null: nothing. */
export const chosenValue = (changes: readonly string[], region: string, parameter: WallParameter): string | null =>
  changedValue(changes, `${region}.${parameter}`);

/** The changes with that one; null: as proposed. */
export const withWall = (
  changes: readonly string[],
  region: string,
  parameter: WallParameter,
  value: string | null,
): string[] => withChanged(changes, `${region}.${parameter}`, value);
