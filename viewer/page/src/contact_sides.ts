// SPDX-License-Identifier: GPL-3.0-or-later
// What may touch in a scene, by the numbers that frames give to both sides of a contact (docs/scene-bundle.md).
import { text } from './languages/text';

export interface ContactSide {
  /** Id of the tool or body. */
  owner: string;
  /** Element of the owner in the scene file. */
  kind: string;
  /** instrument, implant, deformable or fixed. */
  role: string;
  /** Id of the surface; '': pieces of a tool. */
  part: string;
  material: string;
}

const word = (v: unknown): string => (typeof v === 'string' ? v : '');

/** Recordings of before have none. Throws if the numbers are not those of the order. */
export function parseContactSides(json: unknown): ContactSide[] {
  if (json === undefined) return [];
  if (!Array.isArray(json)) throw new Error(text('contact sides of the scene are no list'));
  return json.map((side: unknown, k) => {
    const s = (side ?? {}) as Record<string, unknown>;
    if (s.number !== k || word(s.owner) === '')
      throw new Error(text('contact side {number} of the scene is damaged', { number: k }));
    return {
      ...{ owner: word(s.owner), kind: word(s.kind), role: word(s.role) },
      ...{ part: word(s.part), material: word(s.material) },
    };
  });
}
