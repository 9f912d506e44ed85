// SPDX-License-Identifier: GPL-3.0-or-later
// The head-up display around the field: exercise on the left, hands on the right, machine room at the bottom.
import type { Bundle } from '../bundle';
import { tool_in_hand } from '../hand_tool';
import type { InventoryItem } from '../inventory';
import type { HapticStatus, RenderFrame, SimEvent } from '../lcm';
import type { Role } from '../options';
import { ClipChooser } from './clips';
import { find_command, type UserCommand } from './commands';
import { el, set_text } from './dom';
import { HapticPanel } from './haptic';
import { make_help } from './help';
import { InstructorPanel } from './instructor';
import { InventoryPanel } from './inventory_panel';
import { NoticePanel } from './notice';
import { Progress } from './progress';
import { clock_text, force_bar, force_level, type HudState } from './state';
import { Toasts } from './toasts';
import { short, Tray } from './tray';
import { type ViewActions, ViewMenu } from './view_menu';
import { Vitals } from './vitals';

export interface HudActions extends ViewActions {
  run(command: UserCommand): void;
  choose_hand(hand: number): void;
  release_hand(hand: number): void;
  button(button: 1 | 2, on: boolean): void;
  /** Of a scene that is looked at: highlights it; null: nothing. */
  choose_item(item: InventoryItem | null): void;
}

class HandPanel {
  readonly root = el('div', { class: 'hand' });
  private readonly name = el('span', { class: 'name' });
  private readonly tag = el('span', { class: 'tag' });
  private readonly number = el('span', { class: 'force' }, '–');
  private readonly fill = el('i');

  readonly tray: Tray;

  constructor(hand: number, choose: () => void, release: () => void, run: (c: UserCommand) => void, may_drive: boolean) {
    this.tray = new Tray(run, may_drive);
    set_text(this.name, hand === 0 ? 'Left' : 'Right');
    const head = el('button', { class: 'choose', title: 'drive this hand' }, this.name, this.tag);
    head.onclick = choose;
    this.tag.onclick = (e) => { if (this.root.classList.contains('taken')) { e.stopPropagation(); release(); } };
    this.root.append(head, el('div', { class: 'bar' }, this.fill), this.number, this.tray.root);
  }

  show(force: number | null, kind: string, active: boolean, taken: boolean): void {
    this.root.classList.toggle('active', active);
    this.root.classList.toggle('taken', taken);
    set_text(this.tag, taken ? 'mouse ✕' : kind);
    set_text(this.number, force === null ? '–' : `${force.toFixed(2)} N`);
    this.fill.style.width = `${force === null ? 0 : force_bar(force) * 100}%`;
    this.root.dataset.level = force === null ? 'good' : force_level(force);
  }
}

export class Hud {
  readonly help = make_help();
  readonly view: ViewMenu;
  readonly vitals = new Vitals();
  readonly clips: ClipChooser;
  private readonly title = el('h1', {}, 'Insula');
  private readonly clock = el('span', { class: 'clock' }, '0:00.0');
  private readonly text = el('p', { class: 'text' });
  private readonly goals = el('ul', { class: 'goals' });
  private readonly faults = el('ul', { class: 'faults' });
  private readonly strands = el('div', { class: 'strands' });
  private readonly progress = new Progress();
  private readonly toasts = new Toasts();
  private readonly instructor: InstructorPanel | null;
  private readonly inventory: InventoryPanel;
  private readonly notice = new NoticePanel();
  private readonly message = el('div', { class: 'message', role: 'status' });
  private readonly banner = el('div', { class: 'banner', role: 'status' });
  private readonly link = el('span', { class: 'link' });
  private readonly machine = el('span', { class: 'machine' });
  private readonly haptic = new HapticPanel();
  private readonly pause = el('button', { class: 'timed' }, 'Pause');
  private readonly hands: HandPanel[];
  private bundle: Bundle | null = null;
  private state: HudState | null = null;
  private message_until = 0;

  constructor(private readonly root: HTMLElement, actions: HudActions, private readonly role: Role, quality: string) {
    const may_drive = role === 'trainee', may_command = role !== 'observer';
    this.hands = [0, 1].map((h) => new HandPanel(h, () => actions.choose_hand(h), () => actions.release_hand(h), (c) => actions.run(c), may_drive));
    this.clips = new ClipChooser((c) => actions.run(c), may_drive);
    this.view = new ViewMenu(actions);
    this.inventory = new InventoryPanel((item) => actions.choose_item(item));
    this.instructor = role === 'instructor' ? new InstructorPanel((c) => actions.run(c)) : null;
    this.pause.onclick = () => { actions.run({ command: this.pause.dataset.paused ? 'resume' : 'pause', argument: '' }); this.pause.blur(); };
    const reset = el('button', { class: 'timed' }, 'Reset');
    reset.onclick = () => { actions.run({ command: 'reset', argument: '' }); reset.blur(); };
    const help = el('button', { title: 'H' }, 'Help');
    help.onclick = () => { this.toggle_help(); help.blur(); };
    this.view.quality.value = quality;
    const touch = el('div', { class: 'touch' });
    for (const b of [1, 2] as const) {
      const button = el('button', {}, b === 1 ? 'Act' : 'Button 2');
      button.onpointerdown = () => actions.button(b, true);
      button.onpointerup = button.onpointerleave = button.onpointercancel = () => actions.button(b, false);
      touch.append(button);
    }
    const controls = el('div', { class: 'controls' }, ...(may_command ? [this.pause, reset] : []), help);
    root.dataset.role = role;
    root.append(
      el('div', { class: 'column left' },
        this.inventory.root,
        el('section', { class: 'panel exercise' }, el('header', {}, this.title, this.clock), this.text, this.goals, this.strands, this.progress.root, this.faults),
        this.vitals.root),
      el('div', { class: 'column right' },
        el('section', { class: 'panel' }, ...this.hands.map((h) => h.root), this.clips.root, controls, this.view.root, ...(may_drive ? [touch] : [])),
        ...(this.instructor ? [this.instructor.root] : [])),
      el('footer', {}, el('span', { class: 'warn' }, 'For training only. Not for patient care.'), this.haptic.root, this.machine, this.link),
      this.message, this.banner, this.toasts.root, this.notice.root, this.help);
  }

  toggle_help(): void { this.help.hidden = !this.help.hidden; }

  /** Asks for the next tool of a hand. */
  next_tool(hand: number, step: 1 | -1): void { this.hands[hand]?.tray.next(step); }

  show_scene(bundle: Bundle): void {
    this.bundle = bundle;
    this.root.dataset.look = bundle.inventory ? 'view' : 'play';
    this.inventory.show_scene(bundle.title, bundle.inventory);
    set_text(this.title, bundle.exercise?.title || bundle.title || 'Insula');
    set_text(this.text, bundle.exercise?.text || bundle.description);
    this.state = null;
    this.progress.clear();
    this.vitals.clear();
    this.clips.show_scene(bundle);
    this.instructor?.show_scene(bundle);
    this.hands.forEach((h, k) => h.tray.show_scene(bundle.hands.find((x) => x.hand === (k === 0 ? 'left' : 'right')) ?? null));
    const vessels = bundle.bodies.some((b) => b.surfaces.some((s) => s.vertex_region !== null));
    this.view.show_dye(vessels, !bundle.inventory && this.role !== 'observer' && find_command(bundle.commands, 'inject_dye') !== null);
    const e = bundle.exercise;
    this.show_exercise((e?.goals ?? []).map((g) => ({ ...g, done: false })), [], null, null);
  }

  /** `state`: what the frame's hud_json says, null when it says nothing. */
  show_frame(f: RenderFrame, state: HudState | null, active: number, taken: boolean[]): void {
    if (state && state !== this.state) this.show_state(state, f.sim_time_s);
    this.state = state;
    set_text(this.clock, clock_text(state?.elapsed_s ?? f.sim_time_s));
    const forces: (number | null)[] = [];
    for (let hand = 0; hand < 2; hand++) {
      const tool = this.bundle ? tool_in_hand(f, this.bundle, hand) : null;
      const data = this.bundle?.tools.find((t) => t.index === tool?.index);
      const force = tool ? Math.hypot(tool.force_N[0]!, tool.force_N[1]!, tool.force_N[2]!) : null;
      forces.push(force);
      this.hands[hand]!.show(force, data ? short(data, hand === 0 ? 'left' : 'right') : '', hand === active, taken[hand]!);
      this.hands[hand]!.tray.show(data?.id ?? '');
    }
    if (this.instructor) {
      this.instructor.curves.add(f.sim_time_s, forces);
      this.instructor.curves.draw();
    }
    this.pause.dataset.paused = f.paused ? '1' : '';
    set_text(this.pause, f.paused ? 'Resume' : 'Pause');
  }

  /** Something that happened once. */
  show_event(e: SimEvent, now_ms: number): void {
    this.instructor?.add_event(e.sim_time_s, e.kind, e.id, e.text);
    // What chance or the instructor brings, the trainee sees in the field and not in words.
    if (e.kind === 'command' || e.kind === 'complication') return;
    if (e.kind === 'refused') { if (this.role !== 'observer') this.toasts.refuse(e.text, now_ms); }
    else if (e.kind === 'message' && e.id === 'message') { if (this.role !== 'instructor') this.toasts.instruct(e.text, now_ms); }
    else if (e.text) this.say(e.text, e.kind, now_ms);
  }

  show_machine(f: RenderFrame | null, haptic: HapticStatus | null, fps: number, quality: string): void {
    const parts: string[] = [];
    if (f) parts.push(`step ${f.step_ms.toFixed(1)} / ${f.step_period_ms.toFixed(1)} ms`, `${f.rows} rows`);
    this.haptic.show(haptic);
    parts.push(`${fps.toFixed(0)} fps ${quality}`);
    set_text(this.machine, parts.join('   '));
    this.machine.classList.toggle('slow', !!f && f.step_ms > f.step_period_ms);
  }

  show_link(text: string, ok: boolean): void {
    set_text(this.link, text);
    this.link.classList.toggle('ok', ok);
  }

  show_banner(text: string): void {
    set_text(this.banner, text);
    this.banner.hidden = text === '';
  }

  /** What the loader says of a saved scene; empty: nothing. */
  show_notice(message: string): void { this.notice.show(message); }

  say(text: string, kind: string, now_ms: number): void {
    set_text(this.message, text);
    this.message.dataset.kind = kind;
    this.message.classList.add('on');
    this.message_until = now_ms + 3500;
  }

  refuse(why: string, now_ms: number): void { this.toasts.refuse(why, now_ms); }

  tick(now_ms: number): void {
    if (this.message_until > 0 && now_ms > this.message_until) { this.message.classList.remove('on'); this.message_until = 0; }
    this.toasts.tick(now_ms);
  }

  private show_state(s: HudState, time_s: number): void {
    this.show_exercise(s.goals, s.faults, s.strands_left, s.strands_total);
    this.progress.show(s.timers, s.measures);
    this.clips.show(s.clips);
    this.vitals.show(s.heart_phase, s.vessels, s.blood, time_s);
    if (s.state === 'done' || s.state === 'failed') {
      set_text(this.message, s.message || (s.state === 'done' ? 'Exercise complete' : 'Exercise failed'));
      this.message.dataset.kind = s.state === 'done' ? 'goal' : 'fault';
      this.message.classList.add('on');
      this.message_until = 0;
    } else if (this.message_until === 0) this.message.classList.remove('on');
  }

  private exercise_shown = '';
  private show_exercise(goals: HudState['goals'], faults: HudState['faults'], left: number | null, total: number | null): void {
    // Pulse and flow change the state with every frame; the lists seldom.
    const key = JSON.stringify([goals, faults]);
    if (key !== this.exercise_shown) {
      this.exercise_shown = key;
      this.goals.replaceChildren(...goals.map((g) => el('li', { class: g.done ? 'done' : '' }, g.text)));
      this.faults.replaceChildren(...faults.filter((f) => f.count > 0).map((f) => el('li', {}, el('b', {}, String(f.count)), f.text)));
    }
    set_text(this.strands, left === null || total === 0 ? '' : `Strands left  ${left}${total === null ? '' : ` of ${total}`}`);
  }
}
