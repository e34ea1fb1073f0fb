// SPDX-License-Identifier: GPL-2.0-or-later
// The status as sent by the server: messages.md, MachineStatus. Lengths in machine units, angles in degrees.

export type State = 'ESTOP' | 'ESTOP_RESET' | 'OFF' | 'ON';
export type Mode = 'MANUAL' | 'AUTO' | 'MDI';
export type InterpState = 'IDLE' | 'READING' | 'PAUSED' | 'WAITING';

export interface TaskStatus {
  state: State;
  mode: Mode;
  interp_state: InterpState;
  exec_state: string;
  is_away: boolean;
  is_paused: boolean;
  stopped_by_program: boolean;
  optional_stop: boolean;
  block_delete: boolean;
  program: string;
  read_line: number;
  motion_line: number;
  stop_line: number;
  programs_ended: number;
  queued_mdi: number;
  waiting: { what: string; index: number };
  delay_left: number;
  block: string;
  /** 5 after a program or line that has failed. */
  error_code: number;
}

export interface Codes {
  g: number[];
  m: number[];
  settings: number[];
}

export interface Offsets {
  g5x_index: number;
  g5x: number[];
  g92: number[];
  tool: number[];
  rotation_xy_deg: number;
}

export interface Trajectory {
  num_joints: number;
  num_spindles: number;
  mode: 'FREE' | 'COORD' | 'TELEOP';
  is_enabled: boolean;
  in_position: boolean;
  is_paused: boolean;
  all_homed: boolean;
  is_homing: boolean;
  move_kind: string;
  current_velocity: number;
  requested_velocity: number;
  distance_to_go: number;
  position_cmd: number[];
  position_fb: number[];
  position_valid: boolean;
  dtg: number[];
}

export interface Joint {
  is_present: boolean;
  pos_cmd: number;
  pos_fb: number;
  vel_cmd: number;
  ferror: number;
  ferror_highmark: number;
  min_limit: number;
  max_limit: number;
  is_enabled: boolean;
  is_homing: boolean;
  is_homed: boolean;
  is_faulted: boolean;
  on_neg_soft_limit: boolean;
  on_pos_soft_limit: boolean;
  on_neg_hard_limit: boolean;
  on_pos_hard_limit: boolean;
  ferror_tripped: boolean;
  overriding_limits: boolean;
}

export interface Spindle {
  is_present: boolean;
  speed_cmd_rpm: number;
  override_factor: number;
  speed_in_rps: number;
  direction: number;
  is_on: boolean;
  at_speed: boolean;
  brake_on: boolean;
  override_enabled: boolean;
}

export interface Approach {
  number: number;
  to: 'NOTHING' | 'LINE' | 'PLACE_LEFT' | 'PLACE_LOST';
  line: number;
  tool: number;
  must_change_tool: boolean;
  mist: boolean;
  flood: boolean;
  feed: number;
  speeds_rpm: number[];
  offsets: Offsets;
  codes: Codes;
  num_moves: number;
  moves: { end: number[]; rapid: boolean }[];
}

export interface MachineStatus {
  cycle: number;
  time_ns: number;
  task: TaskStatus;
  codes: Codes;
  offsets: Offsets;
  trajectory: Trajectory;
  probe: { position: number[]; is_probing: boolean; tripped: boolean; on: boolean };
  overrides: { feed: number; rapid: number; net: number; feed_enabled: boolean };
  joints: Joint[];
  axes: { is_present: boolean; velocity: number; min_limit: number; max_limit: number }[];
  spindles: Spindle[];
  tool: {
    in_spindle: number;
    prepared_index: number;

    table_version: number;
    person_asked: boolean;
    faulted: boolean;
    cut_time_s: number;
  };
  io: {
    aux: { estop_requested: boolean; chain_closed: boolean };
    coolant: { mist: boolean; flood: boolean };
  };
  operation: { holder: number; lease_left_s: number };
  approach: Approach;
  settings: { max_velocity: number; linear_units: number; kinematics: string };
}

export interface PanelPart {
  kind: 'lamp' | 'value' | 'bar' | 'button' | 'switch' | 'number';
  label: string;
  /** A pin, signal or parameter of HAL. */
  name: string;
  unit?: string;
  decimals?: number;
  min?: number;
  max?: number;
}

export type Tab = { name: string; location: string } & (
  | { kind: 'frame'; address: string }
  | { kind: 'panel'; panel: { parts: PanelPart[] } }
  | { kind: 'program'; command: string }
);

export interface MachineFacts {
  name: string;
  title: string;
  has_icon: boolean;
  keeps_mdi_history: boolean;
  keeps_preferences: boolean;
  tabs: Tab[];
  min_linear_velocity: number;
  min_angular_velocity: number;
  /** Overrides with 1.0 for 100 %, speeds in rev/min; max_speed and default_speed 0: not set. */
  spindles: { min_override: number; max_override: number; min_speed: number; max_speed: number; default_speed: number; increment: number }[];
  ini: string;
  instance: string;
  axes: string;
  kind: 'mill' | 'lathe' | 'back_lathe' | 'foam';
  /** [DISPLAY]GEOMETRY: the order of translations and rotations in the picture. */
  geometry: string;
  /** Heights at which the planes of a foam cutter are drawn. */
  foam_z: number;
  foam_w: number;
  joints: number;
  joint_kinds: string[];
  is_homing_forced: boolean;
  linear_unit: 'mm' | 'inch';
  program_prefix: string;
  max_linear_velocity: number;
  default_linear_velocity: number;
  max_angular_velocity: number;
  default_angular_velocity: number;
  increments: { text: string; value: number; angular: boolean }[];
  mdi_commands: string[];
  program_extensions: string[];
  /** Extensions of the files that a program of [FILTER] converts; the programs that it creates are in filtered_folder. */
  filter_extensions: string[];
  filtered_folder: string;
  max_feed_override: number;
}

type Tree = { [key: string]: unknown };

function isTree(value: unknown): value is Tree {
  return typeof value === 'object' && value !== null;
}

/** Applies changes to `whole`; they are nested as in the whole, and arrays contain elements by index. */
export function mergeDelta(whole: Tree | unknown[], delta: Tree): void {
  const target = whole as Tree;
  for (const [key, value] of Object.entries(delta)) {
    const old = target[key];
    if (isTree(value) && !Array.isArray(value) && isTree(old)) {
      mergeDelta(old, value);
    } else {
      target[key] = value;
    }
  }
}

export const AXIS_LETTERS = 'XYZABCUVW';

/** Number of an axis in poses. */
export function axisIndex(letter: string): number {
  return AXIS_LETTERS.indexOf(letter);
}

export function isAngularAxis(index: number): boolean {
  return index >= 3 && index <= 5;
}

/** Position of the controlled point in program coordinates, in machine units. */
export function workPosition(position: readonly number[], offsets: Offsets): number[] {
  const at = position.map((value, i) => value - (offsets.g5x[i] ?? 0) - (offsets.tool[i] ?? 0));
  const angle = (-offsets.rotation_xy_deg * Math.PI) / 180;
  const [x, y] = [at[0] ?? 0, at[1] ?? 0];
  if (angle !== 0) {
    at[0] = x * Math.cos(angle) - y * Math.sin(angle);
    at[1] = x * Math.sin(angle) + y * Math.cos(angle);
  }
  return at.map((value, i) => value - (offsets.g92[i] ?? 0));
}

/** Indices in the lists of codes that are not modes: the line number, and codes of only the last block. */
const NO_MODE_G = [0, 2];
const NO_MODE_M = [0, 1, 3, 9];

/** Active modal codes as they are written, "G54". */
export function modalWords(codes: Codes): string[] {
  const g = codes.g.filter((code, i) => !NO_MODE_G.includes(i) && code >= 0);
  const m = codes.m.filter((code, i) => !NO_MODE_M.includes(i) && code >= 0);
  return [...g.map((code) => `G${code % 10 === 0 ? code / 10 : (code / 10).toFixed(1)}`), ...m.map((code) => `M${code}`)];
}

export const SYSTEMS = ['', 'G54', 'G55', 'G56', 'G57', 'G58', 'G59', 'G59.1', 'G59.2', 'G59.3'];

export function systemName(index: number): string {
  return SYSTEMS[index] ?? `#${index}`;
}

/** G7: X counts as a diameter in programs and MDI. */
export function isDiameter(codes: Codes): boolean {
  return codes.g.includes(70);
}

/** G20: programs and MDI are in inches. */
export function isProgramInches(codes: Codes): boolean {
  return codes.g.includes(200);
}

/** F, S and P of G64, in the units of the program. */
export function programmed(codes: Codes): { feed: number; speed: number; tolerance: number } {
  const [, feed = 0, speed = 0, tolerance = 0] = codes.settings;
  return { feed, speed, tolerance };
}

/** Unit of the F word. */
export function feedUnit(codes: Codes): string {
  const length = isProgramInches(codes) ? 'inch' : 'mm';
  return codes.g.includes(930) ? '1/min' : codes.g.includes(950) ? `${length}/rev` : `${length}/min`;
}
