// SPDX-License-Identifier: GPL-3.0-or-later
// Simpler shaders for slow machines. A wet film is a layer of its own, which doubles the work for light. The simpler
// shader makes the surface below it smoother instead.
import * as THREE from 'three';

/** Materials whose `userData.has_cheap` is set: their shader knows CHEAP, or they have a film. */
export function setCheapMaterial(material: THREE.Material, cheap: boolean): void {
  if (!material.userData.has_cheap) return;
  const m = material as THREE.MeshPhysicalMaterial & { defines?: Record<string, unknown> };
  const defines = (m.defines ??= {});
  if ('CHEAP' in defines === cheap) return;
  m.needsUpdate = true;
  if (cheap) {
    defines.CHEAP = '';
    // Without reflections of its own, it would be dull: it keeps the film.
    if (m.specularIntensity === 0) return;
    m.userData.film = { clearcoat: m.clearcoat, roughness: m.roughness };
    m.roughness = THREE.MathUtils.lerp(m.roughness, m.clearcoatRoughness, 0.6 * m.clearcoat);
    m.clearcoat = 0;
  } else {
    delete defines.CHEAP;
    Object.assign(m, m.userData.film);
  }
}
