// SPDX-License-Identifier: GPL-3.0-or-later
// Whether the browser draws without a graphics card, and what to do about it.
import { text } from './languages/text';

const software = /swiftshader|llvmpipe|softpipe|software|basic render/i;

/** Advice for a renderer's name; '' when it is a graphics card. */
export function adviceFor(renderer: string): string {
  const name = software.exec(renderer)?.[0];
  if (!name) return '';
  return (
    text('Pictures are slow: this browser draws by software ({name}).', { name }) +
    ' ' +
    text('Turn on hardware acceleration in its settings, or keep the quality Draft and a small window.')
  );
}

export function softwareAdvice(gl: WebGLRenderingContext | WebGL2RenderingContext): string {
  const info = gl.getExtension('WEBGL_debug_renderer_info');
  const name: unknown = gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER);
  return adviceFor(typeof name === 'string' ? name : '');
}
