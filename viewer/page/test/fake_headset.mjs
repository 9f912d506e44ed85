// SPDX-License-Identifier: GPL-3.0-or-later
// A made-up WebXR device for the browser test: enough of the interface for three to draw two eyes into the page's own
// canvas, a look at what came out, and controllers that a test moves. Runs in the page before anything else.

// One function, however long: the browser gets its text alone, without anything beside it.
// eslint-disable-next-line max-lines-per-function
export function fakeHeadset() {
  // controllers: {handedness, gripSpace: {x, y, z}, gamepad: {buttons: [{pressed}]}}.
  const told = { pictures: 0, eyes: [0, 0], controllers: [], end: () => undefined };
  window.__headset = told;
  delete window.XRWebGLBinding;
  // Without a real device the browser would never answer.
  WebGL2RenderingContext.prototype.makeXRCompatible = async () => undefined;
  const events = () => {
    const list = new Map();
    return {
      addEventListener: (name, f) => list.set(name, [...(list.get(name) ?? []), f]),
      removeEventListener: (name, f) =>
        list.set(
          name,
          (list.get(name) ?? []).filter((g) => g !== f),
        ),
      tell: (name, e) => {
        for (const f of list.get(name) ?? []) f(e);
      },
    };
  };
  const matrix = (x) => Float32Array.from([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, 0, 0, 1]);
  const pose = (x) => ({
    matrix: matrix(x),
    position: { x, y: 0, z: 0 },
    orientation: { x: 0, y: 0, z: 0, w: 1 },
    inverse: { matrix: matrix(-x) },
  });
  const projection = Float32Array.from([1.2, 0, 0, 0, 0, 1.2, 0, 0, 0, 0, -1.01, -1, 0, 0, -0.1, 0]);
  const views = ['left', 'right'].map((eye, k) => ({
    eye,
    projectionMatrix: projection,
    transform: pose(k ? 0.032 : -0.032),
  }));
  window.XRWebGLLayer = class {
    constructor(_session, gl) {
      this.gl = gl;
      this.framebuffer = null;
      this.framebufferWidth = gl.drawingBufferWidth;
      this.framebufferHeight = gl.drawingBufferHeight;
      this.antialias = false;
      this.ignoreDepthValues = true;
      this.fixedFoveation = 0;
    }
    getViewport(view) {
      const w = Math.floor(this.framebufferWidth / 2);
      return { x: view.eye === 'left' ? 0 : w, y: 0, width: w, height: this.framebufferHeight };
    }
    static getNativeFramebufferScaleFactor() {
      return 1;
    }
  };
  const brightness = (gl) =>
    views.map((_, k) => {
      const w = Math.floor(gl.drawingBufferWidth / 2);
      const texel = new Uint8Array(4 * 64);
      gl.readPixels(
        Math.floor(w * (k + 0.5)) - 4,
        Math.floor(gl.drawingBufferHeight / 2) - 4,
        8,
        8,
        gl.RGBA,
        gl.UNSIGNED_BYTE,
        texel,
      );
      let sum = 0;
      for (let i = 0; i < texel.length; i += 4) sum += texel[i] + texel[i + 1] + texel[i + 2];
      return sum / 3 / 64;
    });
  const start = async () => {
    const e = events();
    let running = true;
    const session = {
      ...e,
      renderState: { baseLayer: null, layers: undefined },
      get inputSources() {
        return told.controllers;
      },
      enabledFeatures: [],
      visibilityState: 'visible',
      environmentBlendMode: 'opaque',
      updateRenderState(s) {
        Object.assign(this.renderState, s);
      },
      requestReferenceSpace: async () => ({ ...events() }),
      requestAnimationFrame: (f) =>
        window.requestAnimationFrame((t) => {
          if (!running) return;
          f(t, {
            session,
            getViewerPose: () => ({ views, transform: pose(0), emulatedPosition: false }),
            getPose: (space) => ({ transform: { position: space, orientation: { x: 0, y: 0, z: 0, w: 1 } } }),
          });
          if (session.renderState.baseLayer) {
            told.eyes = brightness(session.renderState.baseLayer.gl);
            told.pictures++;
          }
        }),
      cancelAnimationFrame: (id) => window.cancelAnimationFrame(id),
      end: async () => {
        if (running) {
          running = false;
          e.tell('end', { session });
        }
      },
    };
    told.end = session.end;
    return session;
  };
  Object.defineProperty(navigator, 'xr', {
    configurable: true,
    value: { ...events(), isSessionSupported: async () => true, requestSession: start },
  });
}
