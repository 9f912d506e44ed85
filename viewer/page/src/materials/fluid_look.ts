// SPDX-License-Identifier: GPL-3.0-or-later
// How light goes through a fluid, from the declared material. Named ones are measured, others follow from their colour.
import type { MaterialData } from '../step_data/declarations';

type Triple = [number, number, number];

export interface FluidLook {
  /** 1/m, of red, green and blue. */
  absorb: Triple;
  /** What a deep pool shows, linear light. */
  scatter: Triple;
  /** Factor on what it has wetted. */
  stain: Triple;
  /** Of drops in the air. */
  drop: Triple;
  /** 0..1: how much of a still pool sets. */
  clots: number;
}

/** Its cells scatter: whole blood hides what lies a millimetre deep, and throws back red light alone. */
const named: Record<string, FluidLook> = {
  blood: {
    absorb: [1500, 8200, 7400],
    scatter: [0.115, 0.0032, 0.003],
    stain: [0.8, 0.4, 0.36],
    drop: [0.1441, 0.0015, 0.0015],
    clots: 1,
  },
};

const linear = (c: number): number => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);

/** The clearer the fluid (translucency), the further light goes: from half a millimetre to a decimetre. */
export function fluidLook(name: string, m: MaterialData): FluidLook {
  const known = named[name];
  if (known) return known;
  const colour = [0, 1, 2].map((k) => linear(m.rgba[k]!)) as Triple;
  const most = Math.max(1e-3, ...colour);
  const hue = colour.map((c) => c / most) as Triple;
  const clear = 1 - 0.99 * m.translucency;
  return {
    absorb: hue.map((h) => (850 + 4350 * (1 - h)) * clear) as Triple,
    scatter: colour.map((c) => 0.3 * c * clear) as Triple,
    stain: hue.map((h) => 1 - 0.6 * (1 - h) * clear) as Triple,
    drop: colour,
    clots: 0,
  };
}
