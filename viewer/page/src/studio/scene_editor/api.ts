// SPDX-License-Identifier: GPL-3.0-or-later
// What the scene editor asks the gateway for, and checks before use (viewer/gateway/studio_scenes.h).
import { text as message } from '../../languages/text';
import { Api, list, number, object, text } from '../../start/api';
import { type Declarations, declarationsOf } from './declarations';

export interface SceneCopy {
  name: string;
  /** 'copying', 'ready' or 'failed'. */
  state: string;
  error: string;
  /** Paths in the copy: what can be looked at, and all XML files. */
  scenes: string[];
  files: string[];
  /** All others, such as meshes. */
  meshes: string[];
  /** The running picture; state: '', 'starting', 'running' or 'ended'. */
  look: { state: string; url: string; error: string };
}

export interface Source {
  scene: string;
  group: string;
  title: string;
}

export interface Version {
  number: number;
  timeMs: number;
}

export interface SceneText {
  text: string;
  draft: string | null;
  versions: Version[];
  /** Another one for another text or draft. */
  revision: string;
}

export interface Problem {
  severity: string;
  file: string;
  line: number;
  column: number;
  text: string;
  /** Name that was probably meant; '': none. */
  nearest: string;
}

export interface Checked {
  ok: boolean;
  problems: Problem[];
}

const waitMs = 150;
const pause = () => new Promise((r) => setTimeout(r, waitMs));
const texts = (value: unknown): string[] => (Array.isArray(value) ? value.map(text) : []);

export function copyOf(json: unknown): SceneCopy {
  const c = object(json);
  const look = object(c.look);
  return {
    name: text(c.name),
    state: text(c.state),
    error: text(c.error),
    scenes: texts(c.scenes),
    files: texts(c.files),
    meshes: texts(c.meshes),
    look: { state: text(look.state), url: text(look.url), error: text(look.error) },
  };
}

const versionsOf = (value: unknown): Version[] =>
  list(value).map((v) => ({ number: number(v.number), timeMs: number(v.time_ms) }));

export const problemsOf = (value: unknown): Problem[] =>
  list(value).map((p) => ({
    severity: text(p.severity),
    file: text(p.file),
    line: number(p.line),
    column: number(p.column),
    text: text(p.text),
    nearest: text(p.nearest),
  }));

/** What the gateway may answer, for the catalogues. */
export const sceneRefusals = (): string[] => [
  message('there is no such scene'),
  message('there is no such file in this scene'),
  message('there is no such version'),
  message('this file was changed in another window'),
  message('this scene is too large: 200 kB are taken'),
  message('the scene cannot be written: is the disk full?'),
  message('the scene cannot be checked: is the disk full?'),
  message('the case must be built first'),
  message('this takes too long'),
];

export class ScenesApi {
  private readonly api: Api;

  constructor(base: URL) {
    this.api = new Api(base);
  }

  async scenes(): Promise<SceneCopy[]> {
    return list(object(await this.api.ask('studio/scenes')).scenes).map(copyOf);
  }

  scene = async (name: string): Promise<SceneCopy> => copyOf(await this.api.ask('studio/scene', { name }));
  open = async (source: string): Promise<SceneCopy> => copyOf(await this.api.ask('studio/scene_open', {}, { source }));
  begin = async (name: string): Promise<SceneCopy> => copyOf(await this.api.ask('studio/scene_new', {}, { name }));
  openBuilt = async (project: string): Promise<SceneCopy> =>
    copyOf(await this.api.ask('studio/edit', {}, { name: project }));
  remove = async (name: string): Promise<void> => void (await this.api.ask('studio/scene_remove', {}, { name }));
  look = async (name: string, scene: string): Promise<SceneCopy> =>
    copyOf(await this.api.ask('studio/scene_look', {}, { name, scene }));
  leave = async (name: string): Promise<SceneCopy> => copyOf(await this.api.ask('studio/scene_leave', {}, { name }));

  async sources(): Promise<Source[]> {
    const json = await this.answered('studio/scene_sources');
    return list(json.sources).map((s) => ({ scene: text(s.scene), group: text(s.group), title: text(s.title) }));
  }

  async declarations(): Promise<Declarations> {
    return declarationsOf((await this.answered('studio/scene_elements')).elements);
  }

  async file(name: string, file: string): Promise<SceneText> {
    const f = object(await this.api.ask('studio/scene_file', { name, file }));
    return {
      text: text(f.text),
      draft: typeof f.draft === 'string' ? f.draft : null,
      versions: versionsOf(f.versions),
      revision: text(f.revision),
    };
  }

  async version(name: string, file: string, version: number): Promise<string> {
    return text(object(await this.api.ask('studio/scene_version', { name, file, number: String(version) })).text);
  }

  async write(
    name: string,
    file: string,
    content: string,
    revision: string,
  ): Promise<{ versions: Version[]; revision: string }> {
    const answer = object(await this.api.ask('studio/scene_write', {}, { name, file, text: content, revision }));
    return { versions: versionsOf(answer.versions), revision: text(answer.revision) };
  }

  async beginCheck(
    name: string,
    scene: string,
    file: string,
    content: string,
    revision: string,
  ): Promise<{ number: number; revision: string }> {
    const asked = { name, scene, file, text: content, revision };
    const answer = object(await this.api.ask('studio/scene_check', {}, asked));
    return { number: number(answer.number), revision: text(answer.revision) };
  }

  /** Of the check of this number. Null: a newer one of the file was begun meanwhile. */
  async checked(name: string, file: string, wanted: number): Promise<Checked | null> {
    for (;;) {
      const c = object(await this.api.ask('studio/scene_checked', { name, file }));
      if (number(c.number) !== wanted) return null;
      if (text(c.state) === 'failed') throw new Error(text(c.error));
      if (text(c.state) === 'done') return { ok: c.ok === true, problems: problemsOf(c.problems) };
      await pause();
    }
  }

  /** Asks until the gateway has the answer of a program. */
  private async answered(path: string): Promise<Record<string, unknown>> {
    for (;;) {
      const json = object(await this.api.ask(path));
      if (text(json.state) === 'failed') throw new Error(text(json.error));
      if (text(json.state) === 'done') return json;
      await pause();
    }
  }
}
