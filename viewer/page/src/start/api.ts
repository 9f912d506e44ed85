// SPDX-License-Identifier: GPL-3.0-or-later
// What the start page asks the gateway for, and checks before use.
import { said } from '../languages/said';
import { text as message } from '../languages/text';

export interface Exercise {
  scene: string;
  group: string;
  /** The same for all exercises of one case; '': it stands alone. */
  ofCase: string;
  /** Of the exercise alone, without its scene: "Rupture". */
  name: string;
  title: string;
  text: string;
  /** Of the aneurysm; '': not said. */
  site: string;
  /** 1 to 5; 0: not said. */
  difficulty: number;
  picture: boolean;
}

export interface Person {
  pseudonym: string;
  role: string;
  handedness: string;
  year: number;
}

export interface Run {
  uuid: string;
  scene: string;
  title: string;
  mode: string;
  beganMs: number;
  durationS: number;
  /** 'done', 'failed' or 'running': left before its end. */
  state: string;
  goals: number;
  goalsDone: number;
  faults: number;
  /** Name of the recording; empty: there is none. */
  recording: string;
}

export interface History {
  scene: string;
  title: string;
  runs: number;
  last: Run | null;
  best: Run | null;
}

export interface Curve {
  metric: string;
  hand: string;
  text: string;
  unit: string;
  better: string;
  digits: number;
  points: { uuid: string; beganMs: number; mode: string; done: boolean; value: number }[];
  /** null: no level is known. */
  learning: Learning | null;
}

/** A curve against the level that counts as learnt (viewer/gateway/learning_json.h). */
export interface Learning {
  atLeast: number | null;
  atMost: number | null;
  inARow: number;
  /** 'curriculum' or 'specialists'. */
  source: string;
  attemptsToLevel: number | null;
  /** accepted, alarmed: index of the attempt that crossed a line first. */
  cusum: { sum: number[]; h0: number; h1: number; accepted: number | null; alarmed: number | null };
}

export interface Running {
  scene: string;
  person: string;
  /** 'running', 'loading', 'refused', or '' if nothing is known. */
  state: string;
  text: string;
  /** Name of the request that it answers; '': of none. */
  request: string;
}

/** What is to be begun. */
export interface Choice {
  scene: string;
  person: string;
  /** Name by which the answer is known. */
  request: string;
  /** How it counts for a curriculum; without them, the mode is chosen in the exercise. */
  mode?: string;
  seed?: number;
}

type Json = Record<string, unknown>;

export const object = (value: unknown): Json => (typeof value === 'object' && value !== null ? (value as Json) : {});
export const list = (value: unknown): Json[] => (Array.isArray(value) ? value.map(object) : []);
export const text = (value: unknown): string => (typeof value === 'string' ? value : '');
export const number = (value: unknown): number => (typeof value === 'number' && Number.isFinite(value) ? value : 0);

export const numberOrNull = (value: unknown): number | null =>
  typeof value === 'number' && Number.isFinite(value) ? value : null;

function learningOf(curve: Json): Learning | null {
  const [level, sums] = [object(curve.level), object(curve.cusum)];
  const [atLeast, atMost] = [numberOrNull(level.at_least), numberOrNull(level.at_most)];
  if (atLeast === null && atMost === null) return null;
  return {
    atLeast,
    atMost,
    inARow: Math.max(1, number(level.in_a_row)),
    source: text(level.source),
    attemptsToLevel: numberOrNull(curve.attempts_to_level),
    cusum: {
      sum: Array.isArray(sums.sum) ? sums.sum.map(number) : [],
      h0: number(sums.h0),
      h1: number(sums.h1),
      accepted: numberOrNull(sums.accepted),
      alarmed: numberOrNull(sums.alarmed),
    },
  };
}

export function exercisesOf(json: unknown): Exercise[] {
  return list(json)
    .map((e) => ({
      scene: text(e.scene),
      group: text(e.group),
      ofCase: text(e.case),
      name: said(text(e.name)),
      title: said(text(e.title)),
      text: said(text(e.text)),
      site: text(e.site),
      difficulty: Math.min(5, Math.max(0, Math.round(number(e.difficulty)))),
      picture: e.picture === true,
    }))
    .filter((e) => e.scene !== '');
}

export function peopleOf(json: unknown): Person[] {
  return list(json)
    .map((p) => ({
      pseudonym: text(p.pseudonym),
      role: text(p.role),
      handedness: text(p.handedness),
      year: number(p.year),
    }))
    .filter((p) => p.pseudonym !== '');
}

export function runOf(json: unknown): Run | null {
  const r = object(json);
  if (text(r.uuid) === '') return null;
  return {
    uuid: text(r.uuid),
    scene: text(r.scene),
    title: text(r.title),
    mode: text(r.mode),
    beganMs: number(r.began_ms),
    durationS: number(r.duration_s),
    state: text(r.state),
    goals: number(r.goals),
    goalsDone: number(r.goals_done),
    faults: number(r.faults),
    recording: text(r.recording),
  };
}

export function historyOf(json: unknown): Map<string, History> {
  const out = new Map<string, History>();
  for (const h of list(json)) {
    const scene = text(h.scene);
    if (scene !== '')
      out.set(scene, { scene, title: text(h.title), runs: number(h.runs), last: runOf(h.last), best: runOf(h.best) });
  }
  return out;
}

export function curvesOf(json: unknown): Curve[] {
  return list(json).map((c) => ({
    metric: text(c.metric),
    hand: text(c.hand),
    text: said(text(c.text)),
    unit: text(c.unit),
    better: text(c.better),
    digits: Math.min(6, Math.max(0, number(c.digits))),
    points: list(c.points).map((p) => ({
      uuid: text(p.uuid),
      beganMs: number(p.began_ms),
      mode: text(p.mode),
      done: p.done === true,
      value: number(p.value),
    })),
    learning: learningOf(c),
  }));
}

export function runningOf(json: unknown): Running {
  const s = object(json);
  return {
    scene: text(s.scene),
    person: text(s.person),
    state: text(s.state),
    text: text(s.text),
    request: text(s.request),
  };
}

/** What the gateway did not do, in its words. status: of HTTP. */
export class Refusal extends Error {
  constructor(
    words: string,
    readonly status: number,
  ) {
    super(words);
  }
}

export const isRefusal = (e: unknown, status: number): boolean => e instanceof Refusal && e.status === status;
/** What is named is not there. */
export const notFound = 404;
/** What a change was meant for has been changed by another page since. */
export const preconditionFailed = 412;

/** What an answer of the gateway holds. Throws a Refusal. */
export async function contentOf(answer: Response): Promise<unknown> {
  const json: unknown = await answer.json().catch(() => ({}));
  if (answer.ok) return json;
  const { status } = answer;
  throw new Refusal(text(object(json).error) || message('the gateway answered {status}', { status }), status);
}

/** The gateway's answers. What it refuses is thrown as a Refusal. */
export class Api {
  constructor(private readonly base: URL) {}

  /** For those who ask for more than this class does. */
  async ask(path: string, query: Record<string, string> = {}, body?: object): Promise<unknown> {
    const url = new URL(`api/${path}`, this.base);
    for (const [name, value] of Object.entries(query)) url.searchParams.set(name, value);
    const address = url.href.replaceAll('+', '%20');
    const answer = await fetch(
      address,
      body ? { method: 'POST', headers: { 'Content-Type': 'application/json' }, body: JSON.stringify(body) } : {},
    );
    return contentOf(answer);
  }

  exercises = async (): Promise<Exercise[]> => exercisesOf(await this.ask('exercises'));
  people = async (): Promise<Person[]> => peopleOf(await this.ask('people'));
  history = async (person: string): Promise<Map<string, History>> => historyOf(await this.ask('history', { person }));
  curves = async (person: string, scene: string): Promise<Curve[]> =>
    curvesOf(await this.ask('curves', { person, scene }));
  running = async (): Promise<Running> => runningOf(await this.ask('state'));
  addPerson = async (person: Person): Promise<void> => void (await this.ask('people', {}, person));
  choose = async (choice: Choice): Promise<void> => void (await this.ask('choose', {}, choice));
  picture = (scene: string): string => new URL(`api/picture?scene=${encodeURIComponent(scene)}`, this.base).href;
}
