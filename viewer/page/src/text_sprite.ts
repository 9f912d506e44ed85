// SPDX-License-Identifier: GPL-3.0-or-later
// A line of text that hangs in the scene and faces the viewer.
import * as THREE from 'three';

export class TextSprite {
  readonly sprite: THREE.Sprite;
  private readonly paper = document.createElement('canvas');
  private readonly writing = new THREE.CanvasTexture(this.paper);
  private readonly material = new THREE.SpriteMaterial({ map: this.writing, depthTest: false, toneMapped: false });
  private written: string | null = null;
  /** Of a line, m. */
  private heightM: number;

  /** `heightM`: of a line, m; `rgb`: of the letters, 0..1. */
  constructor(
    heightM: number,
    private readonly rgb: readonly number[],
  ) {
    this.heightM = heightM;
    this.sprite = new THREE.Sprite(this.material);
    this.sprite.renderOrder = 900;
    this.sprite.center.set(0.5, -0.2);
  }

  /** The same text again costs nothing. */
  write(text: string): void {
    if (text === this.written) return;
    this.written = text;
    const c = this.paper.getContext('2d')!;
    const font = '44px sans-serif';
    c.font = font;
    this.paper.width = Math.ceil(c.measureText(text).width) + 32;
    this.paper.height = 64;
    c.font = font;
    c.fillStyle = 'rgba(12, 15, 18, 0.7)';
    c.fillRect(0, 0, this.paper.width, this.paper.height);
    const [r, g, b] = this.rgb.map((x) => Math.round(255 * x));
    c.fillStyle = `rgb(${r} ${g} ${b})`;
    c.fillText(text, 16, 47);
    this.setHeight(this.heightM);
    this.writing.dispose();
    this.writing.needsUpdate = true;
  }

  /** Height of a line, m. */
  setHeight(heightM: number): void {
    this.heightM = heightM;
    this.sprite.scale.set((heightM * this.paper.width) / this.paper.height, heightM, 1);
  }

  dispose(): void {
    this.sprite.removeFromParent();
    this.writing.dispose();
    this.material.dispose();
  }
}
