// SPDX-License-Identifier: GPL-3.0-or-later
// Which way of drawing belongs to a kind and a material's style. A new way of drawing is added here.
import type { DrawableKind } from '../step_data/declarations';
import type { DrawableContext, Drawn } from './drawn';
import { Fibres } from './fibres';
import { FluidPlane } from './fluid_plane';
import { Jets } from './jets';
import { Disc, Label, Links, Patch } from './shapes';
import { Sheets, sheetPoints } from './sheets';
import { Points, Polylines } from './tubes';

type Maker = (c: DrawableContext) => Drawn;

const usual: Record<DrawableKind, Maker> = {
  points: (c) => new Points(c),
  polylines: (c) => new Polylines(c),
  patch: (c) => new Patch(c),
  plane: (c) => new Disc(c),
  label: (c) => new Label(c),
  links: (c) => new Links(c),
};

/** By "kind style". */
const special: Record<string, Maker> = {
  // A fibre is straight between two points; longer lines are tubes.
  'polylines fibre': (c) => (c.declared.pointsPerLine === 2 ? new Fibres(c) : new Polylines(c)),
  'polylines sheet': (c) => (c.declared.pointsPerLine === sheetPoints ? new Sheets(c) : new Polylines(c)),
  'polylines fluid': (c) => new Jets(c),
  'plane fluid': (c) => new FluidPlane(c),
};

export function makeDrawn(c: DrawableContext): Drawn {
  return (special[`${c.declared.kind} ${c.material.style}`] ?? usual[c.declared.kind])(c);
}
