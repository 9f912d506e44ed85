// SPDX-License-Identifier: GPL-3.0-or-later
// Draws the scene through the microscope: one eye or two, each into its own picture, then through the lens onto the
// screen.
import * as THREE from 'three';
import { DepthProbe } from './depth_probe';
import { makeLensMaterial, type LensSettings } from './lens_material';
import { anaglyphLeft, anaglyphRight, placeEye } from './stereo';
import type { StereoMode } from './stereo_modes';

export type { LensSettings } from './lens_material';

/** A rendered picture with its depth, and the lens it is seen through. */
export class Eyepiece {
  readonly camera = new THREE.PerspectiveCamera();
  readonly material: THREE.ShaderMaterial;
  private target: THREE.WebGLRenderTarget | null = null;

  constructor(inSpace: boolean) {
    this.material = makeLensMaterial(inSpace);
  }

  get depth(): THREE.DepthTexture | null {
    return this.target?.depthTexture ?? null;
  }

  configure(settings: LensSettings): void {
    this.material.defines = {
      ...(settings.occlusion ? { OCCLUSION: '' } : {}),
      ...(settings.depthOfField ? { DEPTH_OF_FIELD: '' } : {}),
    };
    this.material.needsUpdate = true;
    this.drop();
  }

  /** Renders the scene into the picture; the camera's field of view and range are those of the lens. */
  take(
    renderer: THREE.WebGLRenderer,
    scene: THREE.Scene,
    camera: THREE.PerspectiveCamera,
    focus: number,
    size: THREE.Vector2,
    samples: number,
  ): void {
    if (!this.target || this.target.width !== size.x || this.target.height !== size.y) this.makeTarget(size, samples);
    const target = this.target!;
    renderer.setRenderTarget(target);
    renderer.render(scene, camera);
    const u = this.material.uniforms;
    u.picture!.value = target.texture;
    u.depth_map!.value = target.depthTexture;
    (u.size!.value as THREE.Vector2).copy(size);
    (u.near_far!.value as THREE.Vector2).set(camera.near, camera.far);
    u.focus!.value = focus;
    u.tan_half!.value = Math.tan(THREE.MathUtils.degToRad(camera.fov) / 2);
  }

  drop(): void {
    this.target?.dispose();
    this.target?.depthTexture?.dispose();
    this.target = null;
  }

  private makeTarget(size: THREE.Vector2, samples: number): void {
    this.drop();
    this.target = new THREE.WebGLRenderTarget(size.x, size.y, {
      type: THREE.HalfFloatType,
      samples,
      generateMipmaps: true,
      minFilter: THREE.LinearMipmapLinearFilter,
      magFilter: THREE.LinearFilter,
      depthTexture: new THREE.DepthTexture(size.x, size.y, THREE.UnsignedIntType),
    });
  }
}

export class Lens {
  /** Of the last picture, shadows included. */
  triangles = 0;
  calls = 0;
  private readonly eyes = [new Eyepiece(false), new Eyepiece(false)];
  private readonly scene = new THREE.Scene();
  private readonly flat = new THREE.OrthographicCamera(-1, 1, 1, -1, 0, 1);
  private readonly quad: THREE.Mesh;
  private settings: LensSettings = { occlusion: false, depthOfField: false, samples: 0 };
  private seenBy: THREE.PerspectiveCamera | null = null;
  private mode: StereoMode = 'off';
  private readonly probe: DepthProbe;

  constructor(private readonly renderer: THREE.WebGLRenderer) {
    this.probe = new DepthProbe(renderer);
    this.quad = new THREE.Mesh(new THREE.PlaneGeometry(2, 2), this.eyes[0]!.material);
    this.quad.frustumCulled = false;
    this.scene.add(this.quad);
  }

  configure(settings: LensSettings): void {
    this.settings = settings;
    for (const e of this.eyes) e.configure(settings);
  }

  /** scale: pixels of one eye's picture each way, over those of the canvas. */
  render(
    scene: THREE.Scene,
    camera: THREE.PerspectiveCamera,
    focus: number,
    mode: StereoMode,
    angleRad: number,
    scale = 1,
  ): void {
    if (mode !== this.mode) {
      this.eyes[1]!.drop();
      this.mode = mode;
    }
    if (mode !== 'sbs' && mode !== 'anaglyph') {
      this.seenBy = camera;
      this.take(0, scene, camera, focus, scale);
      this.show(0, new THREE.Matrix3(), 0);
      return;
    }
    const size = this.renderer.getDrawingBufferSize(new THREE.Vector2());
    const each = mode === 'sbs' ? new THREE.Vector2(Math.max(1, Math.floor(size.x / 2)), size.y) : size;
    takeBoth(this.renderer, scene, camera, focus, angleRad, each, this.settings.samples, this.eyes);
    this.triangles = 2 * this.renderer.info.render.triangles;
    this.calls = 2 * this.renderer.info.render.calls;
    this.seenBy = this.eyes[1]!.camera;
    const wide = size.x / this.renderer.getPixelRatio();
    const high = size.y / this.renderer.getPixelRatio();
    if (mode === 'sbs') {
      for (const k of [0, 1]) {
        this.renderer.setViewport((k * wide) / 2, 0, wide / 2, high);
        this.renderer.autoClear = k === 0;
        this.show(k, new THREE.Matrix3(), 0);
      }
      this.renderer.setViewport(0, 0, wide, high);
    } else {
      this.show(0, new THREE.Matrix3().set(...anaglyphLeft), 0.25);
      this.renderer.autoClear = false;
      this.show(1, new THREE.Matrix3().set(...anaglyphRight), 0.25, true);
    }
    this.renderer.autoClear = true;
  }

  /** Takes a picture of the scale as for one eye and shows nothing; what is shown and picked stays. */
  rehearse(scene: THREE.Scene, camera: THREE.PerspectiveCamera, focus: number, scale: number): void {
    this.take(1, scene, camera, focus, scale);
  }

  /** Scene point under a pixel, read back from the last picture's depth; null where nothing was drawn. */
  async pick(x: number, y: number, wide: number, high: number): Promise<THREE.Vector3 | null> {
    // Side by side, each half is a whole picture.
    const across = this.mode === 'sbs' ? ((x / wide) * 2) % 1 : x / wide;
    const depth = this.eyes[this.mode === 'sbs' || this.mode === 'anaglyph' ? 1 : 0]!.depth;
    if (!depth || !this.seenBy) return null;
    return this.probe.read(depth, this.seenBy, new THREE.Vector2(across, 1 - y / high));
  }

  private take(eye: number, scene: THREE.Scene, camera: THREE.PerspectiveCamera, focus: number, scale: number): void {
    const size = this.renderer.getDrawingBufferSize(new THREE.Vector2()).multiplyScalar(scale).ceil();
    this.eyes[eye]!.take(this.renderer, scene, camera, focus, size, this.settings.samples);
    this.triangles = this.renderer.info.render.triangles;
    this.calls = this.renderer.info.render.calls;
  }

  private show(eye: number, colours: THREE.Matrix3, greyShare: number, add = false): void {
    const material = this.eyes[eye]!.material;
    (material.uniforms.eye_colours!.value as THREE.Matrix3).copy(colours);
    material.uniforms.grey_share!.value = greyShare;
    material.blending = add ? THREE.CustomBlending : THREE.NoBlending;
    material.blendSrc = material.blendDst = THREE.OneFactor;
    this.quad.material = material;
    this.renderer.setRenderTarget(null);
    this.renderer.render(this.scene, this.flat);
  }
}

/** Renders both eyes; shadows, which both share, once. */
export function takeBoth(
  renderer: THREE.WebGLRenderer,
  scene: THREE.Scene,
  middle: THREE.PerspectiveCamera,
  focus: number,
  angleRad: number,
  size: THREE.Vector2,
  samples: number,
  eyes: readonly Eyepiece[],
): void {
  eyes.forEach((eye, k) => {
    placeEye(middle, k === 0 ? -1 : 1, focus, angleRad, size.x / size.y, eye.camera);
    renderer.shadowMap.autoUpdate = k === 0;
    eye.take(renderer, scene, eye.camera, focus, size, samples);
  });
  renderer.shadowMap.autoUpdate = true;
}
