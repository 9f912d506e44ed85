// SPDX-License-Identifier: GPL-3.0-or-later
// Reads a place back from a picture's depth. The answer comes when the graphics card has got there; the page goes on
// meanwhile.
import * as THREE from 'three';

export class DepthProbe {
  // In bytes: before floats are read back, the card is asked whether it can, and the page would wait for the answer.
  private readonly one = new THREE.WebGLRenderTarget(1, 1);
  private readonly material = new THREE.ShaderMaterial({
    uniforms: { depth_map: { value: null }, at: { value: new THREE.Vector2() } },
    vertexShader: 'void main() { gl_Position = vec4(position.xy, 0.0, 1.0); }',
    fragmentShader: `uniform highp sampler2D depth_map; uniform vec2 at;
      void main() {
        vec3 digits = fract(min(texture2D(depth_map, at).x, 0.9999999) * vec3(1.0, 255.0, 65025.0));
        gl_FragColor = vec4(digits - digits.yzz * vec3(1.0 / 255.0, 1.0 / 255.0, 0.0), 1.0);
      }`,
    depthTest: false,
    blending: THREE.NoBlending,
  });
  private readonly scene = new THREE.Scene();
  private readonly flat = new THREE.OrthographicCamera(-1, 1, 1, -1, 0, 1);

  constructor(private readonly renderer: THREE.WebGLRenderer) {
    const quad = new THREE.Mesh(new THREE.PlaneGeometry(2, 2), this.material);
    quad.frustumCulled = false;
    this.scene.add(quad);
  }

  /** uv: of a place in the picture of the camera, which may move on. Null: nothing is there, or the card was reset. */
  async read(depth: THREE.Texture, camera: THREE.Camera, uv: THREE.Vector2): Promise<THREE.Vector3 | null> {
    const { renderer } = this;
    const out = new THREE.Matrix4().multiplyMatrices(camera.matrixWorld, camera.projectionMatrixInverse);
    this.material.uniforms.depth_map!.value = depth;
    (this.material.uniforms.at!.value as THREE.Vector2).copy(uv);
    renderer.setRenderTarget(this.one);
    renderer.render(this.scene, this.flat);
    renderer.setRenderTarget(null);
    const bytes = new Uint8Array(4);
    try {
      await renderer.readRenderTargetPixelsAsync(this.one, 0, 0, 1, 1, bytes);
    } catch {
      return null;
    }
    const far = (bytes[0]! + bytes[1]! / 255 + bytes[2]! / 65025) / 255;
    if (!(far > 0 && far < 0.99999)) return null;
    return new THREE.Vector3(uv.x * 2 - 1, uv.y * 2 - 1, far * 2 - 1).applyMatrix4(out);
  }
}
