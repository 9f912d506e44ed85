// SPDX-License-Identifier: GPL-3.0-or-later
// The head-up display around the field: exercise on the left, hands on the right, machine room at the bottom.
import type { Bundle } from '../bundle';
import type { HapticStatus, RenderFrame } from '../lcm';
import { levels } from '../quality';
import { el, set_text } from './dom';
import { make_help } from './help';
import { clock_text, force_bar, force_level, parse_hud, type HudState } from './state';

export interface HudActions {
  command(name: 'pause' | 'resume' | 'reset'): void;
  quality(name: string): void;
  choose_hand(hand: number): void;
  release_hand(hand: number): void;
  button(button: 1 | 2, on: boolean): void;
}

class HandPanel {
  readonly root = el('div', { class: 'hand' });
  private readonly name = el('span', { class: 'name' });
  private readonly tag = el('span', { class: 'tag' });
  private readonly number = el('span', { class: 'force' }, '–');
  private readonly fill = el('i');

  constructor(hand: number, choose: () => void, release: () => void) {
    set_text(this.name, hand === 0 ? 'Left' : 'Right');
    const head = el('button', { class: 'choose', title: 'drive this hand' }, this.name, this.tag);
    head.onclick = choose;
    this.tag.onclick = (e) => { if (this.root.classList.contains('taken')) { e.stopPropagation(); release(); } };
    this.root.append(head, el('div', { class: 'bar' }, this.fill), this.number);
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
  private readonly title = el('h1', {}, 'Insula');
  private readonly clock = el('span', { class: 'clock' }, '0:00.0');
  private readonly text = el('p', { class: 'text' });
  private readonly goals = el('ul', { class: 'goals' });
  private readonly faults = el('ul', { class: 'faults' });
  private readonly strands = el('div', { class: 'strands' });
  private readonly message = el('div', { class: 'message', role: 'status' });
  private readonly banner = el('div', { class: 'banner', role: 'status' });
  private readonly link = el('span', { class: 'link' });
  private readonly machine = el('span', { class: 'machine' });
  private readonly pause = el('button', {}, 'Pause');
  private readonly quality = el('select', { title: 'picture quality' });
  private readonly hands: HandPanel[];
  private hud_text = '';
  private state: HudState | null = null;
  private message_until = 0;

  constructor(root: HTMLElement, actions: HudActions, may_command: boolean, may_drive: boolean, quality: string) {
    this.hands = [0, 1].map((h) => new HandPanel(h, () => actions.choose_hand(h), () => actions.release_hand(h)));
    this.pause.onclick = () => { actions.command(this.pause.dataset.paused ? 'resume' : 'pause'); this.pause.blur(); };
    const reset = el('button', {}, 'Reset');
    reset.onclick = () => { actions.command('reset'); reset.blur(); };
    const help = el('button', { title: 'H' }, 'Help');
    help.onclick = () => { this.toggle_help(); help.blur(); };
    this.quality.append(el('option', { value: '' }, 'Auto'), ...levels.map((l) => el('option', { value: l.name }, l.name[0]!.toUpperCase() + l.name.slice(1))));
    this.quality.value = quality;
    this.quality.onchange = () => { actions.quality(this.quality.value); this.quality.blur(); };
    const touch = el('div', { class: 'touch' });
    for (const b of [1, 2] as const) {
      const button = el('button', {}, b === 1 ? 'Act' : 'Button 2');
      button.onpointerdown = () => actions.button(b, true);
      button.onpointerup = button.onpointerleave = button.onpointercancel = () => actions.button(b, false);
      touch.append(button);
    }
    const controls = el('div', { class: 'controls' }, ...(may_command ? [this.pause, reset] : []), help, this.quality);
    root.append(
      el('section', { class: 'panel left' }, el('header', {}, this.title, this.clock), this.text, this.goals, this.strands, this.faults),
      el('section', { class: 'panel right' }, ...this.hands.map((h) => h.root), controls, ...(may_drive ? [touch] : [])),
      el('footer', {}, el('span', { class: 'warn' }, 'For training only. Not for patient care.'), this.machine, this.link),
      this.message, this.banner, this.help);
  }

  toggle_help(): void { this.help.hidden = !this.help.hidden; }

  show_scene(bundle: Bundle): void {
    set_text(this.title, bundle.exercise?.title || bundle.title || 'Insula');
    set_text(this.text, bundle.exercise?.text || bundle.description);
    this.hud_text = '';
    this.state = null;
    const e = bundle.exercise;
    this.show_exercise({
      goals: (e?.goals ?? []).map((g) => ({ ...g, done: false })), faults: (e?.faults ?? []).map((f) => ({ ...f, count: 0 })),
      strands_left: null, strands_total: null, message: '', state: '', elapsed_s: null,
    });
  }

  show_frame(f: RenderFrame, kinds: string[], active: number, taken: boolean[]): void {
    if (f.hud_json !== this.hud_text) {
      this.hud_text = f.hud_json;
      this.state = parse_hud(f.hud_json);
      if (this.state) this.show_exercise(this.state);
    }
    set_text(this.clock, clock_text(this.state?.elapsed_s ?? f.sim_time_s));
    for (let hand = 0; hand < 2; hand++) {
      const tool = f.tool.find((t) => t.hand === hand);
      const force = tool ? Math.hypot(tool.force_N[0]!, tool.force_N[1]!, tool.force_N[2]!) : null;
      this.hands[hand]!.show(force, kinds[hand] ?? '', hand === active, taken[hand]!);
    }
    this.pause.dataset.paused = f.paused ? '1' : '';
    set_text(this.pause, f.paused ? 'Resume' : 'Pause');
  }

  show_machine(f: RenderFrame | null, haptic: HapticStatus | null, fps: number, quality: string): void {
    const parts: string[] = [];
    if (f) parts.push(`step ${f.step_ms.toFixed(1)} / ${f.step_period_ms.toFixed(1)} ms`, `${f.rows} rows`);
    if (haptic) parts.push(`haptics ${haptic.ticks_per_s.toFixed(0)} /s, fresh ${haptic.fresh_forces_per_s[0]!.toFixed(0)} · ${haptic.fresh_forces_per_s[1]!.toFixed(0)}`);
    else parts.push('haptics –');
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

  say(text: string, kind: string, now_ms: number): void {
    set_text(this.message, text);
    this.message.dataset.kind = kind;
    this.message.classList.add('on');
    this.message_until = now_ms + 3500;
  }

  tick(now_ms: number): void {
    if (this.message_until > 0 && now_ms > this.message_until) { this.message.classList.remove('on'); this.message_until = 0; }
  }

  private show_exercise(s: HudState): void {
    this.goals.replaceChildren(...s.goals.map((g) => el('li', { class: g.done ? 'done' : '' }, g.text)));
    this.faults.replaceChildren(...s.faults.filter((f) => f.count > 0).map((f) => el('li', {}, el('b', {}, String(f.count)), f.text)));
    set_text(this.strands, s.strands_left === null ? '' : `Strands left  ${s.strands_left}${s.strands_total === null ? '' : ` of ${s.strands_total}`}`);
    if (s.state === 'done' || s.state === 'failed') {
      set_text(this.message, s.message || (s.state === 'done' ? 'Exercise complete' : 'Exercise failed'));
      this.message.dataset.kind = s.state === 'done' ? 'goal' : 'fault';
      this.message.classList.add('on');
      this.message_until = 0;
    }
  }
}
