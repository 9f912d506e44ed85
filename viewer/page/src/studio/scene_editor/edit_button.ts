// SPDX-License-Identifier: GPL-3.0-or-later
// Opens a copy of a built case's scenes in the scene editor.
import { el } from '../../hud/dom';
import { text } from '../../languages/text';
import { reason } from '../wording';
import { ScenesApi } from './api';
import { copied, sceneAddress } from './scene_copy';

/** project: its name. say: shows how far it is. */
export function editButton(project: () => string, say: (words: string) => void): HTMLButtonElement {
  const button = el('button', { type: 'button', class: 'edit' }, text('Edit a copy of the scenes'));
  const api = new ScenesApi(new URL('./', window.location.href));
  button.onclick = async () => {
    button.disabled = true;
    say(text('Copying …'));
    try {
      window.location.hash = sceneAddress((await copied(api, await api.openBuilt(project()))).name);
      say('');
    } catch (e) {
      say(reason(e));
    }
    button.disabled = false;
  };
  return button;
}
