// SPDX-License-Identifier: GPL-3.0-or-later
// One slice of a scan, as radiologists see it: right and front on the left, up and front on top.
import { el } from '../../hud/dom';
import { text } from '../../languages/text';
import type { Block } from './block';
import type { Preview } from './preview.worker';
import type { ScanState } from './scan_state';
import { slicePixels } from './slice_pixels';

/** Axes of the page's directions, and letters of its sides. */
const views = [
  { u: 1, v: 2, sides: ['A', 'P', 'S', 'I'] },
  { u: 0, v: 2, sides: ['R', 'L', 'S', 'I'] },
  { u: 0, v: 1, sides: ['R', 'L', 'A', 'P'] },
] as const;
const pageOfSlices = 10;
const perPixel = 1 / 300; // of the range of values, for a drag

const titles = () => [text('Sagittal slice'), text('Coronal slice'), text('Axial slice')];

export class SliceView {
  readonly canvas = el('canvas', { tabindex: '0', role: 'slider', 'aria-orientation': 'vertical' });
  readonly root: HTMLElement;
  private readonly image = document.createElement('canvas');
  private readonly view: (typeof views)[number];
  private readonly where = el('span', {});
  private painted = '';
  private found: Preview | null = null;

  constructor(
    /** Of the direction through the slices. */
    private readonly axis: 0 | 1 | 2,
    private readonly state: ScanState,
  ) {
    this.view = views[axis];
    const title = titles()[axis]!;
    this.canvas.setAttribute('aria-label', title);
    this.root = el('div', { class: 'slice' }, this.canvas, el('p', { 'aria-hidden': 'true' }, `${title} `, this.where));
    this.canvas.addEventListener('wheel', (e) => this.wheel(e), { passive: false });
    this.canvas.addEventListener('keydown', (e) => this.key(e));
    this.canvas.addEventListener('contextmenu', (e) => e.preventDefault());
    this.canvas.addEventListener('pointerdown', (e) => this.pressed(e));
    this.canvas.addEventListener('pointermove', (e) => this.moved(e));
    for (const end of ['pointerup', 'pointercancel'] as const)
      this.canvas.addEventListener(end, () => this.state.strokeEnds());
  }

  private wheel(e: WheelEvent): void {
    e.preventDefault();
    if (e.deltaY !== 0) this.state.move(this.axis, this.state.cross[this.axis] - Math.sign(e.deltaY));
  }

  private key(e: KeyboardEvent): void {
    if (e.key === ' ' || e.key === 'Enter') {
      e.preventDefault();
      this.state.stroke();
      return this.state.strokeEnds();
    }
    const [at, last] = [this.state.cross[this.axis], this.state.block.size[this.axis] - 1];
    const to: Record<string, number> = {
      ArrowUp: at + 1,
      ArrowRight: at + 1,
      ArrowDown: at - 1,
      ArrowLeft: at - 1,
      PageUp: at + pageOfSlices,
      PageDown: at - pageOfSlices,
      Home: 0,
      End: last,
    };
    if (e.ctrlKey || e.metaKey || !(e.key in to)) return;
    e.preventDefault();
    this.state.move(this.axis, to[e.key]!);
  }

  private pressed(e: PointerEvent): void {
    this.canvas.setPointerCapture(e.pointerId);
    if (e.button === 0 && !e.shiftKey) this.pick(e);
  }

  /** The right button, or shift, changes brightness and contrast. */
  private moved(e: PointerEvent): void {
    if (e.buttons === 0) return;
    if (e.buttons === 1 && !e.shiftKey) return this.pick(e);
    const { state } = this;
    const step = (state.block.facts.most - state.block.facts.least) * perPixel;
    const middle = (state.low + state.high) / 2 - e.movementY * step;
    const half = Math.max(step, (state.high - state.low) / 2 + e.movementX * step);
    state.window(middle - half, middle + half);
  }

  private pick(e: PointerEvent): void {
    const { state, view } = this;
    const { x, y, width, height } = this.frame();
    const box = this.canvas.getBoundingClientRect();
    const [px, py] = [(e.clientX - box.left) * this.ratio(box), (e.clientY - box.top) * this.ratio(box)];
    const [u, v] = [1 - (px - x) / width, 1 - (py - y) / height];
    state.move(view.u, u * state.block.size[view.u] - 0.5);
    state.move(view.v, v * state.block.size[view.v] - 0.5);
    state.stroke();
  }

  private readonly ratio = (box: DOMRect) => (box.width > 0 ? this.canvas.width / box.width : 1);

  /** Where the image lies on the canvas, px. */
  private frame(): { x: number; y: number; width: number; height: number } {
    const { size, spacing } = this.state.block;
    const [w, h] = [size[this.view.u] * spacing[this.view.u], size[this.view.v] * spacing[this.view.v]];
    const scale = Math.min(this.canvas.width / w, this.canvas.height / h);
    const [width, height] = [w * scale, h * scale];
    return { x: (this.canvas.width - width) / 2, y: (this.canvas.height - height) / 2, width, height };
  }

  draw(): void {
    const { state, axis, canvas } = this;
    const at = state.cross[axis];
    const n = state.block.size[axis];
    canvas.setAttribute('aria-valuemin', '1');
    canvas.setAttribute('aria-valuemax', String(n));
    canvas.setAttribute('aria-valuenow', String(at + 1));
    this.where.textContent = text('{n} of {all}', { n: at + 1, all: n });
    const ratio = Math.min(2, window.devicePixelRatio);
    const [width, height] = [Math.round(canvas.clientWidth * ratio), Math.round(canvas.clientHeight * ratio)];
    if (width === 0 || height === 0) return;
    if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
    this.paint();
    const context = canvas.getContext('2d')!;
    context.fillStyle = '#000';
    context.fillRect(0, 0, width, height);
    const f = this.frame();
    context.imageSmoothingEnabled = false;
    context.drawImage(this.image, f.x, f.y, f.width, f.height);
    this.marks(context, f, ratio);
  }

  /** The slice, unless it is painted already. */
  private paint(): void {
    const { state, axis } = this;
    const shown = JSON.stringify([state.cross[axis], state.low, state.high, state.wanted()]);
    if (shown === this.painted && state.found === this.found) return;
    [this.painted, this.found] = [shown, state.found];
    const pixels = slicePixels(state, axis, this.view);
    [this.image.width, this.image.height] = [pixels.width, pixels.height];
    this.image.getContext('2d')!.putImageData(pixels, 0, 0);
  }

  private marks(context: CanvasRenderingContext2D, f: ReturnType<SliceView['frame']>, ratio: number): void {
    const { block, cross, seed } = this.state;
    const { u, v, sides } = this.view;
    const place = (p: Readonly<Block['size']>) =>
      [
        f.x + f.width * (1 - (p[u] + 0.5) / block.size[u]),
        f.y + f.height * (1 - (p[v] + 0.5) / block.size[v]),
      ] as const;
    const [x, y] = place(cross);
    context.strokeStyle = '#ffd54a99';
    context.lineWidth = ratio;
    context.strokeRect(x, f.y, 0, f.height);
    context.strokeRect(f.x, y, f.width, 0);
    if (seed) {
      const [sx, sy] = place(block.voxel(seed));
      context.strokeStyle = '#6dff8f';
      context.lineWidth = 2 * ratio;
      context.beginPath();
      context.arc(sx, sy, 6 * ratio, 0, 2 * Math.PI);
      context.stroke();
    }
    context.fillStyle = '#fff';
    context.font = `${13 * ratio}px sans-serif`;
    context.textAlign = 'center';
    context.textBaseline = 'middle';
    const [w, h, d] = [this.canvas.width, this.canvas.height, 10 * ratio];
    [
      [d, h / 2],
      [w - d, h / 2],
      [w / 2, d],
      [w / 2, h - d],
    ].forEach(([a, b], k) => context.fillText(sides[k]!, a!, b!));
  }
}
