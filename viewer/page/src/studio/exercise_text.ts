// SPDX-License-Identifier: GPL-3.0-or-later
import { text } from '../languages/text';

/** What is done in an exercise of a built case. */
export function exerciseText(file: string): string {
  switch (file) {
    case '1_sylvian_fissure.xml':
      return text('Open the fissure');
    case '2_aneurysm_dissection.xml':
      return text('Free the aneurysm');
    case '3_clipping.xml':
      return text('Clip the neck');
    case '4_rupture.xml':
      return text('Stop a rupture');
    default:
      return file;
  }
}
