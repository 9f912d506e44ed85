// SPDX-License-Identifier: GPL-3.0-or-later
// The tools of another run as ghosts over a field: where they were at the same time of its exercise.
import type { Bundle } from '../bundle_types';
import { GhostTools } from '../ghost_tools';
import { toolState } from '../hand_tool';
import { quaternion, vector } from '../world';
import type { Moment } from './pictures';
import type { RecordedSession } from './session';

export class RunGhost {
  private readonly ghosts = new GhostTools(0xffc46b);
  readonly root = this.ghosts.root;
  /** Index of a tool in this scene by its id. */
  private indexOf = new Map<string, number>();
  /** Ids of the recorded tools by their index. */
  private idOf: Map<number, string>;
  private readonly beganS: number;
  private field: Bundle | null = null;
  /** What is drawn, and whether a later one is being read. */
  private moment: Moment | null = null;
  private reading = false;

  /** recorded: the recording's bundle. */
  constructor(
    private readonly session: RecordedSession,
    recorded: Bundle,
  ) {
    this.idOf = new Map(recorded.tools.map((t) => [t.index, t.id]));
    this.beganS = session.timeline.passesS[0] ?? 0;
  }

  /** Shows it in a field. timeS: of the exercise. Nothing is shown after the end of the other run. */
  show(bundle: Bundle, timeS: number): void {
    if (bundle !== this.field) this.begin(bundle);
    this.ghosts.hide();
    if (!this.reading) void this.read(this.beganS + timeS);
    const { moment } = this;
    if (!moment) return;
    for (const b of moment.after.frame.tool) {
      const index = this.indexOf.get(this.idOf.get(b.index) ?? '');
      if (index === undefined || b.state === toolState.onTray) continue;
      const a = moment.before.frame.tool.find((t) => t.index === b.index) ?? b;
      const from = a.state === toolState.onTray ? b : a;
      const p = vector(from.p_m).lerp(vector(b.p_m), moment.share);
      const q = quaternion(from.q).slerp(quaternion(b.q), moment.share);
      this.ghosts.place({ index, opening_rad: b.opening_rad }, p, q);
    }
  }

  /** Number of its tools in the field. */
  get shown(): number {
    return this.ghosts.shown;
  }

  /** atS: of the recording. */
  private async read(atS: number): Promise<void> {
    this.reading = true;
    try {
      this.moment = atS <= this.session.durationS ? await this.session.pictures.at(atS) : null;
    } catch {
      // The recording cannot be read any more; the ghost is not essential.
      this.moment = null;
    } finally {
      this.reading = false;
    }
  }

  private begin(bundle: Bundle): void {
    this.field = bundle;
    this.ghosts.begin(bundle);
    this.indexOf = new Map(bundle.tools.map((t) => [t.id, t.index]));
  }
}
