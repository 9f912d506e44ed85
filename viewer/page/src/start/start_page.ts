// SPDX-License-Identifier: GPL-3.0-or-later
// The start page: who you are, what there is to do, and how you get on.
import { el } from '../hud/dom';
import type { Api, Exercise, History, Running } from './api';
import { Cards } from './cards';
import { People } from './people';
import { Progress } from './progress';
import { Recordings } from './recordings';
import { Settings } from './settings';
import { languageSelect } from '../languages/language_select';
import { text } from '../languages/text';

const pollMs = 200;
const patienceMs = 60_000;

export class StartPage {
  private readonly people: People;
  private readonly cards: Cards;
  private readonly progress: Progress;
  private readonly recordings: Recordings;
  private readonly settings = new Settings();
  private readonly say = el('p', { class: 'say', role: 'status' });
  private exercises: Exercise[] = [];
  private history = new Map<string, History>();
  private running: Running = { scene: '', person: '', state: '', text: '' };

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
        languageSelect(),
        this.settings.button,
      ),
      el('main', {}, this.people.root, this.say, this.cards.root, this.recordings.root),
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

  /** The engine's scene and person may be those that are wanted already; then nothing is loaded. */
  private async begin(e: Exercise): Promise<void> {
    const person = this.people.person;
    this.tell(text('Loading {exercise} …', { exercise: e.title }));
    try {
      this.running = await this.api.running();
      const there = (r: Running) => r.state === 'running' && r.scene === e.scene && r.person === person;
      if (!there(this.running)) await this.api.choose(e.scene, person);
      const end = performance.now() + patienceMs;
      while (!there(this.running)) {
        if (this.running.state === 'refused' && this.running.scene === e.scene) throw new Error(this.running.text);
        if (performance.now() > end) throw new Error(text('{exercise} has not begun', { exercise: e.title }));
        await new Promise((r) => setTimeout(r, pollMs));
        this.running = await this.api.running();
      }
      this.enter();
    } catch (error) {
      this.tell(error instanceof Error ? error.message : String(error));
    }
  }
}
