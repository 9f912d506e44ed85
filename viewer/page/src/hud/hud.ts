// SPDX-License-Identifier: GPL-3.0-or-later
// The head-up display around the field: the patient and the exercise on the left, hands on the right, machine room at
// the bottom. On a narrow screen the panels are folded away behind tabs.
import type { Bundle } from '../bundle_types';
import { toolInHand } from '../hand_tool';
import type { InventoryItem } from '../inventory';
import type { HapticStatus, RenderFrame, SimEvent } from '../lcm';
import type { Role } from '../options';
import { takeBackText } from '../take_back';
import { glowCommands } from './commands';
import { el, setText } from './dom';
import { ExercisePanel } from './exercise_panel';
import type { FrameView } from './frame_view';
import { returnFocusToField } from './focus';
import { GuidePanel } from './guide_panel';
import { depthText, type HandActions, HandPanel } from './hand_panel';
import { HapticPanel } from './haptic';
import { Help } from './help';
import { machineText } from './machine_text';
import { InstructorPanel } from './instructor';
import { InventoryPanel } from './inventory_panel';
import type { Metrics } from './metrics';
import { NoticePanel } from './notice';
import { RequestPanel } from './request_panel';
import { SessionPanel } from './session_panel';
import { type SoundActions, SoundPanel } from './sound_panel';
import { type HudState, isOver } from './state';
import { Tabs } from './tabs';
import { Toasts } from './toasts';
import { makeTouch, type TouchActions } from './touch';
import { ToolList } from './tool_list';
import { short } from './tray';
import { levelNames, type ViewActions, ViewMenu } from './view_menu';
import { Vitals } from './vitals';
import { said } from '../languages/said';
import { text } from '../languages/text';

export interface HudActions extends ViewActions, HandActions, SoundActions, TouchActions {
  /** Of a scene that is looked at: highlights it; null: nothing. */
  chooseItem(item: InventoryItem | null): void;
  /** To another target of the guide. */
  stepGuide(by: 1 | -1): void;
  /** Begins or ends to turn the tool of the active hand as its target is turned. */
  turnToTarget(): void;
}

const side = (hand: number): 'left' | 'right' => (hand === 0 ? 'left' : 'right');

export class Hud {
  readonly session: SessionPanel;
  private readonly help: Help;
  readonly view: ViewMenu;
  readonly sound: SoundPanel;
  readonly toolList: ToolList;
  /** Below the controls of the hands. */
  readonly beside = el('div', { class: 'beside' });
  /** Below the field. */
  readonly under = el('div', { class: 'under' });
  private readonly vitals = new Vitals();
  private readonly exercise = new ExercisePanel();
  readonly toasts = new Toasts();
  private readonly instructor: InstructorPanel | null;
  /** Of the trainee, who operates. */
  private readonly requests: RequestPanel | null;
  private readonly guide: GuidePanel;
  private readonly tabs: Tabs;
  private readonly inventory: InventoryPanel;
  private readonly notice = new NoticePanel(text('The saved scene has errors. What runs is the scene before.'));
  private readonly problems = new NoticePanel(text('Data from the engine cannot be shown.'));
  private readonly message = el('div', { class: 'message', role: 'status' });
  private readonly banner = el('div', { class: 'banner', role: 'status' });
  private readonly link = el('span', { class: 'link' });
  private readonly machine = el('span', { class: 'machine' });
  private readonly haptic = new HapticPanel();
  private readonly pause = el('button', { class: 'timed' }, text('Pause'));
  private readonly hands: HandPanel[];
  private bundle: Bundle | null = null;
  private state: HudState | null = null;
  private messageUntil = 0;

  constructor(
    private readonly root: HTMLElement,
    field: HTMLElement,
    private readonly actions: HudActions,
    private readonly role: Role,
    quality: string,
  ) {
    const mayDrive = role === 'trainee';
    this.help = new Help(() => field);
    this.session = new SessionPanel(
      (c) => actions.run(c),
      role,
      () => field,
    );
    this.guide = new GuidePanel(
      (by) => actions.stepGuide(by),
      () => actions.turnToTarget(),
    );
    this.hands = [0, 1].map((h) => new HandPanel(h, actions, mayDrive));
    this.toolList = new ToolList((c) => actions.run(c), mayDrive);
    this.view = new ViewMenu(actions);
    this.sound = new SoundPanel(actions, 'M');
    this.inventory = new InventoryPanel((item) => actions.chooseItem(item));
    this.instructor = role === 'instructor' ? new InstructorPanel((c) => actions.run(c)) : null;
    this.requests = mayDrive ? new RequestPanel((c) => actions.run(c)) : null;
    if (this.requests) this.vitals.root.append(this.requests.root);
    this.view.quality.value = quality;
    root.dataset.role = role;
    const handsPanel = el(
      'section',
      { class: 'panel' },
      ...this.hands.map((h) => h.root),
      this.toolList.root,
      this.makeControls(actions),
      this.view.root,
      this.sound.root,
      this.beside,
    );
    const warning = el('span', { class: 'warn' }, text('For training only. Not for patient care.'));
    const left = el('div', { class: 'column left' }, this.vitals.root, this.exercise.root, this.inventory.root);
    const right = el('div', { class: 'column right' }, handsPanel, ...(this.instructor ? [this.instructor.root] : []));
    this.tabs = new Tabs(root, [
      { name: 'left', text: text('Patient and exercise') },
      { name: 'right', text: role === 'instructor' ? text('Commands') : text('Hands and tools') },
    ]);
    const notices = el('div', { class: 'notices' }, this.notice.root, this.problems.root);
    this.under.append(this.message, this.guide.root, ...(mayDrive ? [makeTouch(actions)] : []), this.tabs.root);
    root.append(
      left,
      right,
      this.under,
      el('footer', {}, warning, this.haptic.root, this.machine, this.link),
      ...[this.banner, this.toasts.root, notices, ...this.session.roots, this.help.root],
    );
    returnFocusToField(root, field);
  }

  toggleHelp(): void {
    this.help.toggle();
  }

  /** On a narrow screen its column is opened first. */
  toggleToolList(): void {
    this.tabs.open('right');
    this.toolList.toggle();
  }

  /** Asks for the next tool of a hand. */
  nextTool(hand: number, step: 1 | -1): void {
    this.hands[hand]?.tray.next(step);
  }

  /** Asks for the tool that the hand had before its last exchange. */
  undoExchange(hand: number): void {
    this.hands[hand]?.tray.undo();
  }

  showScene(bundle: Bundle): void {
    this.bundle = bundle;
    this.state = null;
    this.root.dataset.look = bundle.inventory ? 'view' : 'play';
    this.inventory.showScene(bundle.title, bundle.inventory);
    this.exercise.showScene(bundle);
    this.session.showScene(bundle);
    this.vitals.showScene(bundle);
    this.toolList.showScene(bundle);
    this.instructor?.showScene(bundle);
    this.requests?.showScene(bundle);
    this.message.classList.remove('on');
    this.guide.show(null, false);
    this.hands.forEach((h, k) => h.showScene(bundle.hands.find((x) => x.hand === side(k)) ?? null));
    const shines = bundle.bodies.some((b) => Object.keys(b.channelOfRegion).length > 0);
    this.view.showGlow(shines, bundle.inventory || this.role === 'observer' ? [] : glowCommands(bundle));
  }

  showFrame({ frame, channels, state, active, hands, guide, assists, depth, within, ready }: FrameView): void {
    if (state && state !== this.state) this.showState(state);
    if (state && !this.bundle?.inventory) this.session.show(state, ready);
    this.state = state;
    this.guide.show(state && isOver(state) ? null : guide, assists);
    this.exercise.showClock(state?.elapsedS ?? frame.sim_time_s);
    const forces = this.hands.map((panel, hand) => {
      const tool = this.bundle ? toolInHand(frame, this.bundle, hand) : null;
      const data = this.bundle?.tools.find((t) => t.index === tool?.index);
      const force = tool ? Math.hypot(tool.force_N[0]!, tool.force_N[1]!, tool.force_N[2]!) : null;
      const kind = data ? short(data, side(hand)) : '';
      const reach = within?.hand === hand ? takeBackText(within) : '';
      panel.show({
        force,
        kind,
        depth: depthText(depth, hand, active),
        reach,
        active: hand === active,
        ...hands[hand]!,
      });
      panel.tray.show(data?.id ?? '');
      return force;
    });
    this.toolList.show(frame.tool);
    const stowed = this.stowed(frame);
    this.vitals.show(channels, stowed, frame.sim_time_s);
    this.instructor?.showCauses(state?.tutor.causes ?? []);
    this.instructor?.show(channels, stowed, forces, frame.sim_time_s);
    this.pause.dataset.paused = frame.paused ? '1' : '';
    setText(this.pause, frame.paused ? text('Resume') : text('Pause'));
  }

  /** Five times a second. */
  showMetrics(metrics: Metrics): void {
    this.instructor?.showMetrics(metrics.values);
    this.session.showMetrics(metrics);
  }

  /** Something that happened once. */
  showEvent(e: SimEvent, nowMs: number): void {
    this.instructor?.addEvent(e.sim_time_s, e.kind, e.id, e.text);
    this.requests?.addEvent(e);
    if (e.kind === 'reset') for (const h of this.hands) h.tray.forget();
    // The tutor's line says hints, and not in a test.
    if (e.kind === 'hint') return;
    // What chance or the instructor brings, the trainee sees in the field and not in words.
    if (e.kind === 'command' || e.kind === 'complication' || e.kind === 'read') return;
    if (e.kind === 'refused') {
      if (this.role !== 'observer') this.toasts.refuse(said(e.text), nowMs);
    } else if (e.kind === 'message' && e.id === 'message') {
      const read = () => {
        if (this.role === 'trainee') this.actions.run({ command: 'read', argument: e.text });
      };
      if (this.role !== 'instructor') this.toasts.instruct(e.text, read);
    } else if (e.text) this.say(said(e.text), e.kind, nowMs);
  }

  showMachine(f: RenderFrame | null, haptic: HapticStatus | null, fps: number, quality: string): void {
    this.haptic.show(haptic, f?.paused ?? false);
    setText(this.machine, machineText(f, fps, levelNames[quality] ?? quality));
    this.machine.classList.toggle('slow', !!f && f.step_ms > f.step_period_ms);
  }

  showLink(words: string, ok: boolean): void {
    setText(this.link, words);
    this.link.classList.toggle('ok', ok);
  }

  showBanner(words: string): void {
    setText(this.banner, words);
    this.banner.hidden = words === '';
  }

  /** What the loader says of a saved scene; empty: nothing. */
  showNotice(message: string): void {
    this.notice.show(message);
  }

  /** What is wrong with the engine's data, one line each. */
  showProblems(lines: readonly string[]): void {
    this.problems.show(lines.join('\n'));
  }

  /** Something about this machine that its user should know; '': nothing. */
  advise(words: string): void {
    if (words !== '') this.toasts.advise(words);
  }

  refuse(why: string, nowMs: number): void {
    this.toasts.refuse(why, nowMs);
  }

  tick(nowMs: number): void {
    if (this.messageUntil > 0 && nowMs > this.messageUntil) {
      this.message.classList.remove('on');
      this.messageUntil = 0;
    }
    this.toasts.tick(nowMs);
  }

  private say(words: string, kind: string, nowMs: number): void {
    setText(this.message, `${kind === 'goal' ? '✓ ' : kind === 'fault' ? '✗ ' : ''}${words}`);
    this.message.dataset.kind = kind;
    this.message.classList.add('on');
    this.messageUntil = nowMs + 3500;
  }

  /** Components that are tools on the tray. */
  private stowed(frame: RenderFrame): Set<string> {
    const away = new Set(frame.tool.filter((t) => t.state === 0).map((t) => t.index));
    return new Set((this.bundle?.tools ?? []).filter((t) => away.has(t.index)).map((t) => t.id));
  }

  private showState(s: HudState): void {
    this.exercise.showState(s);
    if (isOver(s)) {
      setText(
        this.message,
        s.state === 'done' ? `✓ ${text('Exercise complete')}` : `✗ ${s.message || text('Exercise failed')}`,
      );
      this.message.dataset.kind = s.state === 'done' ? 'goal' : 'fault';
      this.message.classList.add('on');
      this.messageUntil = 0;
    } else if (this.messageUntil === 0) this.message.classList.remove('on');
  }

  private makeControls(actions: HudActions): HTMLElement {
    const ask = (button: HTMLButtonElement, command: () => string) => {
      button.onclick = () => {
        actions.run({ command: command(), argument: '' });
      };
    };
    ask(this.pause, () => (this.pause.dataset.paused ? 'resume' : 'pause'));
    const reset = el('button', { class: 'timed', 'aria-haspopup': 'dialog' }, text('Reset'));
    reset.onclick = () => this.session.askReset();
    const help = el('button', { title: 'H', 'aria-haspopup': 'dialog' }, text('Help'));
    help.onclick = () => this.toggleHelp();
    return el('div', { class: 'controls' }, ...(this.role === 'observer' ? [] : [this.pause, reset]), help);
  }
}
