// SPDX-License-Identifier: GPL-3.0-or-later
// Solid materials: with a texture of their own, as declared, or of an instrument's part that nothing declares.
import { describe, expect, it } from 'vitest';
import type { FieldUniforms } from '../src/materials/field';
import { solidMaterial } from '../src/materials/solid';

const field = {} as FieldUniforms;
const rgba = [0.78, 0.79, 0.81, 1];

describe('solid materials', () => {
  it('are metal in their own colour where nothing declares them', () => {
    const m = solidMaterial('cobalt', { field, rgba });
    expect(m.metalness).toBe(1);
    expect(m.roughness).toBeLessThan(0.3);
    expect(m.color.getHexString()).toBe('c7c9cf');
  });
  it('are as declared where a plugin or a scene declares them', () => {
    const m = solidMaterial('cobalt', { field, rgba, roughness: 0.7, metalness: 0 });
    expect(m.metalness).toBe(0);
    expect(m.roughness).toBe(0.7);
  });
  it('keep the colour of their texture', () => {
    const m = solidMaterial('gold', { field, rgba });
    expect(m.color.getHexString()).toBe('e0b45c');
  });
});
