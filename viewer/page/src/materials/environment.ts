// SPDX-License-Identifier: GPL-3.0-or-later
// What steel and wet tissue reflect: a dim operating room, two lamps overhead, and the bright ring of the microscope.
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
    const c = t > 0 ? [0.10 + 0.18 * t, 0.11 + 0.19 * t, 0.13 + 0.20 * t] : [0.06, 0.085, 0.08];
    colours.set(c, i * 3);
  }
  dome.setAttribute('color', new THREE.BufferAttribute(colours, 3));
  holder.add(new THREE.Mesh(dome, new THREE.MeshBasicMaterial({ vertexColors: true, side: THREE.BackSide })));
  add(new THREE.PlaneGeometry(5, 2.2), glow(3.2, 3.3, 3.5), [-5.5, 4.5, 4.5]);
  add(new THREE.PlaneGeometry(4.5, 1.6), glow(2.4, 2.4, 2.3), [6, 2.5, 4]);
  add(new THREE.PlaneGeometry(1.2, 6), glow(1.4, 1.5, 1.6), [7, -5, 2.5]);
  add(new THREE.PlaneGeometry(1.4, 5), glow(1.2, 1.25, 1.3), [-7.5, -4, 1.5]);
  // Microscope: dark body with a ring of light around the lens.
  add(new THREE.CircleGeometry(1.9, 32), glow(0.02, 0.02, 0.022), [0, 0, 8]);
  add(new THREE.RingGeometry(0.75, 1.15, 40), glow(17, 16, 14.5), [0, 0, 7.9]);
  for (const s of [-1, 1]) add(new THREE.CircleGeometry(0.4, 20), glow(14, 13.2, 12), [s * 1.55, 0.5, 7.8]);
  const generator = new THREE.PMREMGenerator(renderer);
  const target = generator.fromScene(room, 0.012, 0.1, 50);
  generator.dispose();
  room.traverse((o) => {
    if (o instanceof THREE.Mesh) { o.geometry.dispose(); (o.material as THREE.Material).dispose(); }
  });
  return target.texture;
}
