// SPDX-License-Identifier: GPL-3.0-or-later
// A clip of the library is laid over the neck of the built case. It is seen on the surface and closed by the simulator,
// and what it leaves is told. The next build takes it.
import { el, setText } from '../../hud/dom';
import { fixed } from '../../languages/numbers';
import { said } from '../../languages/said';
import { text } from '../../languages/text';
import type { Project } from '../api';
import type { Asks } from '../editor';
import { field } from '../fields';
import type { SurfaceView } from '../surface_view';
import { forThePage } from '../wording';
import { clipMarks } from './clip_marks';
import type { Found } from './trial';

/** As the case builder allows them. */
const ranges = { lift_mm: [-10, 10, 0.5], slide_mm: [-15, 15, 0.5], turn_deg: [-180, 180, 5] } as const;
type Move = keyof typeof ranges;
const soundFlow = 90; // %, as in the report

export class ClipPanel {
  readonly root: HTMLElement;
  private readonly clip = el('select', {});
  private readonly moves: Record<Move, HTMLInputElement>;
  private readonly run = el('button', { type: 'button', class: 'main' }, text('Close this clip'));
  private readonly cancel = el('button', { type: 'button' }, text('Cancel'));
  private readonly proposed = el('button', { type: 'button' }, text('As proposed'));
  private readonly say = el('p', { class: 'say', role: 'status' });
  private readonly facts = el('table', {});
  private library = '';

  constructor(
    asks: Asks,
    private readonly view: SurfaceView,
  ) {
    const move = (name: Move) => {
      const [min, max, step] = ranges[name].map(String);
      const input = el('input', { type: 'number', min: min!, max: max!, step: step! });
      input.onchange = () => asks.choose({ [name]: input.value === '' ? null : Number(input.value) });
      return input;
    };
    this.moves = { lift_mm: move('lift_mm'), slide_mm: move('slide_mm'), turn_deg: move('turn_deg') };
    this.clip.onchange = () => asks.choose({ clip: this.clip.value });
    this.proposed.onclick = () => asks.choose({ clip: '', lift_mm: null, slide_mm: null, turn_deg: null });
    this.run.onclick = () => {
      asks.toSurface();
      void asks.act('try');
    };
    this.cancel.onclick = () => void asks.act('cancel');
    this.root = el(
      'section',
      { class: 'clip' },
      el('h3', {}, text('7. Try a clip')),
      el('p', { class: 'hint' }, text('An empty number is chosen by the program. The next build takes this clip.')),
      field(text('Clip'), this.clip),
      field(text('Higher over the neck, mm'), this.moves.lift_mm),
      field(text('Deeper, away from you, mm'), this.moves.slide_mm),
      field(text('Turned about the dome, degrees'), this.moves.turn_deg),
      el('div', { class: 'buttons' }, this.run, this.cancel, this.proposed),
      this.say,
      this.facts,
    );
  }

  show({ built, choices, trial }: Project): void {
    this.root.hidden = !built || built.clips.length === 0;
    if (!built || this.root.hidden) return this.view.showClip([]);
    this.fillLibrary(built.clips);
    this.clip.value = choices.clip;
    const [lift, slide, turn] = [choices.liftMm, choices.slideMm, choices.turnDeg].map((v) => v ?? '');
    this.moves.lift_mm.value = String(lift);
    this.moves.slide_mm.value = String(slide);
    this.moves.turn_deg.value = String(turn);
    const runs = trial.work.state === 'running';
    this.run.disabled = runs || built.number === '';
    this.cancel.hidden = !runs;
    const found = runs ? null : trial.found;
    this.facts.hidden = !found;
    if (found) this.tell(found);
    setText(this.say, this.words(trial.work.state, trial.work.error, trial.current));
    this.view.showClip(found ? clipMarks(found) : []);
  }

  private fillLibrary(clips: readonly { name: string; bladeMm: number }[]): void {
    const now = JSON.stringify(clips);
    if (now === this.library) return;
    this.library = now;
    this.clip.replaceChildren(
      el('option', { value: '' }, text('chosen by the program')),
      ...clips.map((c) =>
        el('option', { value: c.name }, text('{name}, blade {mm} mm', { name: c.name, mm: fixed(c.bladeMm, 1) })),
      ),
    );
  }

  private words(state: string, error: string, current: boolean): string {
    switch (state) {
      case 'running':
        return text('The clip is being closed …');
      case 'done':
        return current ? '' : text('Tried with other choices: close the clip again.');
      case 'failed':
        return forThePage(error);
      default:
        return '';
    }
  }

  private tell(found: Found): void {
    const row = (what: string, value: string, good: boolean) =>
      el('tr', {}, el('th', { scope: 'row' }, what), el('td', { class: good ? '' : 'bad' }, value));
    const place = [found.liftMm, found.slideMm].map((mm) => fixed(mm, 1)).join(' / ');
    this.facts.replaceChildren(
      el(
        'tbody',
        {},
        row(text('Tried'), `${found.clip}, ${place} mm, ${fixed(found.turnDeg, 0)}°`, true),
        row(text('Remnant (Sindou grade)'), String(found.grade), found.grade <= 1),
        row(text('Neck left open'), `${fixed(found.remnantPct, 0)} %`, found.remnantPct < 25),
        ...found.flows.map(([name, pct]) =>
          row(
            text('Flow of {branch}', { branch: said(name.replaceAll('_', ' ')) }),
            `${fixed(pct, 0)} %`,
            pct >= soundFlow,
          ),
        ),
        ...[found.told, ...found.notes]
          .filter((words) => words !== '')
          .map((words) => row(text('To be looked at'), forThePage(words), false)),
      ),
    );
  }
}
