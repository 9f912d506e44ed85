// SPDX-License-Identifier: GPL-3.0-or-later
// Puts the page together: connection, scene, microscope, hands, HUD, and the loop that draws.
import * as THREE from 'three';
import { type Bundle, load_bundle } from './bundle';
import { Microscope } from './camera';
import { Connection } from './connection';
import { Graphics } from './graphics';
import { tool_in_hand } from './hand_tool';
import { Hands } from './hands';
import { Headset } from './headset';
import { ask, find_command, type UserCommand } from './hud/commands';
import { Hud } from './hud/hud';
import './hud/hud.css';
import { type HudState, parse_hud } from './hud/state';
import { time_left_text } from './hud/timers';
import type { HapticStatus, SceneInfo } from './lcm';
import { Highlight, middle } from './inventory';
import { Lens } from './lens';
import { make_environment } from './materials/environment';
import { parse_options } from './options';
import { Playback } from './playback';
import { levels, QualityWatch } from './quality';
import { silent } from './silence';
import { ViewModes } from './view_modes';
import { quaternion, vector, World } from './world';

const options = parse_options(location.search);
const canvas = document.getElementById('view') as HTMLCanvasElement;
const may_drive = options.role === 'trainee';
const may_command = options.role !== 'observer';
const shortcuts: Record<string, () => void> = {
  KeyL: () => hud.clips.toggle(),
  KeyI: () => modes.set_infrared(!modes.infrared),
  KeyJ: () => inject_dye(),
  KeyO: () => modes.next_stereo(),
  KeyM: () => hud.vitals.toggle_sound(),
  BracketLeft: () => modes.set_angle(modes.angle_deg - 0.5),
  BracketRight: () => modes.set_angle(modes.angle_deg + 0.5),
};

const renderer = make_renderer();
renderer.toneMapping = THREE.ACESFilmicToneMapping;
renderer.toneMappingExposure = 1.0;
renderer.shadowMap.type = THREE.PCFSoftShadowMap;
renderer.debug.onShaderError = (gl, program, vs, fs) => {
  console.error('shader:', gl.getProgramInfoLog(program), gl.getShaderInfoLog(vs), gl.getShaderInfoLog(fs));
};
const scene = new THREE.Scene();
/** What is seen through a gap between the tissues: the depth of the field, not a hole. */
const depths = { eye: new THREE.Color(0x38100c), infrared: new THREE.Color(0x020303) };
scene.background = depths.eye;
scene.environmentIntensity = 0.42;
const highlight = new Highlight();
scene.add(highlight.root);
const scope = new Microscope();
scope.add_to(scene);
const lens = new Lens(renderer);
const playback = new Playback();
let world: World | null = null;
let info: SceneInfo | null = null;
let haptic: HapticStatus | null = null;
let haptic_ms = 0;
let info_ms = 0;
let frame_ms = -1e9;
let watch = new QualityWatch(options.quality);
let load_error = '';
let frozen = false;
/** What the newest frame's hud_json says. */
let state: HudState | null = null;
let state_text = '';
let spoken_to = '';

const status = {
  ready: false, frames: 0, pictures: 0, fps: 0, session: '', quality: '', connected: false, frozen: false, refused: 0, error: '',
  build_ms: 0, taken: [false, false], active: 1, triangles: 0, stereo: 'off', infrared: false, presenting: false, graphics_lost: false,
};
(window as unknown as { __insula: typeof status }).__insula = status;

const hud_root = document.getElementById('hud')!;
hud_root.hidden = !options.hud;
const ws_url = new URL('ws', location.href);
ws_url.protocol = ws_url.protocol === 'https:' ? 'wss:' : 'ws:';
ws_url.search = `?role=${options.role}`;  // the gateway takes from a page what its role may send

const link = new Connection(ws_url.href, {
  frame: (m) => {
    if (!world || world.bundle.session !== m.session.toString()) return;
    frame_ms = performance.now();
    if (frozen) return;
    playback.push(m, performance.now());
    if (options.freeze_at_s !== null && m.sim_time_s >= options.freeze_at_s) frozen = status.frozen = true;
  },
  scene: (m) => { info = m; info_ms = performance.now(); void follow(m); },
  event: (m) => {
    if (m.kind === 'message') spoken_to = m.text;
    hud.show_event(m, performance.now());
  },
  haptic: (m) => { haptic = m; haptic_ms = performance.now(); },
  devices: () => undefined,
  state: (open) => { status.connected = open; if (!open) { info = null; hands.release_all(); } },
});

const run = (c: UserCommand) => { if (may_command) link.send_command(c.command, c.argument); };
const hud = new Hud(hud_root, {
  run,
  stereo: (mode) => modes.set_stereo(mode, true),
  angle: (deg) => modes.set_angle(deg),
  infrared: (on) => modes.set_infrared(on),
  inject_dye,
  quality: (name) => { watch = new QualityWatch(name === '' ? null : (name as 'low')); apply_quality(); },
  choose_hand: (h) => hands.set_active(h),
  release_hand: (h) => hands.release(h),
  button: (b, on) => hands.press(b, on),
  choose_item: (item) => {
    highlight.show(item);
    const at = item && middle(item);
    if (at) scope.focus(at);
  },
}, options.role, options.quality ?? '');
const headset: Headset = new Headset(renderer, () => modes.set_stereo('off'));
const modes: ViewModes = new ViewModes(options, headset, {
  infrared: (on) => { status.infrared = on; scene.background = on ? depths.infrared : depths.eye; world?.set_infrared(on); hud.view.show_infrared(on); },
  stereo: (mode, angle, found, presenting) => { hud_root.dataset.stereo = status.stereo = mode; hud.view.show_stereo(mode, angle, found, presenting); },
  refuse: (why) => hud.refuse(why, performance.now()),
});

const hands: Hands = new Hands(canvas, scope, link, {
  tool_pose: (hand) => {
    const t = playback.latest && world ? tool_in_hand(playback.latest, world.bundle, hand) : null;
    return t ? { p: vector(t.p_m), q: quaternion(t.q) } : null;
  },
}, {
  focus_at,
  toggle_pause: () => { if (may_command) link.send_command(playback.latest?.paused ? 'resume' : 'pause'); },
  toggle_help: () => hud.toggle_help(),
  next_tool: (hand, step) => hud.next_tool(hand, step),
  changed: () => {
    status.taken = hands.hands.map((h) => h.taken);
    status.active = hands.active;
  },
}, may_drive);

function build(bundle: Bundle): void {
  world?.dispose();
  world = null;
  const old = scene.environment;
  scene.environment = make_environment(renderer, scope.field_axis, vector(bundle.view.up));
  old?.dispose();
  const from = performance.now();
  world = new World(bundle, scope.field_axis, scene.environment);
  status.build_ms = Math.round(performance.now() - from);
  scene.add(world.root);
  world.set_infrared(modes.infrared);
}

// Steel would have nothing to mirror and be black.
const graphics = new Graphics(canvas, () => { if (world) build(world.bundle); });

/** Loads the bundle of a new session, once; tries again when it fails. */
let loading = '';
async function follow(m: SceneInfo): Promise<void> {
  const session = m.session.toString();
  if (m.state === 'loading' || m.state === 'error' || session === loading || world?.bundle.session === session) return;
  loading = session;
  try {
    const bundle = await load_bundle(new URL(`bundle/${session}/`, location.href).href, session);
    playback.clear();
    hands.release_all();
    scope.set_home(bundle.view);
    build(bundle);
    state = null;
    state_text = '';
    apply_quality();
    hud.show_scene(bundle);
    status.session = session;
    load_error = status.error = '';
  } catch (e) {
    load_error = status.error = e instanceof Error ? e.message : String(e);
    await new Promise((r) => setTimeout(r, 1500));
  }
  loading = '';
}

function apply_quality(): void {
  const level = levels[watch.level]!;
  status.quality = level.name;
  renderer.setPixelRatio(Math.min(window.devicePixelRatio * Math.min(1, level.pixel_ratio), level.pixel_ratio));
  lens.configure(level.lens);
  headset.configure(level.lens, 0.75 * level.pixel_ratio);
  world?.set_cheap(level.name === 'low');
  const shadow = scope.lamp.shadow;
  const shadows = level.shadow_size > 0;
  if (renderer.shadowMap.enabled !== shadows) {
    renderer.shadowMap.enabled = shadows;
    scene.traverse((o) => { if (o instanceof THREE.Mesh) (o.material as THREE.Material).needsUpdate = true; });
  }
  scope.lamp.castShadow = shadows;
  if (shadows && shadow.mapSize.x !== level.shadow_size) {
    shadow.mapSize.set(level.shadow_size, level.shadow_size);
    shadow.map?.dispose();
    shadow.map = null;
  }
}

/** The point under the pointer becomes the focus. */
function focus_at(x: number, y: number): void {
  if (!world) return;
  const point = lens.pick(x, y, canvas.clientWidth, canvas.clientHeight);
  if (point) scope.focus(point);
}

function inject_dye(): void {
  const found = world && find_command(world.bundle.commands, 'inject_dye');
  if (found) run(ask(found.id, 'inject_dye'));
}

window.addEventListener('keydown', (e) => {
  if (e.repeat || e.ctrlKey || e.metaKey || e.altKey || e.target instanceof HTMLInputElement || e.target instanceof HTMLSelectElement) return;
  shortcuts[e.code]?.();
});

/** Reads hud_json again when it has changed. */
function read_state(): void {
  const f = playback.latest;
  if (!f || f.hud_json === state_text) return;
  state_text = f.hud_json;
  state = parse_hud(f.hud_json) ?? state;
}

function headset_lines(): string[] {
  const timers = (state?.timers ?? []).filter((t) => t.running).map((t) => `${t.text} ${time_left_text(t)}`);
  return ['For training only. Not for patient care.', timers.join('     '), spoken_to];
}

function banner(now_ms: number, quiet: (heard_ms: number, limit_ms: number) => boolean): string {
  // It explains the empty picture, whatever else is amiss.
  if (graphics.lost) return graphics.notice(now_ms);
  if (!link.open) return 'Viewer gateway not reached\ntrying again …';
  // Pictures are a sign of life too: on a slow machine they crowd out the second's word of the scene.
  if (!info || (quiet(info_ms, 4000) && quiet(frame_ms, 2500))) return 'Waiting for the engine …';
  if (info.state === 'error') return `The scene has errors\n${info.message}`;
  if (load_error) return `Scene data cannot be read\n${load_error}`;
  if (!world || info.state === 'loading') return 'Loading the scene …';
  if (playback.frames === 0 || quiet(frame_ms, 2500)) return info.state === 'ended' ? 'The session has ended' : 'No pictures from the engine: waiting for it to come back …';
  return playback.latest?.paused && !world.bundle.inventory ? 'Paused' : '';
}

function make_renderer(): THREE.WebGLRenderer {
  try {
    return new THREE.WebGLRenderer({ canvas, antialias: false, powerPreference: 'high-performance' });
  } catch (e) {
    document.body.textContent = 'This browser offers no WebGL 2, which the picture needs. Switch on hardware acceleration or use another browser.';
    throw e;
  }
}

let last = performance.now();
let counted = 0;
let counted_from = last;

function draw(now: number): void {
  const picture_ms = Math.max(0, now - last), dt = Math.min(0.1, picture_ms / 1000);
  const quiet = (heard_ms: number, limit_ms: number) => silent(now, heard_ms, limit_ms, picture_ms);
  last = now;
  const presenting = headset.presenting;
  const wide = canvas.clientWidth, high = canvas.clientHeight;
  const size = renderer.getSize(new THREE.Vector2());
  if (!presenting && (size.x !== wide || size.y !== high)) renderer.setSize(wide, high, false);
  const halves = modes.stereo === 'sbs' && !presenting ? 2 : 1;
  scope.update(dt, presenting ? 1 : wide / halves / Math.max(1, high));
  read_state();
  world?.update(playback, now, state);
  const angle = THREE.MathUtils.degToRad(modes.angle_deg);
  if (presenting) headset.render(scene, scope.camera, scope.distance, angle, headset_lines());
  else lens.render(scene, scope.camera, scope.distance, modes.stereo, angle);
  status.presenting = presenting;
  status.triangles = lens.triangles;
  status.graphics_lost = graphics.lost;
  if (!graphics.lost) {
    counted++;
    status.pictures++;
  }
  status.frames = playback.frames;
  status.refused = link.refused;
  status.ready = world !== null && playback.frames > 0;
  if (now - counted_from > 1000) {
    const seconds = (now - counted_from) / 1000;
    status.fps = counted / seconds;
    counted = 0;
    counted_from = now;
    // A hidden tab draws rarely by design; loading stalls are no sign of a slow machine either.
    if (status.ready && document.visibilityState === 'visible' && !graphics.lost && watch.observe(status.fps, seconds)) apply_quality();
  }
  if (!options.hud) return;
  const fresh_haptic = quiet(haptic_ms, 3000) ? null : haptic;
  if (playback.latest && world) {
    hud.show_frame(playback.latest, state, may_drive ? hands.active : -1, hands.hands.map((h) => h.taken));
  }
  hud.show_machine(quiet(frame_ms, 2500) ? null : playback.latest, fresh_haptic, status.fps, status.quality);
  const alive = !quiet(frame_ms, 1000);
  hud.show_link(link.open ? (alive ? 'connected' : 'gateway only') : 'disconnected', link.open && alive);
  hud.show_banner(banner(now, quiet));
  hud.show_notice(info && info.state !== 'error' ? info.message : '');
  hud.tick(now);
}

// Hands keep their own time: a slow picture must not make them slow.
let hands_last = performance.now();
setInterval(() => {
  const now = performance.now();
  hands.update(Math.min(0.1, (now - hands_last) / 1000), now);
  hands_last = now;
}, 1000 / 60);

apply_quality();
modes.tell();
// three's own loop: it goes on in a headset, where the window's stands still.
renderer.setAnimationLoop(draw);
