// SPDX-License-Identifier: GPL-3.0-or-later
// Puts the skinning law of skinning.ts into three's materials: the lit pass and the shadow pass use the same code.
import * as THREE from 'three';
import { type NodeField, skinOffsets, texelsPerNode, textureWidth } from './skinning';

const declarations = /* glsl */ `
uniform highp sampler2D node_field;
attribute vec4 skin_nodes;
attribute vec4 skin_weights;
attribute vec3 skin_offset;
void skin(in vec3 n, out vec3 x, out vec3 m) {
  vec3 c0 = vec3(0.0), c1 = vec3(0.0), c2 = vec3(0.0);
  x = skin_offset;
  for (int k = 0; k < 4; k++) {
    int t = int(skin_nodes[k] + 0.5) * ${texelsPerNode};
    ivec2 at = ivec2(t % ${textureWidth}, t / ${textureWidth});
    float w = skin_weights[k];
    x += w * texelFetch(node_field, at, 0).xyz;
    c0 += w * texelFetch(node_field, at + ivec2(1, 0), 0).xyz;
    c1 += w * texelFetch(node_field, at + ivec2(2, 0), 0).xyz;
    c2 += w * texelFetch(node_field, at + ivec2(3, 0), 0).xyz;
  }
  m = normalize(c0 * n.x + c1 * n.y + c2 * n.z);
}
`;

export class SkinTexture {
  readonly texture: THREE.DataTexture;

  constructor(readonly field: NodeField) {
    this.texture = new THREE.DataTexture(field.texels, textureWidth, field.rows, THREE.RGBAFormat, THREE.FloatType);
    this.texture.minFilter = this.texture.magFilter = THREE.NearestFilter;
    this.texture.needsUpdate = true;
  }

  update(x: Float32Array): void {
    this.field.update(x);
    this.texture.needsUpdate = true;
  }

  dispose(): void {
    this.texture.dispose();
  }
}

type Shader = THREE.WebGLProgramParametersWithUniforms;

export function injectSkinning(shader: Shader, skin: SkinTexture): void {
  shader.uniforms.node_field = { value: skin.texture };
  shader.vertexShader = shader.vertexShader
    .replace('#include <common>', `#include <common>\n${declarations}`)
    .replace(
      '#include <beginnormal_vertex>',
      'vec3 skinned_x; vec3 objectNormal; skin(normal, skinned_x, objectNormal);',
    )
    .replace('#include <begin_vertex>', 'vec3 transformed = skinned_x;');
}

/**
 * Shadow pass material of a skinned mesh. The depth shader's normal branch is inactive, so it skins at begin_vertex.
 */
export function skinnedDepthMaterial(skin: SkinTexture): THREE.MeshDepthMaterial {
  const m = new THREE.MeshDepthMaterial({ depthPacking: THREE.RGBADepthPacking, side: THREE.DoubleSide });
  m.onBeforeCompile = (shader) => {
    shader.uniforms.node_field = { value: skin.texture };
    shader.vertexShader = shader.vertexShader
      .replace('#include <common>', `#include <common>\n${declarations}`)
      .replace(
        '#include <begin_vertex>',
        'vec3 transformed; vec3 unused_normal; skin(vec3(0.0, 0.0, 1.0), transformed, unused_normal);',
      );
  };
  m.customProgramCacheKey = () => 'skinned_depth';
  return m;
}

/** Adds the skinning attributes to a geometry whose rest positions are set; `rest`: of the nodes. */
export function setSkinAttributes(
  geometry: THREE.BufferGeometry,
  nodes: Uint32Array,
  weights: Float32Array,
  rest: Float32Array,
): void {
  geometry.setAttribute(
    'skin_offset',
    new THREE.BufferAttribute(skinOffsets(rest, geometry.attributes.position!.array, nodes, weights), 3),
  );
  geometry.setAttribute('skin_nodes', new THREE.BufferAttribute(Float32Array.from(nodes), 4));
  geometry.setAttribute('skin_weights', new THREE.BufferAttribute(weights, 4));
}
