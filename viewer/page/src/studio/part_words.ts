// SPDX-License-Identifier: GPL-3.0-or-later
import { text } from '../languages/text';

/** What a part of the field is called. */
export function partText(name: string): string {
  switch (name) {
    case 'frontal':
      return text('Frontal lobe');
    case 'temporal':
      return text('Temporal lobe');
    case 'right_frontal':
      return text('Right frontal lobe');
    case 'left_frontal':
      return text('Left frontal lobe');
    case 'insula':
      return text('Insula');
    case 'brainstem':
      return text('Brainstem');
    case 'callosum':
      return text('Corpus callosum');
    case 'diencephalon':
      return text('Diencephalon');
    case 'retractors':
      return text('Retractors');
    case 'vessel':
      return text('The vessel itself');
    case 'window':
      return text('Bone');
    default:
      return name;
  }
}
