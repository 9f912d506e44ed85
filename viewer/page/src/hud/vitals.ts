// SPDX-License-Identifier: GPL-3.0-or-later
// The patient's monitor: heartbeat, with a soft beep if wanted, pressure and flow of each branch, and the bleeding.
import { el, set_text } from './dom';
import type { BloodState, VesselView } from './state';

/** Flow that is left decides the colour; a sac is meant to lose it. */
export function flow_level(v: Pick<VesselView, 'id' | 'flow_percent'>): 'good' | 'high' | 'too_much' | 'none' {
  if (v.flow_percent === null || v.id === 'sac' || v.id === 'bleb' || v.id === 'tear') return 'none';
  return v.flow_percent >= 80 ? 'good' : v.flow_percent >= 50 ? 'high' : 'too_much';
}

/** Rounded, and a trickle backwards is 0, not -0. */
export const whole = (value: number): string => String(Math.round(value) || 0);

export class Vitals {
  readonly root = el('section', { class: 'panel vitals' });
  private readonly beat = el('span', { class: 'beat', title: 'heartbeat' }, '♥');
  private readonly rate = el('span', { class: 'rate' });
  private readonly blood = el('div', { class: 'blood' });
  private readonly table = el('table');
  private readonly sound = el('button', { title: 'beep with the heart (M)', 'aria-pressed': 'false' }, '♪');
  private readonly rows = new Map<string, { row: HTMLElement; pressure: HTMLElement; flow: HTMLElement; bar: HTMLElement; percent: HTMLElement }>();
  private phase: number | null = null;
  private beats: number[] = [];
  private audio: AudioContext | null = null;
  private loud = false;

  constructor() {
    this.sound.onclick = () => { this.toggle_sound(); this.sound.blur(); };
    this.root.append(el('header', {}, el('span', {}, this.beat, this.rate), this.blood, this.sound), this.table);
    this.root.hidden = true;
  }

  clear(): void {
    this.rows.clear();
    this.table.replaceChildren();
    this.phase = null;
    this.beats = [];
    this.root.hidden = true;
  }

  toggle_sound(): void {
    this.loud = !this.loud;
    this.sound.setAttribute('aria-pressed', String(this.loud));
    if (this.loud) this.audio ??= new AudioContext();
  }

  show(phase: number | null, vessels: readonly VesselView[], blood: BloodState | null, time_s: number): void {
    this.root.hidden = vessels.length === 0 && phase === null;
    if (this.root.hidden) return;
    if (phase !== null) {
      if (this.phase !== null && phase < this.phase - 0.5) this.on_beat(time_s);
      this.phase = phase;
      this.beat.style.transform = `scale(${(1 + 0.35 * Math.exp(-phase * 6)).toFixed(3)})`;
    }
    for (const v of vessels) this.show_vessel(v);
    const bleeding = blood && (blood.open || blood.lost_mL > 0.05);
    set_text(this.blood, bleeding ? `${blood.open ? `bleeding ${blood.rate_mL_min.toFixed(0)} mL/min · ` : ''}lost ${blood.lost_mL.toFixed(1)} mL` : '');
    this.blood.classList.toggle('open', !!blood?.open);
  }

  private on_beat(time_s: number): void {
    this.beats = [...this.beats.filter((t) => t < time_s), time_s].slice(-6);
    const n = this.beats.length;
    // At a few pictures a second beats are missed: then no number is better than a wrong one.
    const rate = n > 2 ? (60 * (n - 1)) / Math.max(0.1, this.beats[n - 1]! - this.beats[0]!) : 0;
    set_text(this.rate, rate > 30 && rate < 220 ? `${Math.round(rate)} /min` : '');
    if (this.loud && this.audio) beep(this.audio);
  }

  private show_vessel(v: VesselView): void {
    let w = this.rows.get(v.id);
    if (!w) {
      const pressure = el('td'), flow = el('td'), percent = el('td'), bar = el('i');
      w = { pressure, flow, bar, percent, row: el('tr', { 'data-vessel': v.id }, el('th', {}, v.id.replace(/_/g, ' ')), pressure, flow, el('td', { class: 'line' }, bar), percent) };
      if (this.rows.size === 0) this.table.append(el('tr', { class: 'units' }, el('th'), el('td', {}, 'mmHg'), el('td', {}, 'mL/min'), el('td'), el('td', {}, '% rest')));
      this.rows.set(v.id, w);
      this.table.append(w.row);
    }
    set_text(w.pressure, whole(v.pressure_mmHg));
    set_text(w.flow, whole(v.flow_mL_min));
    set_text(w.percent, v.flow_percent === null ? '–' : whole(v.flow_percent));
    w.bar.style.width = `${Math.max(0, Math.min(100, v.flow_percent ?? 0))}%`;
    w.row.dataset.level = flow_level(v);
  }
}

function beep(audio: AudioContext): void {
  const tone = audio.createOscillator(), loudness = audio.createGain();
  tone.frequency.value = 620;
  loudness.gain.setValueAtTime(0, audio.currentTime);
  loudness.gain.linearRampToValueAtTime(0.05, audio.currentTime + 0.01);
  loudness.gain.exponentialRampToValueAtTime(0.0005, audio.currentTime + 0.11);
  tone.connect(loudness).connect(audio.destination);
  tone.start();
  tone.stop(audio.currentTime + 0.12);
}
