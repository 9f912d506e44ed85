// SPDX-License-Identifier: GPL-3.0-or-later
// A replay while it runs: the clock, the fields, the timeline, the keys, and the loop that draws.
import { el } from '../hud/dom';
import { returnFocusToField } from '../hud/focus';
import { isControl, isTyping, keyOf } from '../keyboard';
import { Pace } from '../pace';
import type { Mark } from './chart';
import { debrief } from './debrief';
import { ReplayClock } from './clock';
import { MomentsPanel } from './moments_panel';
import { Notes } from './notes';
import { ReplaySound } from './replay_sound';
import { Rest } from './rest';
import type { Side } from './side';
import { ghostLink } from './ghost_link';
import { download } from './source';
import { freshStatus, type ReplayStatus } from './status';
import { Transport } from './transport';
import { VideoRecorder } from './video';
import { spoken } from '../bundle';
import { languageSelect } from '../languages/language_select';
import { fixed } from '../languages/numbers';
import { text } from '../languages/text';

/** Events that a person looks for. */
const shownKinds = new Set(['goal', 'fault', 'message', 'command', 'complication', 'mode', 'refused']);
/** On narrower windows the list of moments is hidden at first. */
const narrowPx = 900;
const stepS = 1;
const fineStepS = 0.1;
const shiftStepS = 0.5;

export const reasonOf = (e: unknown): string => (e instanceof Error ? e.message : String(e));

export class Replay {
  private readonly clock: ReplayClock;
  private readonly transport: Transport;
  private readonly moments: MomentsPanel;
  private readonly notes: Notes;
  private readonly rest: Rest;
  private readonly video: VideoRecorder;
  private readonly toast = el('div', { class: 'banner', role: 'alert' });
  private readonly first: Side;
  private jumpedMs: number | null = null;
  private readonly status = freshStatus();
  private readonly sound = new ReplaySound(this.status.sound);

  /** kept: notes are kept beside the recording. */
  constructor(
    private readonly hud: HTMLElement,
    private readonly sides: readonly Side[],
    kept: boolean,
    private readonly query: URLSearchParams,
  ) {
    this.first = sides[0]!;
    const { session, view } = this.first;
    this.rest = new Rest(
      window,
      sides.map((s) => s.view.stage.canvas),
    );
    this.clock = new ReplayClock(session.durationS);
    this.clock.seek(Number(query.get('t') ?? 0) || 0);
    this.notes = new Notes(
      session.name,
      kept,
      () => this.showMarks(),
      (why) => this.say(why),
    );
    this.video = new VideoRecorder(view.stage.canvas, this.clock);
    this.transport = new Transport(this.clock, session.timeline, {
      moved: () => this.jumped(),
      arrows: (on) => {
        for (const s of sides) s.view.arrows.root.visible = on;
        this.rest.wake();
      },
      note: () => this.askNote(),
      video: () => void this.recordVideo(),
      debrief: () => void this.showDebrief(),
      moments: () => this.showMoments(document.body.dataset.moments !== 'on'),
    });
    this.moments = new MomentsPanel(
      (timeS) => this.seek(timeS),
      (mark) => this.notes.remove(mark.timeS, mark.text),
    );
    for (const s of sides) s.shiftS = (s.session.timeline.passesS[0] ?? 0) - (session.timeline.passesS[0] ?? 0);
    const warning = el(
      'footer',
      {},
      el('span', { class: 'warn' }, text('For training only. Not for patient care.')),
      languageSelect(),
    );
    const right = el(
      'div',
      { class: 'column right' },
      this.moments.root,
      ...this.shiftPanel(),
      ...ghostLink(kept, session),
    );
    this.toast.hidden = true;
    this.showMoments(window.innerWidth > narrowPx);
    hud.append(right, this.notes.root, this.transport.root, warning, this.toast);
    hud.parentElement!.dataset.sides = String(sides.length);
    this.first.left.firstElementChild!.after(this.sound.root);
    returnFocusToField(hud, view.stage.canvas);
    (window as unknown as { __replay: ReplayStatus }).__replay = this.status;
    window.addEventListener('keydown', (e) => this.key(e));
  }

  /** Draws from now on. */
  begin(): void {
    this.showMarks();
    if (!this.first.session.ended) this.say(text('This recording was not ended; it is shown as far as it goes.'));
    void this.notes.load();
    const pace = new Pace((fps, seconds) => this.sides.forEach((s) => s.view.observe(fps, seconds)));
    let drawing = false;
    const picture = async (now: number) => {
      const ms = pace.begin(now);
      await this.draw(now, Math.min(0.25, ms / 1000));
      pace.count(now, true);
      if (!this.status.ready) this.opened();
    };
    this.first.view.stage.renderer.setAnimationLoop((now: number) => {
      // A jump waits for one picture at most, and not for a queue of them.
      if (drawing || !this.sides.every((s) => s.view.stage.done)) return;
      if (this.complete) this.status.complete_ms ||= performance.now();
      const rests = !this.moves && !this.rest.due(now);
      if (rests) {
        pace.rest(now);
        if (this.rest.panels(now)) this.transport.draw(this.video.running);
        if (this.complete) return;
      }
      drawing = true;
      (rests ? this.rehearse() : picture(now))
        .catch((e: unknown) => this.say(text('The recording cannot be read: {why}', { why: reasonOf(e) })))
        .finally(() => (drawing = false));
    });
  }

  private get complete(): boolean {
    return this.sides.every((s) => s.view.complete);
  }

  private async rehearse(): Promise<void> {
    for (const s of this.sides) await s.view.rehearse();
  }

  /** Ends when the picture of a jump is done: the time from there. */
  private async sought(jumpedMs: number): Promise<void> {
    await Promise.all(this.sides.map((s) => s.view.stage.whenDone()));
    const { status } = this;
    status.seek_ms = performance.now() - jumpedMs;
    status.seeks++;
  }

  /** The next picture differs from the last one, whatever a person does. */
  private get moves(): boolean {
    const { clock, video } = this;
    return clock.playing || video.running || this.jumpedMs !== null || this.sides.some((s) => s.view.moves);
  }

  private opened(): void {
    this.status.ready = true;
    this.status.timeline_chunks = this.first.session.timelineChunks;
    this.status.chunks_unpacked_to_open = this.first.session.unpackedChunks;
    this.status.open_ms = this.first.view.firstPictureMs;
    if (this.query.has('debrief')) void this.showDebrief();
  }

  /** What is at hand is drawn at once; a part of the file that is not takes a moment. */
  private async draw(now: number, dtS: number): Promise<void> {
    const { playing } = this.clock;
    this.clock.advance(dtS);
    // The end of the recording is drawn as it stands.
    if (playing && !this.clock.playing) this.rest.wake();
    const { timeS } = this.clock;
    const unpacked = this.first.session.unpackedChunks;
    const from = performance.now();
    const { jumpedMs } = this;
    this.jumpedMs = null;
    const soon = jumpedMs !== null;
    if (soon) this.rest.jump();
    else this.rest.begin();
    await Promise.all(this.sides.map((s) => s.seek(timeS)));
    const decodeMs = performance.now() - from;
    for (const s of this.sides) s.view.draw(now, Math.min(0.1, dtS), { settled: !this.clock.playing, soon });
    this.sound.picture(this.first.view, this.clock, this.first.session.timeline.events);
    if (jumpedMs === null) this.showPanels(timeS);
    else {
      // A browser that draws by software draws panels with the same threads as the picture.
      void this.sought(jumpedMs).then(() => this.showPanels(timeS));
      this.status.decode_max_ms = Math.max(this.status.decode_max_ms, decodeMs);
      this.status.seek_chunks_max = Math.max(this.status.seek_chunks_max, this.first.session.unpackedChunks - unpacked);
    }
    this.status.pictures++;
    this.status.time_s = timeS;
    this.status.duration_s = this.clock.durationS;
  }

  private showPanels(timeS: number): void {
    for (const s of this.sides) s.showPanels();
    this.transport.draw(this.video.running);
    this.moments.at(timeS);
  }

  private seek(timeS: number): void {
    this.clock.seek(timeS);
    this.jumped();
  }

  private jumped(): void {
    this.jumpedMs ??= performance.now();
  }

  private askNote(): void {
    this.clock.playing = false;
    this.notes.ask(this.clock.timeS);
  }

  private showMarks(): void {
    const events = this.first.session.timeline.events.filter((e) => shownKinds.has(e.kind));
    const marks: Mark[] = [
      ...events.map((e) => ({ timeS: e.timeS, kind: e.kind, text: e.text || `${spoken(e.kind)} ${spoken(e.id)}` })),
      ...this.notes.all.map((n) => ({ timeS: n.timeS, kind: 'note', text: n.text })),
    ];
    marks.sort((a, b) => a.timeS - b.timeS);
    this.transport.chart.marks = marks;
    this.rest.wake();
    this.moments.show(marks);
  }

  private showMoments(on: boolean): void {
    document.body.dataset.moments = on ? 'on' : 'off';
  }

  private async showDebrief(): Promise<void> {
    this.clock.playing = false;
    try {
      this.hud.append(await debrief(this.first.session, this.first.view, this.notes.all));
    } catch (e) {
      this.say(text('The recording cannot be read: {why}', { why: reasonOf(e) }));
    }
    this.rest.wake();
  }

  private async recordVideo(): Promise<void> {
    if (this.video.running) return;
    const stretch = this.clock.stretch ?? { fromS: 0, toS: this.clock.durationS };
    try {
      const video = await this.video.record(stretch);
      this.status.video_bytes = video.size;
      download(`${this.first.session.name}.webm`, video);
    } catch (e) {
      this.say(text('No video: {why}', { why: reasonOf(e) }));
    }
  }

  /** Of two sessions: moves the second one in time. */
  private shiftPanel(): HTMLElement[] {
    const second = this.sides[1];
    if (!second) return [];
    const words = el('span');
    const show = () => (words.textContent = `${second.session.name}: ${fixed(second.shiftS, 1)} s`);
    const shift = (by: number) => {
      second.shiftS += by;
      show();
      this.jumped();
    };
    const earlier = el('button', {}, `− ${fixed(shiftStepS, 1)} s`);
    earlier.onclick = () => shift(-shiftStepS);
    const later = el('button', {}, `+ ${fixed(shiftStepS, 1)} s`);
    later.onclick = () => shift(shiftStepS);
    show();
    return [el('section', { class: 'panel shift' }, el('h2', {}, text('Second session')), words, earlier, later)];
  }

  private say(words: string): void {
    this.toast.textContent = words;
    this.toast.hidden = false;
    setTimeout(() => (this.toast.hidden = true), 6000);
  }

  private key(e: KeyboardEvent): void {
    if (isTyping(e.target) || e.ctrlKey || e.metaKey) return;
    const key = keyOf(e);
    const { clock } = this;
    const by = e.shiftKey ? fineStepS : stepS;
    const commands: Record<string, () => void> = {
      space: () => clock.toggle(),
      arrowleft: () => this.seek(clock.timeS - by),
      arrowright: () => this.seek(clock.timeS + by),
      home: () => this.seek(0),
      end: () => this.seek(clock.durationS),
      arrowup: () => clock.changeSpeed(1),
      arrowdown: () => clock.changeSpeed(-1),
      f: () => this.transport.jumpToFault(1),
      b: () => this.transport.jumpToFault(-1),
      n: () => this.askNote(),
      m: () => this.showMoments(document.body.dataset.moments !== 'on'),
      '[': () => clock.mark('from'),
      ']': () => clock.mark('to'),
      v: () => this.sides.forEach((s) => s.view.stage.scope.reset()),
    };
    const run = commands[key];
    // A focused button answers to Space itself.
    if (!run || (key === 'space' && isControl(e.target))) return;
    e.preventDefault();
    run();
  }
}
