// SPDX-License-Identifier: GPL-3.0-or-later
// What steel and wet tissue reflect: a dim operating room, lamps around, and the bright ring of the microscope.
import * as THREE from 'three';

export function make_environment(renderer: THREE.WebGLRenderer, towards_eye: THREE.Vector3, up: THREE.Vector3): THREE.Texture {
  const room = new THREE.Scene();
  const holder = new THREE.Group();
  // Frame of the field: +z to the microscope, +y up in the picture.
  const z = towards_eye.clone().normalize();
  const x = new THREE.Vector3().crossVectors(up, z).normalize();
  const y = new THREE.Vector3().crossVectors(z, x);
  holder.matrixAutoUpdate = false;
  holder.matrix.makeBasis(x, y, z);
  room.add(holder);
  const glow = (r: number, g: number, b: number) => new THREE.MeshBasicMaterial({ color: new THREE.Color(r, g, b), side: THREE.DoubleSide });
  const add = (geometry: THREE.BufferGeometry, material: THREE.Material, at: [number, number, number]) => {
    const mesh = new THREE.Mesh(geometry, material);
    mesh.position.set(...at);
    mesh.lookAt(0, 0, 0);
    holder.add(mesh);
  };
  // Walls: darker below, a little cool; the drapes send green from around the field.
  const dome = new THREE.SphereGeometry(10, 24, 16);
  const colours = new Float32Array(dome.attributes.position!.count * 3);
  for (let i = 0; i < colours.length / 3; i++) {
    const t = dome.attributes.position!.getZ(i) / 10;
    const horizon = Math.exp(-((t / 0.35) ** 2));
    const c = [0.05 + 0.10 * Math.max(0, t) + 0.07 * horizon, 0.055 + 0.10 * Math.max(0, t) + 0.08 * horizon, 0.055 + 0.11 * Math.max(0, t) + 0.085 * horizon];
    colours.set(c, i * 3);
  }
  dome.setAttribute('color', new THREE.BufferAttribute(colours, 3));
  holder.add(new THREE.Mesh(dome, new THREE.MeshBasicMaterial({ vertexColors: true, side: THREE.BackSide })));
  // Lamps all around at mid height, dark between them: that contrast is what makes metal look like metal.
  const lamps: [azimuth: number, polar: number, wide: number, high: number, power: number][] = [
    [0.35, 1.05, 2.0, 4.2, 4.6], [1.35, 0.85, 3.2, 1.6, 5.2], [2.35, 1.1, 1.4, 4.4, 4.4], [3.25, 1.25, 2.4, 2.6, 3.2],
    [4.05, 0.95, 1.6, 4.0, 4.8], [4.9, 1.2, 3.0, 1.5, 3.6], [5.65, 0.9, 1.2, 4.2, 5.0],
  ];
  for (const [azimuth, polar, wide, high, power] of lamps)
    add(new THREE.PlaneGeometry(wide, high), glow(power, power, power * 1.03),
      [8 * Math.sin(polar) * Math.cos(azimuth), 8 * Math.sin(polar) * Math.sin(azimuth), 8 * Math.cos(polar)]);
  // Microscope: dark body with a ring of light around the lens.
  add(new THREE.CircleGeometry(1.9, 32), glow(0.10, 0.10, 0.11), [0, 0, 8]);
  add(new THREE.RingGeometry(0.75, 1.3, 40), glow(17, 16, 14.5), [0, 0, 7.9]);
  for (const s of [-1, 1]) add(new THREE.CircleGeometry(0.4, 20), glow(14, 13.2, 12), [s * 1.55, 0.5, 7.8]);
  const generator = new THREE.PMREMGenerator(renderer);
  const target = generator.fromScene(room, 0.004, 0.1, 50);
  generator.dispose();
  room.traverse((o) => {
    if (o instanceof THREE.Mesh) { o.geometry.dispose(); (o.material as THREE.Material).dispose(); }
  });
  return target.texture;
}
