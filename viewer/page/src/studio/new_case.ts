// SPDX-License-Identifier: GPL-3.0-or-later
// The place to drop a surface, a scan or a folder of a scan, and what becomes of it until it is a project.
import { el, setText } from '../hud/dom';
import { text } from '../languages/text';
import type { StudioApi } from './api';
import type { Series } from './folder/dicom_series';
import { chosenFolder, droppedFiles, type Given } from './folder/dropped_files';
import { reason } from './wording';

const megabyte = 1e6;
/** As the case builder unpacks them (tools/case_builder/series_archive.cpp). */
const mostImages = 5000;

export class NewCase {
  readonly root = el('section', { class: 'drop' });
  mostBytes = Infinity;
  private readonly say = el('p', { class: 'say', role: 'alert' });
  private readonly file = el('input', {
    type: 'file',
    accept: '.stl,.obj,.ply,.off,.gltf,.glb,.vtp,.vtu,.h5,.hdf5,.nii,.gz,.mha,.nrrd,.dcm,.zip',
    'aria-label': text('Choose a file …'),
  });
  private readonly folder = el('input', { type: 'file', webkitdirectory: '', 'aria-label': text('Choose a folder …') });
  private readonly choice = el('div', { class: 'series' });
  private readonly bar = el('progress', { max: '1', 'aria-label': text('How much of it has been sent') });
  private readonly cancel = el('button', { type: 'button' }, text('Cancel'));
  private readonly buttons: HTMLButtonElement[];
  private work: AbortController | null = null;

  constructor(private readonly api: StudioApi) {
    const pick = (input: HTMLInputElement, words: string, style: string) => {
      const button = el('button', { type: 'button', class: style }, words);
      input.hidden = true;
      button.onclick = () => input.click();
      return button;
    };
    this.buttons = [pick(this.file, text('Choose a file …'), 'main'), pick(this.folder, text('Choose a folder …'), '')];
    this.file.onchange = () => this.given(() => Promise.resolve({ folder: '', files: [...(this.file.files ?? [])] }));
    this.folder.onchange = () => this.given(() => Promise.resolve(chosenFolder(this.folder.files!)));
    this.cancel.onclick = () => this.work?.abort();
    this.bar.hidden = this.cancel.hidden = true;
    const surfaces = text(
      'Drop the surface of a vessel with an aneurysm here: STL, OBJ, PLY, OFF, glTF, VTP, VTU, HDF5.',
    );
    this.root.append(
      el('h2', {}, text('A new case')),
      el('p', {}, surfaces),
      el('p', {}, text('Or drop a scan: NIfTI, MetaImage, NRRD, or the folder or zip file of a DICOM series.')),
      el('div', { class: 'buttons' }, ...this.buttons, this.cancel),
      this.file,
      this.folder,
      this.say,
      this.bar,
      this.choice,
    );
    this.takeDrops();
  }

  private takeDrops(): void {
    const mark = (on: boolean) => this.root.classList.toggle('over', on);
    this.root.addEventListener('dragover', (e) => {
      e.preventDefault();
      mark(true);
    });
    this.root.addEventListener('dragleave', () => mark(false));
    this.root.addEventListener('drop', (e) => {
      e.preventDefault();
      mark(false);
      this.given((signal) => droppedFiles(e.dataTransfer!, signal));
    });
  }

  /** One piece of work at a time; a new one ends the one before. */
  private given(read: (signal: AbortSignal) => Promise<Given>): void {
    void this.at(async (signal) => {
      const { folder, files } = await read(signal);
      if (folder !== '' || files.length > 1) return this.takeFolder(folder || text('scan'), files, signal);
      if (files[0]) await this.take(files[0], signal);
    });
  }

  private async at(run: (signal: AbortSignal) => Promise<void>): Promise<void> {
    this.work?.abort();
    const work = new AbortController();
    this.work = work;
    this.choice.replaceChildren();
    setText(this.say, '');
    this.busy(true);
    try {
      await run(work.signal);
    } catch (e) {
      if (this.work === work) setText(this.say, work.signal.aborted ? text('Cancelled.') : reason(e));
    }
    if (this.work === work) this.busy(false);
    this.file.value = this.folder.value = '';
  }

  private busy(on: boolean): void {
    this.bar.hidden = this.cancel.hidden = !on;
    this.bar.removeAttribute('value');
    for (const button of this.buttons) button.disabled = on;
  }

  private share(done: number): void {
    this.bar.value = done;
  }

  private async takeFolder(name: string, files: File[], signal: AbortSignal): Promise<void> {
    setText(this.say, text('Looking for DICOM images in {name} …', { name }));
    const { dicomSeries } = await import('./folder/dicom_series');
    const all = await dicomSeries(files, signal, (done) => this.share(done));
    if (all.length === 0) throw new Error(text('{name} holds no DICOM images.', { name }));
    if (all.length === 1) return this.takeSeries(name, all[0]!, signal);
    setText(this.say, text('{name} holds several series. Take the angiogram with thin slices.', { name }));
    this.choice.replaceChildren(...all.map((series) => this.offer(name, series)));
  }

  private offer(name: string, series: Series): HTMLElement {
    const words = [series.number, series.modality, series.description].filter((word) => word !== '').join(' · ');
    const images = text('{count, plural, one {# image} other {# images}}', { count: series.files.length });
    const button = el('button', { type: 'button' }, words === '' ? images : `${words} · ${images}`);
    button.onclick = () => void this.at((signal) => this.takeSeries(name, series, signal));
    return button;
  }

  private async takeSeries(name: string, series: Series, signal: AbortSignal): Promise<void> {
    this.refuseLarge(name, series.bytes);
    if (series.files.length > mostImages)
      throw new Error(text('{name} holds more than {most} images.', { name, most: mostImages }));
    setText(this.say, text('Packing {name} …', { name }));
    const { zipped } = await import('./folder/series_zip');
    await this.take(await zipped(series.files, `${name}.zip`, signal, (done) => this.share(done)), signal);
  }

  private refuseLarge(name: string, bytes: number): void {
    if (bytes <= this.mostBytes) return;
    const most = Math.floor(this.mostBytes / megabyte);
    throw new Error(text('{name} is too large: {most} MB are taken.', { name, most }));
  }

  private async take(file: File, signal: AbortSignal): Promise<void> {
    const { name } = file;
    this.refuseLarge(name, file.size);
    setText(this.say, text('Sending {name} …', { name }));
    window.location.hash = (await this.api.upload(file, signal, (done) => this.share(done))).name;
  }
}
