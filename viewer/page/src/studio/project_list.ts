// SPDX-License-Identifier: GPL-3.0-or-later
// The list of projects, and the place to drop a surface.
import { el } from '../hud/dom';
import { text } from '../languages/text';
import type { Listed, StudioApi } from './api';
import { reason } from './wording';

const megabyte = 1e6;

export class ProjectList {
  readonly root = el('div', { class: 'projects' });
  private readonly say = el('p', { class: 'say', role: 'alert' });
  private readonly file = el('input', {
    type: 'file',
    accept: '.stl,.obj,.ply,.off,.gltf,.glb,.vtp,.nii,.gz,.mha,.nrrd,.dcm,.zip',
  });
  private readonly rows = el('ul', {});
  private readonly none = el('p', { class: 'hint' }, text('There are no projects yet.'));
  private readonly drop = el('section', { class: 'drop' });
  private mostBytes = Infinity;

  constructor(private readonly api: StudioApi) {
    const pick = el('button', { type: 'button', class: 'main' }, text('Choose a file …'));
    pick.onclick = () => this.file.click();
    this.file.hidden = true;
    this.file.setAttribute('aria-label', text('Choose a file …'));
    this.file.onchange = () => void this.take(this.file.files?.[0]);
    this.drop.append(
      el('h2', {}, text('A new case')),
      el('p', {}, text('Drop the surface of a vessel with an aneurysm here: STL, OBJ, PLY, OFF, glTF or VTP.')),
      el('p', {}, text('Or drop a scan: NIfTI, MetaImage, NRRD, or a DICOM series as one zip file.')),
      pick,
      this.file,
      this.say,
    );
    this.takeDrops();
    this.root.append(this.drop, el('section', {}, el('h2', {}, text('Projects')), this.none, this.rows));
    void this.load();
  }

  private takeDrops(): void {
    const mark = (on: boolean) => this.drop.classList.toggle('over', on);
    this.drop.addEventListener('dragover', (e) => {
      e.preventDefault();
      mark(true);
    });
    this.drop.addEventListener('dragleave', () => mark(false));
    this.drop.addEventListener('drop', (e) => {
      e.preventDefault();
      mark(false);
      void this.take(e.dataTransfer?.files[0]);
    });
  }

  private async load(): Promise<void> {
    try {
      const { projects, mostBytes } = await this.api.projects();
      this.mostBytes = mostBytes;
      this.none.hidden = projects.length > 0;
      this.rows.replaceChildren(...projects.map((p) => this.row(p)));
    } catch (e) {
      this.say.textContent = reason(e);
    }
  }

  private row(p: Listed): HTMLElement {
    const remove = el(
      'button',
      { type: 'button', 'aria-label': text('Remove {name}', { name: p.name }) },
      text('Remove'),
    );
    remove.onclick = () => void this.remove(p.name);
    return el(
      'li',
      {},
      el('a', { href: `#${p.name}` }, p.name),
      el('span', { class: 'hint' }, p.file),
      el('span', { class: 'hint' }, p.built ? text('built') : text('not built yet')),
      remove,
    );
  }

  private async remove(name: string): Promise<void> {
    if (!window.confirm(text('Remove the project {name} with its file?', { name }))) return;
    try {
      await this.api.remove(name);
      this.say.textContent = '';
    } catch (e) {
      this.say.textContent = reason(e);
    }
    await this.load();
  }

  private async take(file: File | undefined): Promise<void> {
    if (!file) return;
    if (file.size > this.mostBytes) {
      this.say.textContent = text('{name} is too large: {most} MB are taken.', {
        name: file.name,
        most: Math.floor(this.mostBytes / megabyte),
      });
      return;
    }
    this.say.textContent = text('Sending {name} …', { name: file.name });
    try {
      window.location.hash = (await this.api.upload(file)).name;
    } catch (e) {
      this.say.textContent = reason(e);
    }
    this.file.value = '';
  }
}
