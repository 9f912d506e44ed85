// SPDX-License-Identifier: GPL-3.0-or-later
// The start page: who you are, what there is to do, and how you get on.
import { el } from '../hud/dom';
import { text } from '../languages/text';
import type { Api, Choice, Exercise, History, Running } from './api';
import { Cards } from './cards';
import type { Terms } from './course_api';
import { CoursePanel } from './course_panel';
import { People } from './people';
import { Progress } from './progress';
import { Recordings } from './recordings';
import { roomLink } from './room_link';
import { Settings } from './settings';
import { languageSelect } from '../languages/language_select';

const pollMs = 200;
const patienceMs = 60_000;

export class StartPage {
  private readonly people: People;
  private readonly cards: Cards;
  private readonly progress: Progress;
  private readonly course: CoursePanel;
  private readonly recordings: Recordings;
  private readonly settings = new Settings();
  private readonly say = el('p', { class: 'say', role: 'status' });
  private exercises: Exercise[] = [];
  private history = new Map<string, History>();
  private running: Running = { scene: '', person: '', state: '', text: '', request: '' };

  constructor(
    root: HTMLElement,
    private readonly api: Api,
    /** Goes to the page of the exercise. */
    private readonly enter: () => void,
  ) {
    this.people = new People(api, (person) => void this.changed(person));
    this.cards = new Cards(api, {
      begin: (e) => void this.begin(e),
      progress: (e) => void this.progress.open(e, this.people.person),
    });
    this.progress = new Progress(api);
    this.recordings = new Recordings(api);
    this.course = new CoursePanel(api, {
      begin: (terms) => void this.beginTask(terms),
      certificate: (id) => this.certificate(id),
      tell: (t) => this.tell(t),
    });
    root.append(
      el(
        'header',
        { class: 'top' },
        el('h1', {}, 'Insula'),
        el(
          'p',
          {},
          text('Aneurysm surgery with two-handed haptics. For training only, never for the care of patients.'),
        ),
        roomLink(api),
        languageSelect(),
        this.settings.button,
      ),
      el('main', {}, this.people.root, this.course.root, this.say, this.cards.root, this.recordings.root),
      this.progress.root,
      this.settings.root,
    );
  }

  async load(): Promise<void> {
    [this.exercises, this.running] = await Promise.all([this.api.exercises(), this.api.running()]);
    await this.people.load(this.running.person);
  }

  private async changed(person: string): Promise<void> {
    try {
      this.history = await this.api.history(person);
      await this.course.show(person);
      await this.recordings.show(person);
      this.tell('');
    } catch (e) {
      this.history = new Map();
      this.tell(e instanceof Error ? e.message : String(e));
    }
    if (person === this.people.person) this.cards.show(this.exercises, this.history, this.running.scene);
  }

  private tell(words: string): void {
    this.say.textContent = words;
  }

  private certificate(curriculum: string): void {
    const query = new URLSearchParams({ person: this.people.person, curriculum });
    window.location.href = `certificate.html?${query}`;
  }

  /** The engine's scene and person may be those that are wanted already; then nothing is loaded. */
  private async begin(e: Exercise): Promise<void> {
    const person = this.people.person;
    await this.start(e.title, async () => {
      const now = await this.api.running();
      if (now.state === 'running' && now.scene === e.scene && now.person === person) return now.request;
      return this.ask({ scene: e.scene, person });
    });
  }

  /** An attempt that counts begins anew, also in the running exercise. */
  private async beginTask({ scene, sceneTitle, mode, seed }: Terms): Promise<void> {
    const person = this.people.person;
    const terms = seed === null ? { mode } : { mode, seed };
    await this.start(sceneTitle, () => this.ask({ scene, person, ...terms }));
  }

  /** Returns the name of the request. */
  private async ask(choice: Omit<Choice, 'request'>): Promise<string> {
    const request = `${Date.now()}-${Math.random().toString(36).slice(2)}`;
    await this.api.choose({ ...choice, request });
    return request;
  }

  /** Goes to the exercise when the request has been answered. */
  private async start(title: string, ask: () => Promise<string>): Promise<void> {
    this.tell(text('Loading {title} …', { title }));
    try {
      const request = await ask();
      const end = performance.now() + patienceMs;
      for (;;) {
        this.running = await this.api.running();
        const ours = this.running.request === request;
        if (ours && this.running.state === 'running') return this.enter();
        if (ours && this.running.state === 'refused') throw new Error(this.running.text);
        if (performance.now() > end) throw new Error(text('{title} has not begun', { title }));
        await new Promise((r) => setTimeout(r, pollMs));
      }
    } catch (error) {
      this.tell(error instanceof Error ? error.message : String(error));
    }
  }
}
