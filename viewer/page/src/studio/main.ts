// SPDX-License-Identifier: GPL-3.0-or-later
// The page of the case builder: the lists of projects and scenes, one project (#NAME), or one scene (#scene/NAME).
import './studio.css';
import './scene_editor/scene_editor.css';
import '../screens.css';
import { el } from '../hud/dom';
import { languageSelect } from '../languages/language_select';
import { text } from '../languages/text';
import { StudioApi } from './api';
import { Editor } from './editor';
import { ProjectList } from './project_list';
import { ScenesApi } from './scene_editor/api';
import { SceneList } from './scene_editor/scene_list';
import { reason } from './wording';

document.title = text('Insula studio');
const base = new URL('./', window.location.href);
const api = new StudioApi(base);
const scenes = new ScenesApi(base);
const sceneStart = 'scene/';
const place = el('main', {});
const home = el('a', { href: '#' }, text('All projects'));
document
  .getElementById('studio')!
  .append(
    el(
      'header',
      { class: 'top' },
      el('h1', {}, text('Insula studio')),
      el('p', {}, text('Cases from scans and vessels’ surfaces. For training only, never for the care of patients.')),
      home,
      languageSelect(),
    ),
    place,
  );

let editor: { root: HTMLElement; end(): void } | null = null;

/** The editor of scenes with its text editor is loaded when it is first wanted. */
async function showScene(name: string): Promise<void> {
  place.replaceChildren(el('p', { role: 'status' }, text('Loading …')));
  const address = window.location.hash;
  try {
    const loaded = await import('./scene_editor/scene_editor');
    const opened = await loaded.SceneEditor.open(scenes, name);
    if (address !== window.location.hash) return opened.end();
    editor = opened;
    place.replaceChildren(opened.root);
  } catch (e) {
    place.replaceChildren(el('p', { class: 'say', role: 'alert' }, reason(e)));
  }
}

function show(): void {
  const name = decodeURIComponent(window.location.hash.slice(1));
  editor?.end();
  editor = null;
  home.hidden = name === '';
  if (name.startsWith(sceneStart)) return void showScene(name.slice(sceneStart.length));
  if (name !== '') editor = new Editor(api, name, scenes);
  place.replaceChildren(...(editor ? [editor.root] : [new ProjectList(api).root, new SceneList(scenes).root]));
}

window.addEventListener('hashchange', show);
show();
