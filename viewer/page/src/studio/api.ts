// SPDX-License-Identifier: GPL-3.0-or-later
// What the page of the case builder asks the gateway for, and checks before use (viewer/gateway/studio.h).
import { text as message } from '../languages/text';
import { Api, contentOf, list, number, numberOrNull, object, text } from '../start/api';
import { sent } from './folder/send';
import { type LibraryClip, libraryOf, type Trial, trialOf } from './clip/trial';
import { type ExerciseRules, exerciseRulesOf } from './goals/rules';
import { type Choices, choicesOf, point } from './choices';
import { type PoseState, poseStateOf, type Question } from './pose/pose';
import { type ScanFacts, scanFactsOf } from './scan/block';

export type Point = [number, number, number];

export interface Proposal {
  method: string;
  diameterMm: number;
  /** Of its dome with that of the first proposal, 0 to 1. */
  agreement: number;
  planar: boolean;
  centre: Point;
  normal: Point;
}

export interface Opening {
  centre: Point;
  normal: Point;
  calibreMm: number;
}

/** kind: 'fact', 'repair' or 'problem'. */
export interface Note {
  kind: string;
  text: string;
  advice: string;
}

/** What the case builder found in the file. */
export interface Facts {
  triangles: number;
  sizeMm: Point;
  openings: Opening[];
  confidence: number;
  proposals: Proposal[];
  /** Why no neck was found; '': one was. */
  problem: string;
  notes: Note[];
}

export type { Choices, Neck, Stroke } from './choices';

/** As proposed. */
export interface RegionWall {
  regions: string;
  thicknessMm: number;
  youngMpa: number;
}

/** state: '', 'running', 'done', 'failed', 'cancelled' or 'interrupted'. */
export interface Work {
  state: string;
  error: string;
  stage: string;
  percent: number;
  seconds: number;
  /** Counts the times that the file was read. */
  number: number;
}

export interface Built {
  /** Its choices are the present ones. */
  current: boolean;
  number: string;
  neckMm: number;
  confidence: number | null;
  overlapMm: { what: string; mm: number }[];
  stepMs: number;
  budgetMs: number;
  clip: string;
  clipping: { grade: number; remnantPct: number } | null;
  problems: { id: string; text: string; whatToDo: string }[];
  exercises: string[];
  rules: ExerciseRules[];
  walls: RegionWall[];
  clips: LibraryClip[];
}

export interface Project {
  name: string;
  file: string;
  choices: Choices;
  /** Of the choices: another one after each change. */
  revision: number;
  undo: boolean;
  redo: boolean;
  command: string;
  /** null: the file is a surface. */
  scan: { work: Work; facts: ScanFacts | null } | null;
  inspect: Work;
  facts: Facts | null;
  build: Work;
  built: Built | null;
  trial: Trial;
  play: { state: string; url: string; error: string };
}

export interface Listed {
  name: string;
  file: string;
  built: boolean;
}

function workOf(value: unknown): Work {
  const w = object(value);
  return {
    state: text(w.state),
    error: text(w.error),
    stage: text(w.stage),
    percent: number(w.percent),
    seconds: number(w.seconds),
    number: number(w.number),
  };
}

export function factsOf(value: unknown): Facts | null {
  const f = object(value);
  if (!Array.isArray(f.openings)) return null;
  const neck = object(f.neck);
  return {
    triangles: number(f.triangles_given),
    sizeMm: point(f.size_mm),
    openings: list(f.openings).map((o) => ({
      centre: point(o.centre),
      normal: point(o.normal),
      calibreMm: number(o.calibre_mm),
    })),
    confidence: number(neck.confidence),
    proposals: list(neck.proposals).map((p) => ({
      method: text(p.method),
      diameterMm: number(p.diameter_mm),
      agreement: number(p.agreement),
      planar: p.planar === true,
      centre: point(p.centre),
      normal: point(p.normal),
    })),
    problem: text(f.problem),
    notes: list(f.notes).map((n) => ({ kind: text(n.kind), text: text(n.text), advice: text(n.advice) })),
  };
}

function builtOf(value: unknown): Built | null {
  const b = object(value);
  if (!Array.isArray(b.exercises)) return null;
  const [report, clip] = [object(b.report), object(b.clip)];
  const [neck, step, clipping] = [object(report.neck), object(report.step_ms), object(report.clipping)];
  const grade = numberOrNull(clipping.grade);
  return {
    current: b.current === true,
    number: text(b.number),
    neckMm: number(neck.diameter_mm),
    confidence: list(neck.proposals).length > 0 ? number(neck.confidence) : null,
    overlapMm: Object.entries(object(report.overlap_mm)).map(([what, mm]) => ({ what, mm: number(mm) })),
    stepMs: number(step.p50),
    budgetMs: number(step.budget),
    clip: text(clip.name),
    clipping: grade === null ? null : { grade, remnantPct: number(clipping.remnant_pct) },
    problems: list(report.problems).map((p) => ({
      id: text(p.id),
      text: text(p.text),
      whatToDo: text(p.what_to_do),
    })),
    exercises: b.exercises.map(text),
    rules: exerciseRulesOf(b.rules),
    walls: list(b.walls).map((w) => ({
      regions: text(w.regions),
      thicknessMm: number(w.thickness_mm),
      youngMpa: number(w.young_MPa),
    })),
    clips: libraryOf(b.clips),
  };
}

export function projectOf(json: unknown): Project {
  const p = object(json);
  const [inspect, play] = [object(p.inspect), object(p.play)];
  return {
    name: text(p.name),
    file: text(p.file),
    choices: choicesOf(p.choices),
    revision: number(p.revision),
    undo: p.undo === true,
    redo: p.redo === true,
    command: text(p.command),
    scan: p.scan ? { work: workOf(p.scan), facts: scanFactsOf(object(p.scan).facts) } : null,
    inspect: workOf(inspect),
    facts: factsOf(inspect.facts),
    build: workOf(p.build),
    built: builtOf(p.built),
    trial: trialOf(workOf(p.trial), object(p.trial)),
    play: { state: text(play.state), url: text(play.url), error: text(play.error) },
  };
}

/** An act that changes a project. */
export type Act = 'choose' | 'undo' | 'redo' | 'build' | 'try' | 'cancel' | 'play' | 'again';

export class StudioApi {
  private readonly api: Api;

  constructor(private readonly base: URL) {
    this.api = new Api(base);
  }

  async projects(): Promise<{ projects: Listed[]; mostBytes: number }> {
    const json = object(await this.api.ask('studio/projects'));
    const projects = list(json.projects).map((p) => ({
      name: text(p.name),
      file: text(p.file),
      built: p.built === true,
    }));
    return { projects, mostBytes: number(json.most_bytes) };
  }

  project = async (name: string): Promise<Project> => projectOf(await this.api.ask('studio/project', { name }));
  act = async (name: string, act: Act, more: object = {}): Promise<Project> =>
    projectOf(await this.api.ask(`studio/${act}`, {}, { name, ...more }));
  remove = async (name: string): Promise<void> => void (await this.api.ask('studio/remove', {}, { name }));

  /** kind: 'surface', 'scan', 'side', 'front', 'fissure' or 'report'. version: another one is another file. */
  file(name: string, kind: string, version: string | number): string {
    const url = new URL(`api/studio/${kind}`, this.base);
    url.search = new URLSearchParams({ name, version: String(version) }).toString();
    return url.href;
  }

  /** Of the built case; a question is answered later. */
  pose = async (name: string, question: Question | null): Promise<PoseState> => {
    const asked: Record<string, string> = question
      ? { pose: question.pose.join(), parted: question.parted ? '1' : '0' }
      : {};
    return poseStateOf(await this.api.ask('studio/pose', { name, ...asked }));
  };
  poseSurface = (name: string, part: string, version: string): string =>
    `${this.file(name, 'pose_surface', version)}&part=${part}`;

  /** A new project. share: gets how much of the file has gone, 0 to 1. Cancelled, it leaves no project. */
  async upload(file: File, signal: AbortSignal, share: (done: number) => void): Promise<Project> {
    const upload = [...crypto.getRandomValues(new Uint32Array(4))].map((n) => n.toString(36)).join('');
    const url = new URL('api/studio/upload', this.base);
    url.search = new URLSearchParams({ file: file.name, upload }).toString().replaceAll('+', '%20');
    const lost = () => new Error(message('The connection was lost: send the file again.'));
    try {
      const project = projectOf(await contentOf(await sent(url, file, signal, share, lost)));
      signal.throwIfAborted();
      return project;
    } catch (e) {
      // All of it may have arrived before.
      if (signal.aborted) void this.api.ask('studio/discard', {}, { upload }).catch(() => undefined);
      throw e;
    }
  }
}
