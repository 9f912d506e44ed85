// SPDX-License-Identifier: GPL-3.0-or-later
// How the machine does, in the line at the bottom: time of a step, rows, pictures a second.
import { fixed } from '../languages/numbers';
import { text } from '../languages/text';
import type { RenderFrame } from '../lcm';

export function machineText(f: RenderFrame | null, fps: number, quality: string): string {
  const pictures = text('{rate} fps {quality}', { rate: fixed(fps, 0), quality });
  if (!f) return pictures;
  const step = text('step {time} / {period} ms', { time: fixed(f.step_ms, 1), period: fixed(f.step_period_ms, 1) });
  return [step, text('{count} rows', { count: f.rows }), pictures].join('   ');
}
