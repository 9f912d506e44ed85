// SPDX-License-Identifier: GPL-3.0-or-later
// Puts the page together: connection, scene, microscope, hands, HUD, and the loop that draws.
import * as THREE from 'three';
import { BundleFolder, loadBundle } from './bundle';
import type { Bundle } from './bundle_types';
import { browserStore } from './browser_store';
import { Connection, socketUrl } from './connection';
import { ControllerHands } from './controller_hands';
import { Expected } from './expected';
import { Graphics } from './graphics';
import { Guiding } from './guiding';
import { listenForHands } from './hand_inputs';
import { toolInHand } from './hand_tool';
import { Hands } from './hands';
import { Headset } from './headset';
import { keptQuality } from './kept_quality';
import type { UserCommand } from './hud/commands';
import { Hud } from './hud/hud';
import { parseMetrics } from './hud/metrics';
import { showHud } from './show_hud';
import './hud/styles';
import { headsetLines } from './hud/timers';
import type { HapticStatus, SceneInfo } from './lcm';
import { Highlight, middle } from './inventory';
import { parseOptions, type QualityName } from './options';
import { Pace } from './pace';
import { Playback } from './playback';
import { levels, QualityWatch } from './quality';
import { listenForPageKeys } from './page_keys';
import { silent } from './silence';
import { softwareAdvice } from './software_rendering';
import { Sound } from './sound/sound';
import { Stage } from './stage';
import { status, tellPicture } from './status';
import { GhostOverlay } from './replay/ghost_overlay';
import { RoomDesk } from './room/desk';
import { Reading } from './step_data/reading';
import { ViewModes } from './view_modes';
import { TakeBack } from './take_back';
import { Lessons } from './tutor/lessons';
import { quaternion, vector, World } from './world';

const options = parseOptions(location.search, keptQuality(browserStore()));
const mayDrive = options.role === 'trainee';
const mayCommand = options.role !== 'observer';
const stage = new Stage(document.getElementById('view') as HTMLCanvasElement);
const { canvas, scene, scope } = stage;
const highlight = new Highlight();
const takeBack = new TakeBack();
const guiding = new Guiding();
scene.add(highlight.root, guiding.root);
const playback = new Playback();
const reading = new Reading();
let world: World | null = null;
let [info, haptic]: [SceneInfo | null, HapticStatus | null] = [null, null];
/** When each stream was last heard. */
const heard = { haptic: 0, info: 0, frame: -1e9 };
const slowAdvice = softwareAdvice(stage.renderer.getContext());
const firstLevel: QualityName = slowAdvice === '' ? 'high' : 'draft';
let watch = new QualityWatch(options.quality, firstLevel);
let loadError = '';
let spokenTo = '';

const hudRoot = document.getElementById('hud')!;
hudRoot.hidden = !options.hud;

const link = new Connection(socketUrl(location.href, options.role), {
  frame: (m) => {
    if (!world || world.bundle.session !== m.session.toString()) return;
    heard.frame = performance.now();
    if (status.frozen) return;
    sound.frame(m, heard.frame);
    playback.push(m, performance.now());
    if (options.freezeAtS !== null && m.sim_time_s >= options.freezeAtS) status.frozen = true;
  },
  scene: (m) => {
    info = m;
    heard.info = performance.now();
    void follow(m);
  },
  event: (m) => {
    if (m.kind === 'message') spokenTo = m.text;
    // The hands are at home again; what the mouse held before is not taken back there.
    if (m.kind === 'reset' && !ownReset.met(performance.now())) letHandsGo();
    sound.event(m, performance.now());
    hud.showEvent(m, performance.now());
    lessons.hear(m);
  },
  metrics: (m) => {
    const values = m.session.toString() === world?.bundle.session ? parseMetrics(m.json) : null;
    if (values) hud.showMetrics({ values, atEnd: m.at_end });
  },
  haptic: (m) => {
    haptic = m;
    heard.haptic = performance.now();
  },
  devices: () => undefined,
  room: (m) => room.hear(m),
  state: (open) => {
    status.connected = open;
    if (open) return room.reconnected();
    info = null;
    sound.lost();
    hands.releaseAll();
  },
});

const ownReset = new Expected();
const run = (c: UserCommand) => {
  if (c.command === 'reset' || c.command === 'begin') {
    letHandsGo();
    ownReset.expect(performance.now());
  }
  if (mayCommand) link.sendCommand(c.command, c.argument);
};
const hud = new Hud(
  hudRoot,
  canvas,
  {
    run,
    sound: (change) => sound.choose(change),
    stereo: (mode) => modes.setStereo(mode, true),
    angle: (deg) => modes.setAngle(deg),
    infrared: (on) => modes.setInfrared(on),
    nextRuler: () => modes.nextRuler(),
    quality: (name) => {
      watch = new QualityWatch(name === '' ? null : (name as QualityName), firstLevel);
      applyQuality();
    },
    chooseHand: (h) => hands.setActive(h),
    releaseHand: (h) => hands.release(h),
    button: (b, on) => hands.press(b, on),
    toggleLatch: (h, b) => hands.toggleLatch(h, b),
    holdHere: (h) => hands.holdHere(h),
    stepGuide: (by) => guiding.step(hands.active, by),
    turnToTarget: () => hands.toggleAssist(),
    chooseItem: (item) => {
      highlight.show(item);
      const at = item && middle(item);
      if (at) scope.focus(at);
    },
  },
  options.role,
  options.quality ?? '',
);
const room: RoomDesk = new RoomDesk(stage, hudRoot, () => link, options.role);
const sound: Sound = new Sound(status.sound, () => hud.sound.show(sound.settings, sound.waits));
hud.sound.show(sound.settings, sound.waits);
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
  ruler: (mode) => hud.view.showRuler(mode),
  refuse: (why) => hud.refuse(why, performance.now()),
});

const lessons = new Lessons({ hud, canvas, scene, scope, sound, mayDrive, run });
const toolPose = (hand: number) => {
  const t = playback.latest && world ? toolInHand(playback.latest, world.bundle, hand) : null;
  return t ? { p: vector(t.p_m), q: quaternion(t.q) } : null;
};
const tellHands = () => {
  status.taken = hands.hands.map((h) => h.taken);
  status.buttons = hands.hands.map((h) => [h.button1, h.button2]);
  status.active = hands.active;
};
const hands: Hands = new Hands(scope, link, { toolPose, wanted: (h) => guiding.wanted(h) }, tellHands, mayDrive);
const controllers = new ControllerHands(hands);
listenForHands(hands, {
  ...{ canvas, scope, hud, hudRoot, toolPose, changed: tellHands },
  focusAt: (x, y) => {
    if (world) void stage.focusAt(x, y);
  },
  togglePause: () => run({ command: playback.latest?.paused ? 'resume' : 'pause', argument: '' }),
});

const ghost = new GhostOverlay(options.ghost, scene, (why) => hud.refuse(why, performance.now()));

function letHandsGo(): void {
  hands.releaseAll();
  guiding.restart();
}

listenForPageKeys({ modes, hud, guiding, hands });

function build(bundle: Bundle): void {
  world?.dispose();
  world = null;
  const room = stage.light(vector(bundle.view.up));
  const from = performance.now();
  world = new World(bundle, scope.fieldAxis, room);
  world.shade();
  status.build_ms = Math.round(performance.now() - from);
  scene.add(world.root);
  world.setInfrared(modes.infrared);
  applyQuality();
}

// Steel would have nothing to mirror and be black.
const graphics = new Graphics(canvas, () => {
  if (world) world.setEnvironment(stage.light(vector(world.bundle.view.up)));
});

/** Loads the bundle of a new session, once; tries again when it fails. */
let loading = '';
async function follow(m: SceneInfo): Promise<void> {
  const session = m.session.toString();
  if (m.state === 'loading' || m.state === 'error' || session === loading || world?.bundle.session === session) return;
  loading = session;
  try {
    const bundle = await loadBundle(new BundleFolder(new URL(`bundle/${session}/`, location.href).href), session);
    playback.clear();
    hands.releaseAll();
    guiding.begin(bundle);
    takeBack.begin(bundle);
    scope.setHome(bundle.view);
    build(bundle);
    reading.begin(bundle);
    sound.begin(bundle);
    hud.showScene(bundle);
    room.showScene();
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
  world?.setLevel(level);
}

const pace = new Pace((fps, seconds) => {
  status.fps = fps;
  // A hidden tab draws rarely by design; loading stalls are no sign of a slow machine either.
  const counts = status.ready && document.visibilityState === 'visible' && !graphics.lost;
  if (counts && watch.observe(fps, seconds)) applyQuality();
});

function draw(now: number): void {
  const pictureMs = pace.begin(now);
  const presenting = headset.presenting;
  controllers.move(headset.controllers);
  stage.update(Math.min(0.1, pictureMs / 1000), modes.stereo, presenting);
  reading.read(playback.latest);
  if (reading.state) sound.clocks(reading.state.timers);
  const within = playback.latest ? takeBack.nearest(playback.latest) : null;
  if (world) {
    world.cues.choice = { plumb: modes.depth, ruler: modes.ruler, hand: hands.active, within };
    world.update(playback, now, reading.channels, scope.sight);
    Object.assign(status, world.cues.told);
  }
  status.ghost_tools = ghost.show(world?.bundle ?? null, playback.latest);
  status.target = guiding.update({
    frame: playback.latest,
    bundle: world?.bundle ?? null,
    hand: mayDrive && reading.state?.mode === 'practice' ? hands.active : -1,
    axes: scope.axes(),
  });
  lessons.update(playback.latest, world?.bundle ?? null, reading.state, now);
  const angle = THREE.MathUtils.degToRad(modes.angleDeg);
  if (presenting)
    headset.render(scene, scope.camera, scope.distance, angle, headsetLines(reading.state?.timers ?? [], spokenTo));
  else stage.render(modes.stereo, angle);
  room.draw(modes.stereo, presenting);
  tellPicture({ presenting, stage, graphics, frames: playback.frames, refused: link.refused });
  status.problems = [...(reading.problem ? [reading.problem] : []), ...(world?.problems ?? [])];
  status.ready = world !== null && playback.frames > 0;
  if (!graphics.lost) status.pictures++;
  pace.count(now, !graphics.lost);
  if (!options.hud) return;
  const quiet = (heardMs: number, limitMs: number) => silent(now, heardMs, limitMs, pictureMs);
  const active = mayDrive ? hands.active : -1;
  const picture = {
    world,
    within,
    frame: playback.latest,
    reading,
    active,
    hands: hands.view(),
    guide: guiding.view,
    assisted: hands.assisted,
  };
  const graphicsLost = graphics.lost ? graphics.notice(now) : '';
  showHud(hud, picture, { link, info, haptic, heard, loadError, graphicsLost, frames: playback.frames }, now, quiet);
}

hands.start();
applyQuality();
modes.tell();
canvas.focus({ preventScroll: true });
hud.advise(slowAdvice);
// three's own loop: it goes on in a headset, where the window's stands still.
stage.renderer.setAnimationLoop(draw);
