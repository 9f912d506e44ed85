// SPDX-License-Identifier: GPL-3.0-or-later
// Puts the page together: connection, scene, microscope, hands, HUD, and the loop that draws.
import * as THREE from 'three';
import { bannerText } from './banner';
import { loadBundle } from './bundle';
import type { Bundle } from './bundle_types';
import { Connection } from './connection';
import { Graphics } from './graphics';
import { toolInHand } from './hand_tool';
import { Hands } from './hands';
import { Headset } from './headset';
import type { UserCommand } from './hud/commands';
import { Hud } from './hud/hud';
import './hud/hud.css';
import './hud/hands.css';
import './hud/panels.css';
import './hud/vitals.css';
import './hud/instructor.css';
import { timeLeftText } from './hud/timers';
import type { HapticStatus, SceneInfo } from './lcm';
import { Highlight, middle } from './inventory';
import { parseOptions } from './options';
import { Playback } from './playback';
import { levels, QualityWatch } from './quality';
import { silent } from './silence';
import { Stage } from './stage';
import { status } from './status';
import { Reading } from './step_data/reading';
import { ViewModes } from './view_modes';
import { quaternion, vector, World } from './world';

const options = parseOptions(location.search);
const mayDrive = options.role === 'trainee';
const mayCommand = options.role !== 'observer';
const stage = new Stage(document.getElementById('view') as HTMLCanvasElement);
const { canvas, scene, scope } = stage;
const highlight = new Highlight();
scene.add(highlight.root);
const playback = new Playback();
const reading = new Reading();
let world: World | null = null;
let info: SceneInfo | null = null;
let haptic: HapticStatus | null = null;
/** When each stream was last heard. */
const heard = { haptic: 0, info: 0, frame: -1e9 };
let watch = new QualityWatch(options.quality);
let loadError = '';
let frozen = false;
let spokenTo = '';

const hudRoot = document.getElementById('hud')!;
hudRoot.hidden = !options.hud;
const wsUrl = new URL('ws', location.href);
wsUrl.protocol = wsUrl.protocol === 'https:' ? 'wss:' : 'ws:';
wsUrl.search = `?role=${options.role}`; // the gateway takes from a page what its role may send

const link = new Connection(wsUrl.href, {
  frame: (m) => {
    if (!world || world.bundle.session !== m.session.toString()) return;
    heard.frame = performance.now();
    if (frozen) return;
    playback.push(m, performance.now());
    if (options.freezeAtS !== null && m.sim_time_s >= options.freezeAtS) frozen = status.frozen = true;
  },
  scene: (m) => {
    info = m;
    heard.info = performance.now();
    void follow(m);
  },
  event: (m) => {
    if (m.kind === 'message') spokenTo = m.text;
    hud.showEvent(m, performance.now());
  },
  haptic: (m) => {
    haptic = m;
    heard.haptic = performance.now();
  },
  devices: () => undefined,
  state: (open) => {
    status.connected = open;
    if (open) return;
    info = null;
    hands.releaseAll();
  },
});

const run = (c: UserCommand) => {
  if (mayCommand) link.sendCommand(c.command, c.argument);
};
const hud = new Hud(
  hudRoot,
  {
    run,
    stereo: (mode) => modes.setStereo(mode, true),
    angle: (deg) => modes.setAngle(deg),
    infrared: (on) => modes.setInfrared(on),
    quality: (name) => {
      watch = new QualityWatch(name === '' ? null : (name as 'low'));
      applyQuality();
    },
    chooseHand: (h) => hands.setActive(h),
    releaseHand: (h) => hands.release(h),
    button: (b, on) => hands.press(b, on),
    chooseItem: (item) => {
      highlight.show(item);
      const at = item && middle(item);
      if (at) scope.focus(at);
    },
  },
  options.role,
  options.quality ?? '',
);
const headset: Headset = new Headset(stage.renderer, () => modes.setStereo('off'));
const modes: ViewModes = new ViewModes(options, headset, {
  infrared: (on) => {
    status.infrared = on;
    stage.setInfrared(on);
    world?.setInfrared(on);
    hud.view.showInfrared(on);
  },
  stereo: (mode, angle, found, presenting) => {
    hudRoot.dataset.stereo = status.stereo = mode;
    hud.view.showStereo(mode, angle, found, presenting);
  },
  refuse: (why) => hud.refuse(why, performance.now()),
});

const hands: Hands = new Hands(
  canvas,
  scope,
  link,
  {
    toolPose: (hand) => {
      const t = playback.latest && world ? toolInHand(playback.latest, world.bundle, hand) : null;
      return t ? { p: vector(t.p_m), q: quaternion(t.q) } : null;
    },
  },
  {
    focusAt: (x, y) => {
      if (world) stage.focusAt(x, y);
    },
    togglePause: () => run({ command: playback.latest?.paused ? 'resume' : 'pause', argument: '' }),
    toggleHelp: () => hud.toggleHelp(),
    nextTool: (hand, step) => hud.nextTool(hand, step),
    changed: () => {
      status.taken = hands.hands.map((h) => h.taken);
      status.active = hands.active;
    },
  },
  mayDrive,
);

let depthShown = options.depth;
const shortcuts: Record<string, () => void> = {
  KeyU: () => (depthShown = !depthShown),
  KeyL: () => hud.toolList.toggle(),
  KeyI: () => modes.setInfrared(!modes.infrared),
  KeyJ: () => hud.view.askGlow(),
  KeyO: () => modes.nextStereo(),
  KeyM: () => hud.vitals.toggleSound(),
  BracketLeft: () => modes.setAngle(modes.angleDeg - 0.5),
  BracketRight: () => modes.setAngle(modes.angleDeg + 0.5),
};

window.addEventListener('keydown', (e) => {
  const typing = e.target instanceof HTMLInputElement || e.target instanceof HTMLSelectElement;
  if (e.repeat || e.ctrlKey || e.metaKey || e.altKey || typing) return;
  shortcuts[e.code]?.();
});

function build(bundle: Bundle): void {
  world?.dispose();
  world = null;
  const room = stage.light(vector(bundle.view.up));
  const from = performance.now();
  world = new World(bundle, scope.fieldAxis, room);
  status.build_ms = Math.round(performance.now() - from);
  scene.add(world.root);
  world.setInfrared(modes.infrared);
}

// Steel would have nothing to mirror and be black.
const graphics = new Graphics(canvas, () => {
  if (world) build(world.bundle);
});

/** Loads the bundle of a new session, once; tries again when it fails. */
let loading = '';
async function follow(m: SceneInfo): Promise<void> {
  const session = m.session.toString();
  if (m.state === 'loading' || m.state === 'error' || session === loading || world?.bundle.session === session) return;
  loading = session;
  try {
    const bundle = await loadBundle(new URL(`bundle/${session}/`, location.href).href, session);
    playback.clear();
    hands.releaseAll();
    scope.setHome(bundle.view);
    build(bundle);
    reading.begin(bundle);
    applyQuality();
    hud.showScene(bundle);
    status.session = session;
    loadError = status.error = '';
  } catch (e) {
    loadError = status.error = e instanceof Error ? e.message : String(e);
    await new Promise((r) => setTimeout(r, 1500));
  }
  loading = '';
}

function applyQuality(): void {
  const level = levels[watch.level]!;
  status.quality = level.name;
  stage.setLevel(level);
  headset.configure(level.lens, 0.75 * level.pixelRatio);
  world?.setCheap(level.name === 'low');
}

function headsetLines(): string[] {
  const timers = (reading.state?.timers ?? []).filter((t) => t.running).map((t) => `${t.text} ${timeLeftText(t)}`);
  return ['For training only. Not for patient care.', timers.join('     '), spokenTo];
}

const pace = { last: performance.now(), counted: 0, from: performance.now() };

/** Counts pictures; once a second the quality follows their rate. */
function countPicture(now: number): void {
  if (!graphics.lost) {
    pace.counted++;
    status.pictures++;
  }
  if (now - pace.from <= 1000) return;
  const seconds = (now - pace.from) / 1000;
  status.fps = pace.counted / seconds;
  pace.counted = 0;
  pace.from = now;
  // A hidden tab draws rarely by design; loading stalls are no sign of a slow machine either.
  const counts = status.ready && document.visibilityState === 'visible' && !graphics.lost;
  if (counts && watch.observe(status.fps, seconds)) applyQuality();
}

function draw(now: number): void {
  const pictureMs = Math.max(0, now - pace.last);
  pace.last = now;
  const presenting = headset.presenting;
  stage.update(Math.min(0.1, pictureMs / 1000), modes.stereo, presenting);
  reading.read(playback.latest);
  world?.update(playback, now, reading.channels, scope.percentRight());
  world?.showDepth(depthShown);
  status.tip_mm = world?.tipDistancesMm ?? [];
  const angle = THREE.MathUtils.degToRad(modes.angleDeg);
  if (presenting) headset.render(scene, scope.camera, scope.distance, angle, headsetLines());
  else stage.render(modes.stereo, angle);
  status.presenting = presenting;
  status.triangles = stage.triangles;
  status.calls = stage.calls;
  status.graphics_lost = graphics.lost;
  status.frames = playback.frames;
  status.refused = link.refused;
  status.problems = [...(reading.problem ? [reading.problem] : []), ...(world?.problems ?? [])];
  status.ready = world !== null && playback.frames > 0;
  countPicture(now);
  if (options.hud) showHud(now, (heardMs, limitMs) => silent(now, heardMs, limitMs, pictureMs));
}

function showHud(now: number, quiet: (heardMs: number, limitMs: number) => boolean): void {
  const frame = playback.latest;
  const { channels, state } = reading;
  const active = mayDrive ? hands.active : -1;
  if (frame && world) hud.showFrame({ frame, channels, state, active, taken: hands.hands.map((h) => h.taken) });
  const freshHaptic = quiet(heard.haptic, 3000) ? null : haptic;
  hud.showMachine(quiet(heard.frame, 2500) ? null : frame, freshHaptic, status.fps, status.quality);
  const alive = link.open && !quiet(heard.frame, 1000);
  hud.showLink(link.open ? (alive ? 'connected' : 'gateway only') : 'disconnected', alive);
  hud.showBanner(
    bannerText({
      graphics: graphics.lost ? graphics.notice(now) : '',
      connected: link.open,
      info,
      infoQuiet: quiet(heard.info, 4000),
      framesQuiet: quiet(heard.frame, 2500),
      loadError,
      built: world !== null,
      frames: playback.frames,
      paused: frame?.paused ?? false,
      still: world?.bundle.inventory != null,
    }),
  );
  hud.showNotice(info && info.state !== 'error' ? info.message : '');
  hud.showProblems(status.problems);
  hud.tick(now);
}

// Hands keep their own time: a slow picture must not make them slow.
let handsLast = performance.now();
setInterval(() => {
  const now = performance.now();
  hands.update(Math.min(0.1, (now - handsLast) / 1000), now);
  handsLast = now;
}, 1000 / 60);

applyQuality();
modes.tell();
// three's own loop: it goes on in a headset, where the window's stands still.
stage.renderer.setAnimationLoop(draw);
