// SPDX-License-Identifier: GPL-3.0-or-later
// The page of the case builder: the list of projects, or one of them (#NAME).
import './studio.css';
import '../screens.css';
import { el } from '../hud/dom';
import { languageSelect } from '../languages/language_select';
import { text } from '../languages/text';
import { StudioApi } from './api';
import { Editor } from './editor';
import { ProjectList } from './project_list';

document.title = text('Insula studio');
const api = new StudioApi(new URL('./', window.location.href));
const place = el('main', {});
const home = el('a', { href: '#' }, text('All projects'));
document
  .getElementById('studio')!
  .append(
    el(
      'header',
      { class: 'top' },
      el('h1', {}, text('Insula studio')),
      el('p', {}, text('Cases from vessels’ surfaces. For training only, never for the care of patients.')),
      home,
      languageSelect(),
    ),
    place,
  );

let editor: Editor | null = null;

function show(): void {
  const name = decodeURIComponent(window.location.hash.slice(1));
  editor?.end();
  editor = name === '' ? null : new Editor(api, name);
  home.hidden = name === '';
  place.replaceChildren(editor ? editor.root : new ProjectList(api).root);
}

window.addEventListener('hashchange', show);
show();
