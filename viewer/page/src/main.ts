// SPDX-License-Identifier: GPL-3.0-or-later
// Puts the page together: connection, scene, microscope, hands, HUD, and the loop that draws.
import * as THREE from 'three';
import { load_bundle } from './bundle';
import { Microscope } from './camera';
import { Connection } from './connection';
import { Hands } from './hands';
import { Hud } from './hud/hud';
import './hud/hud.css';
import type { HapticStatus, SceneInfo } from './lcm';
import { Lens } from './lens';
import { make_environment } from './materials/environment';
import { parse_options } from './options';
import { Playback } from './playback';
import { levels, QualityWatch } from './quality';
import { quaternion, vector, World } from './world';

const options = parse_options(location.search);
const canvas = document.getElementById('view') as HTMLCanvasElement;
const may_drive = options.role === 'trainee';
const may_command = options.role !== 'observer';

const renderer = make_renderer();
renderer.toneMapping = THREE.ACESFilmicToneMapping;
renderer.toneMappingExposure = 1.0;
renderer.shadowMap.type = THREE.PCFSoftShadowMap;
renderer.debug.onShaderError = (gl, program, vs, fs) => {
  console.error('shader:', gl.getProgramInfoLog(program), gl.getShaderInfoLog(vs), gl.getShaderInfoLog(fs));
};
const scene = new THREE.Scene();
scene.background = new THREE.Color(0x040303);
scene.environmentIntensity = 0.42;
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

const status = {
  ready: false, frames: 0, pictures: 0, fps: 0, session: '', quality: '', connected: false, frozen: false, refused: 0, error: '',
  build_ms: 0, taken: [false, false], active: 1, triangles: 0,
};
(window as unknown as { __insula: typeof status }).__insula = status;

const hud_root = document.getElementById('hud')!;
hud_root.hidden = !options.hud;
const ws_url = new URL('ws', location.href);
ws_url.protocol = ws_url.protocol === 'https:' ? 'wss:' : 'ws:';
ws_url.search = '';

const link = new Connection(ws_url.href, {
  frame: (m) => {
    if (!world || world.bundle.session !== m.session.toString()) return;
    frame_ms = performance.now();
    if (frozen) return;
    playback.push(m, performance.now());
    if (options.freeze_at_s !== null && m.sim_time_s >= options.freeze_at_s) frozen = status.frozen = true;
  },
  scene: (m) => { info = m; info_ms = performance.now(); void follow(m); },
  event: (m) => { if (m.text) hud.say(m.text, m.kind, performance.now()); },
  haptic: (m) => { haptic = m; haptic_ms = performance.now(); },
  devices: () => undefined,
  state: (open) => { status.connected = open; if (!open) { info = null; hands.release_all(); } },
});

const hud = new Hud(hud_root, {
  command: (name) => link.send_command(name),
  quality: (name) => { watch = new QualityWatch(name === '' ? null : (name as 'low')); apply_quality(); },
  choose_hand: (h) => hands.set_active(h),
  release_hand: (h) => hands.release(h),
  button: (b, on) => hands.press(b, on),
}, may_command, may_drive, options.quality ?? '');

const hands: Hands = new Hands(canvas, scope, link, {
  tool_pose: (hand) => {
    const t = playback.latest?.tool.find((x) => x.hand === hand);
    return t ? { p: vector(t.p_m), q: quaternion(t.q) } : null;
  },
}, {
  focus_at,
  toggle_pause: () => { if (may_command) link.send_command(playback.latest?.paused ? 'resume' : 'pause'); },
  toggle_help: () => hud.toggle_help(),
  changed: () => {
    status.taken = hands.hands.map((h) => h.taken);
    status.active = hands.active;
  },
}, may_drive);

/** Loads the bundle of a new session, once; tries again when it fails. */
let loading = '';
async function follow(m: SceneInfo): Promise<void> {
  const session = m.session.toString();
  if (m.state === 'loading' || m.state === 'error' || session === loading || world?.bundle.session === session) return;
  loading = session;
  try {
    const bundle = await load_bundle(new URL(`bundle/${session}/`, location.href).href, session);
    world?.dispose();
    world = null;
    playback.clear();
    hands.release_all();
    scope.set_home(bundle.view);
    const old = scene.environment;
    scene.environment = make_environment(renderer, scope.field_axis, vector(bundle.view.up));
    old?.dispose();
    const from = performance.now();
    world = new World(bundle, scope.field_axis, scene.environment);
    status.build_ms = Math.round(performance.now() - from);
    scene.add(world.root);
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
  const point = lens.pick(x, y, canvas.clientWidth, canvas.clientHeight, scope.camera);
  if (point) scope.focus(point);
}

function banner(now: number): string {
  if (!link.open) return 'Viewer gateway not reached\ntrying again …';
  if (!info || now - info_ms > 4000) return 'Waiting for the engine …';
  if (info.state === 'error') return `The scene has errors\n${info.message}`;
  if (load_error) return `Scene data cannot be read\n${load_error}`;
  if (!world || info.state === 'loading') return 'Loading the scene …';
  if (playback.frames === 0 || now - frame_ms > 2500) return info.state === 'ended' ? 'The session has ended' : 'No pictures from the engine: waiting for it to come back …';
  return playback.latest?.paused ? 'Paused' : '';
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
  requestAnimationFrame(draw);
  const dt = Math.min(0.1, Math.max(0, (now - last) / 1000));
  last = now;
  const wide = canvas.clientWidth, high = canvas.clientHeight;
  const size = renderer.getSize(new THREE.Vector2());
  if (size.x !== wide || size.y !== high) renderer.setSize(wide, high, false);
  scope.update(dt, wide / Math.max(1, high));
  world?.update(playback, now);
  lens.render(scene, scope.camera, scope.distance);
  status.triangles = lens.triangles;
  counted++;
  status.pictures++;
  status.frames = playback.frames;
  status.refused = link.refused;
  status.ready = world !== null && playback.frames > 0;
  if (now - counted_from > 1000) {
    const seconds = (now - counted_from) / 1000;
    status.fps = counted / seconds;
    counted = 0;
    counted_from = now;
    // A hidden tab draws rarely by design; loading stalls are no sign of a slow machine either.
    if (status.ready && document.visibilityState === 'visible' && watch.observe(status.fps, seconds)) apply_quality();
  }
  if (!options.hud) return;
  const fresh_haptic = now - haptic_ms < 3000 ? haptic : null;
  if (playback.latest && world) {
    const kinds = [0, 1].map((h) => world!.bundle.tools.find((t) => t.hand === (h === 0 ? 'left' : 'right'))?.kind ?? '');
    hud.show_frame(playback.latest, kinds, may_drive ? hands.active : -1, hands.hands.map((h) => h.taken));
  }
  hud.show_machine(now - frame_ms < 2500 ? playback.latest : null, fresh_haptic, status.fps, status.quality);
  const alive = now - frame_ms < Math.max(1000, 3000 * dt);
  hud.show_link(link.open ? (alive ? 'connected' : 'gateway only') : 'disconnected', link.open && alive);
  hud.show_banner(banner(now));
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
requestAnimationFrame(draw);
