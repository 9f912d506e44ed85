// SPDX-License-Identifier: GPL-3.0-or-later
// A scene as the page has it: what load_bundle made of scene.json and its files (docs/scene-bundle.md).
import type { ContactSide } from './contact_sides';
import type { InventoryItem } from './inventory';
import type { ChannelData, DrawableData, MaterialData, Rgba } from './step_data/declarations';

export interface MeshData {
  positions: Float32Array;
  indices: Uint32Array;
}

export interface SurfaceData extends MeshData {
  id: string;
  material: string;
}

export interface SkinnedSurface extends SurfaceData {
  skinNodes: Uint32Array;
  skinWeights: Float32Array;
  /** Named stretches of a wall, and each vertex's; null where there are none. */
  regions: string[];
  vertexRegion: Uint32Array | null;
}

/** A cap: its centre, m, its outward unit normal, and its radius, m. */
export interface EndData {
  centreM: [number, number, number];
  outward: [number, number, number];
  radiusM: number;
}

export interface BodyData {
  index: number;
  id: string;
  nodes: number;
  rest: Float32Array;
  surfaces: SkinnedSurface[];
  /** Channel whose value a region shows in the infrared picture. */
  channelOfRegion: Record<string, string>;
  /** Channel with the pressure of the fluid inside a region. */
  pressureOfRegion: Record<string, string>;
  regionThicknessM: Record<string, number>;
  /** Where a hollow organ goes on beyond its model. */
  ends: EndData[];
  /** Channel with the phase of its pulse, 0..1; "": none. */
  pulseChannel: string;
}

export interface ToolPart extends MeshData {
  name: string;
  /** 0: the root; k: turned about hinges[k - 1]. */
  link: number;
  rgba: Rgba;
  material: string;
}

/** Turns its link by multiplier times the tool's opening, in the tool's frame. */
export interface HingeData {
  origin: [number, number, number];
  axis: [number, number, number];
  multiplier: number;
}

export interface ToolData {
  index: number;
  id: string;
  /** left, right, or none: no hand takes it up by itself. */
  hand: string;
  kind: string;
  title: string;
  /** It has an edge. */
  cuts: boolean;
  hinges: HingeData[];
  parts: ToolPart[];
  /** Address of its picture, or null. */
  picture: string | null;
  /** What a list tells of it, as text: "7 mm". value: in SI; null: it is no number. */
  properties: { name: string; text: string; value: number | null }[];
  tags: string[];
}

/** A hand and the tools that lie ready for it, in order. */
export interface HandData {
  hand: 'left' | 'right';
  tools: ToolData[];
}

/** A command that a component obeys; min = max = 0: its argument, if any, is text. */
export interface CommandData {
  name: string;
  doc: string;
  argument: string;
  min: number;
  max: number;
  /** What it has set at the start, in its unit; null: not said. */
  start: number | null;
  /** What the surgeon usually asks the anaesthetist for; null: the command is the instructor's alone. */
  usual: number | null;
}

export interface CommandGroup {
  id: string;
  element: string;
  commands: CommandData[];
}

export interface ExerciseData {
  id: string;
  title: string;
  text: string;
  goals: { id: string; text: string }[];
  faults: { id: string; text: string }[];
  /** Names of the motions that can be shown. */
  motions: string[];
  /** Poses of an example, as targets for who practises. */
  guide: GuidePose[];
}

/** A pose of the example for one hand; button1, button2: whether they are pressed from there on. */
export interface GuidePose {
  hand: 'left' | 'right';
  tool: string;
  /** What the example has asked of the tool before, and with which argument; '': nothing. */
  command: string;
  argument: string;
  /** It counts as reached within these. */
  nearM: number;
  nearRad: number;
  /** When the example is there. */
  timeS: number;
  p: [number, number, number];
  /** w x y z */
  q: [number, number, number, number];
  button1: boolean;
  button2: boolean;
}

export interface ViewData {
  eye: [number, number, number];
  target: [number, number, number];
  up: [number, number, number];
  fovDeg: number;
}

/** A drawable with the meshes that its declaration names. */
export interface LoadedDrawable {
  declared: DrawableData;
  meshes: (MeshData & { rgba: Rgba | null })[];
}

export interface Bundle {
  session: string;
  title: string;
  description: string;
  view: ViewData;
  bodies: BodyData[];
  static: SurfaceData[];
  tools: ToolData[];
  hands: HandData[];
  contactSides: ContactSide[];
  commands: CommandGroup[];
  channels: ChannelData[];
  drawables: LoadedDrawable[];
  materials: Map<string, MaterialData>;
  exercise: ExerciseData | null;
  /** What is in it by name, of a scene that is looked at; null of one that is played. */
  inventory: InventoryItem[] | null;
}
