// SPDX-License-Identifier: GPL-3.0-or-later
// What steel and wet tissue reflect: a dim operating room, lamps around, and the bright ring of the microscope.
import * as THREE from 'three';

const bands: [down: number, colour: [number, number, number]][] = [
  [-1, [0.17, 0.17, 0.18]],
  [0, [0.07, 0.075, 0.08]],
  [0.2, [0.03, 0.05, 0.05]],
  [0.35, [0.07, 0.12, 0.12]],
  [0.6, [0.14, 0.22, 0.215]],
  [0.68, [0.62, 0.52, 0.4]],
  [0.8, [0.85, 0.74, 0.58]],
  [0.86, [0.6, 0.24, 0.18]],
  [1, [0.8, 0.36, 0.28]],
];

// Lamps all around at mid height, dark between them: that contrast is what makes metal look like metal.
const lamps: [azimuth: number, polar: number, wide: number, high: number, power: number][] = [
  [0.35, 1.05, 2.0, 4.2, 4.6],
  [1.35, 0.85, 3.2, 1.6, 5.2],
  [2.35, 1.1, 1.4, 4.4, 4.4],
  [3.25, 1.25, 2.4, 2.6, 3.2],
  [4.05, 0.95, 1.6, 4.0, 4.8],
  [4.9, 1.2, 3.0, 1.5, 3.6],
  [5.65, 0.9, 1.2, 4.2, 5.0],
  // Just under the horizon: sterile white trays and sheets that catch the light; they streak slanting shafts.
  [0.8, 1.75, 1.0, 1.6, 3.4],
  [2.0, 1.85, 1.2, 1.8, 3.0],
  [2.9, 1.8, 0.8, 2.0, 3.4],
  [3.7, 1.8, 1.0, 1.8, 2.8],
  [5.2, 1.75, 1.3, 1.6, 3.0],
  [6.1, 1.9, 0.9, 1.8, 3.2],
];

const glow = (r: number, g: number, b: number) =>
  new THREE.MeshBasicMaterial({ color: new THREE.Color(r, g, b), side: THREE.DoubleSide });

/** Above: a dim room. Below: what instruments really mirror, the lit field itself: brain, bone around it, drapes. */
function makeDome(): THREE.Mesh {
  const dome = new THREE.SphereGeometry(10, 48, 48);
  const colours = new Float32Array(dome.attributes.position!.count * 3);
  for (let i = 0; i < colours.length / 3; i++) {
    const down = -dome.attributes.position!.getZ(i) / 10;
    const k = Math.max(
      1,
      bands.findIndex((b) => b[0] >= down),
    );
    const [d0, c0] = bands[k - 1]!;
    const [d1, c1] = bands[k]!;
    const t = Math.max(0, Math.min(1, (down - d0) / (d1 - d0)));
    colours.set(
      c0.map((v, j) => v + (c1[j]! - v) * t),
      i * 3,
    );
  }
  dome.setAttribute('color', new THREE.BufferAttribute(colours, 3));
  return new THREE.Mesh(dome, new THREE.MeshBasicMaterial({ vertexColors: true, side: THREE.BackSide }));
}

/**
 * The same light without reflections, for slow machines. It shines from +z in the frame of the field. The colours are
 * means of the room's light over directions, weighted by the cosine to +z and to -z.
 */
export function plainRoom(): THREE.HemisphereLight {
  return new THREE.HemisphereLight(new THREE.Color(0.8, 0.785, 0.78), new THREE.Color(0.4, 0.29, 0.24));
}

export function makeEnvironment(
  renderer: THREE.WebGLRenderer,
  towardsEye: THREE.Vector3,
  up: THREE.Vector3,
): THREE.Texture {
  const room = new THREE.Scene();
  const holder = new THREE.Group();
  // Frame of the field: +z to the microscope, +y up in the picture.
  const z = towardsEye.clone().normalize();
  const x = new THREE.Vector3().crossVectors(up, z).normalize();
  const y = new THREE.Vector3().crossVectors(z, x);
  holder.matrixAutoUpdate = false;
  holder.matrix.makeBasis(x, y, z);
  room.add(holder);
  const add = (geometry: THREE.BufferGeometry, material: THREE.Material, at: [number, number, number]) => {
    const mesh = new THREE.Mesh(geometry, material);
    mesh.position.set(...at);
    mesh.lookAt(0, 0, 0);
    holder.add(mesh);
  };
  holder.add(makeDome());
  for (const [azimuth, polar, wide, high, power] of lamps)
    add(new THREE.PlaneGeometry(wide, high), glow(power, power, power * 1.03), [
      8 * Math.sin(polar) * Math.cos(azimuth),
      8 * Math.sin(polar) * Math.sin(azimuth),
      8 * Math.cos(polar),
    ]);
  // Microscope: dark body with a ring of light around the lens.
  add(new THREE.CircleGeometry(1.9, 32), glow(0.1, 0.1, 0.11), [0, 0, 8]);
  add(new THREE.RingGeometry(0.75, 1.3, 40), glow(17, 16, 14.5), [0, 0, 7.9]);
  for (const s of [-1, 1]) add(new THREE.CircleGeometry(0.4, 20), glow(14, 13.2, 12), [s * 1.55, 0.5, 7.8]);
  const generator = new THREE.PMREMGenerator(renderer);
  const target = generator.fromScene(room, 0.004, 0.1, 50);
  generator.dispose();
  room.traverse((o) => {
    if (o instanceof THREE.Mesh) {
      o.geometry.dispose();
      (o.material as THREE.Material).dispose();
    }
  });
  return target.texture;
}
