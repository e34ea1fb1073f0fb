// SPDX-License-Identifier: GPL-2.0-or-later
// The simulation of the open program, which continues while other views are open.
import { machine } from '../machine.svelte';
import { isPlain } from '../path/geometry';
import { keepPreferences, prefs } from '../prefs.svelte';
import { openName, program } from '../program.svelte';
import { tools } from '../tools.svelte';
import type { Frame } from '../simulation/moves';
import type { Facts, News, Order, Position, Prepared, Shown } from '../simulation/protocol';
import { withStock, type KeptStock } from '../simulation/kept';
import { guessShape, type ToolShape } from '../simulation/shapes';
import { stockAround, type Fixture, type Stock, type Triple } from '../simulation/stock';

const MM_PER_INCH = 25.4;
const ALLOWANCE_MM = 2;

export type Phase = 'none' | 'unsupported' | 'reading' | 'preparing' | 'ready' | 'failed';

interface State {
  phase: Phase;
  points: number;
  part: number;
  reason: string;
  facts: Facts | null;
  prepared: Prepared | null;
  shown: Shown | null;
  total_s: number;
  isPlanned: boolean;
  stock: Stock | null;
  fixtures: Fixture[];
  floor_mm: number;
  /** The picture follows the machine. */
  isLive: boolean;
  /** Number of the shown finding; -1: none. */
  chosen: number;
}

const EMPTY: State = { phase: 'none', points: 0, part: 0, reason: '', facts: null, prepared: null, shown: null, total_s: 0, isPlanned: false, stock: null, fixtures: [], floor_mm: 0, isLive: false, chosen: -1 };

export const simulation = $state<State>({ ...EMPTY });

let worker: Worker | null = null;
let number = 0;
let opened = '';
/** The frame in which the open program was read. */
let frame: Frame = { origin: [0, 0, 0], rotation_deg: 0, unit_mm: 1 };
/**
 * The last shown position of the program. It is kept when the program is calculated again, for instance after
 * a change of the stock.
 */
let place: { file: string; moves: number; at: number } | null = null;
/** The stock last entered on this page, because a mesh is too large for the preferences. */
let entered: KeptStock | null = null;
let isMoving = false;
let cells = { moving: 128, still: 384 };

function send(order: Order): void {
  if (worker === null) {
    worker = new Worker(new URL('../simulation/worker.ts', import.meta.url), { type: 'module' });
    worker.onmessage = hear;
  }
  worker.postMessage(order);
}

export function unitMm(): number {
  return machine.facts?.linear_unit === 'inch' ? MM_PER_INCH : 1;
}

/** The active work coordinates. */
export function activeFrame(): Frame {
  const offsets = machine.status?.offsets;
  const rotation_deg = offsets?.rotation_xy_deg ?? 0;
  const angle = (rotation_deg * Math.PI) / 180;
  const [x = 0, y = 0, z = 0] = offsets?.g92 ?? [];
  const [gx = 0, gy = 0, gz = 0] = offsets?.g5x ?? [];
  const origin = [gx + x * Math.cos(angle) - y * Math.sin(angle), gy + x * Math.sin(angle) + y * Math.cos(angle), gz + z];
  return { origin, rotation_deg, unit_mm: unitMm() };
}

/** Converts machine coordinates of the controlled point to the tool tip in work coordinates. [mm] */
export function tipOf(pose: readonly number[], tool: readonly number[], of: Frame): Triple {
  const angle = (of.rotation_deg * Math.PI) / 180;
  const [x, y, z] = [0, 1, 2].map((axis) => (pose[axis] ?? 0) - (tool[axis] ?? 0) - (of.origin[axis] ?? 0)) as Triple;
  return [(x * Math.cos(angle) + y * Math.sin(angle)) * of.unit_mm, (y * Math.cos(angle) - x * Math.sin(angle)) * of.unit_mm, z * of.unit_mm];
}

/** Shape of a tool of the program: diameter from the tool table, other data as entered or guessed from the comment. */
export function shapeOf(tool: number): ToolShape {
  const found = tools.list.slice(1).find((one) => one.toolno === tool);
  const diameter_mm = (found?.diameter ?? 0) * unitMm();
  return { ...guessShape(diameter_mm, found?.comment ?? ''), ...prefs.simulation.tools[String(tool)], diameter_mm };
}

export function toolComment(tool: number): string {
  return tools.list.slice(1).find((one) => one.toolno === tool)?.comment ?? '';
}

function isSupported(): boolean {
  const { facts } = machine;
  return facts?.kind === 'mill' && isPlain(facts.geometry, facts.axes);
}

/** Call it in an effect while the view is open. Reads the open program, and reads it again when the program, the offsets or the tools
 * change. */
export function followProgram(): void {
  const name = machine.isConnected ? openName() : null;
  const active = activeFrame();
  const wanted = JSON.stringify([name, program.reads, active, machine.facts?.kind, tools.version]);
  const isRunning = machine.status !== null && machine.status.task.interp_state !== 'IDLE';
  if (wanted === opened || (isRunning && simulation.phase === 'ready')) {
    return;
  }
  opened = wanted;
  frame = active;
  number += 1;
  Object.assign(simulation, EMPTY, { isLive: simulation.isLive });
  if (name === null) {
    send({ kind: 'close', number });
    return;
  }
  if (!isSupported()) {
    simulation.phase = 'unsupported';
    send({ kind: 'close', number });
    return;
  }
  simulation.phase = 'reading';
  const most = machine.status?.settings.max_velocity ?? 0;
  send({
    kind: 'open',
    number,
    file: name,
    frame,
    first_tool: machine.status?.tool.in_spindle ?? 0,
    rapid_mm_s: (most > 0 ? most : 50) * frame.unit_mm,
    times: { feed: 1, rapid: 1, max_velocity: 0 },
  });
}

function hear(event: MessageEvent<News>): void {
  const news = event.data;
  if (news.number !== number) {
    return;
  }
  switch (news.kind) {
    case 'reading':
      simulation.points = news.points;
      return;
    case 'read':
      simulation.facts = news.facts;
      begin(news.facts);
      return;
    case 'preparing':
      simulation.part = news.part;
      return;
    case 'prepared':
      simulation.prepared = news.prepared;
      simulation.phase = 'ready';
      simulation.chosen = -1;
      show({ moves: placeNow() }, false);
      return;
    case 'clock':
      simulation.total_s = news.total_s;
      simulation.isPlanned = news.isPlanned;
      if (simulation.shown !== null) {
        show({ moves: simulation.shown.moves }, isMoving);
      }
      return;
    case 'shown':
      simulation.shown = news.shown;
      place = { file: openName() ?? '', moves: simulation.facts?.moves ?? 0, at: news.shown.moves };
      return;
    case 'failed':
      simulation.phase = 'failed';
      simulation.reason = news.reason;
  }
}

/** Returns the end of the program if it has not been shown. */
function placeNow(): number {
  const isSame = place !== null && place.file === openName() && place.moves === simulation.facts?.moves;
  return isSame ? (place?.at ?? 0) : Number.MAX_SAFE_INTEGER;
}

function begin(facts: Facts): void {
  const kept = entered?.file === openName() ? entered : prefs.simulation.stocks.find((one) => one.file === openName());
  if (facts.rotary_line !== null || (kept === undefined && facts.cuts === null)) {
    simulation.phase = 'unsupported';
    return;
  }
  const stock = kept?.stock ?? firstStock(facts);
  simulation.stock = stock === null ? null : $state.snapshot(stock);
  simulation.fixtures = $state.snapshot([...(kept?.fixtures ?? [])]);
  simulation.floor_mm = kept?.floor_mm ?? stock?.low[2] ?? 0;
  prepare();
}

/** Prepares the simulation with the current stock and shapes. */
export function prepare(): void {
  const { stock, facts } = simulation;
  if (stock === null || facts === null) {
    return;
  }
  simulation.phase = 'preparing';
  simulation.part = 0;
  simulation.prepared = null;
  simulation.shown = null;
  const setup = $state.snapshot({ stock, fixtures: simulation.fixtures, floor_mm: simulation.floor_mm });
  const all = new Set([...facts.tools, machine.status?.tool.in_spindle ?? 0]);
  send({ kind: 'prepare', number, setup: { ...setup, tools: [...all].map((tool) => [tool, shapeOf(tool)]) } });
}

/** Applies the entered data. */
export function useStock(stock: Stock, fixtures: Fixture[], floor_mm: number): void {
  Object.assign(simulation, { stock, fixtures, floor_mm });
  const file = openName();
  entered = file === null ? null : { file, stock, fixtures, floor_mm };
  if (file !== null && stock.kind !== 'mesh') {
    prefs.simulation.stocks = withStock($state.snapshot(prefs.simulation.stocks), { file, stock, fixtures, floor_mm });
    keepPreferences();
  }
  prepare();
}

/** The stock required by the program's cuts. */
function firstStock(facts: Facts): Stock | null {
  const radius_mm = Math.max(0, ...facts.tools.map((tool) => shapeOf(tool).diameter_mm / 2));
  return facts.cuts === null ? null : stockAround($state.snapshot(facts.cuts), radius_mm, ALLOWANCE_MM);
}

export function defaultStock(): Stock | null {
  return simulation.facts === null ? null : firstStock(simulation.facts);
}

export function useShape(tool: number, shape: ToolShape): void {
  const { diameter_mm, ...kept } = shape;
  void diameter_mm;
  prefs.simulation.tools = { ...$state.snapshot(prefs.simulation.tools), [String(tool)]: kept };
  keepPreferences();
  prepare();
}

export function setCells(moving: number, still: number): void {
  cells = { moving, still };
}

let stillTimer: ReturnType<typeof setTimeout> | undefined;
const STILL_AFTER_MS = 250;

/** Shows a point of the program: coarsely while the point changes, finely when it stops. */
export function show(at: Position, isInMotion: boolean): void {
  if (simulation.phase !== 'ready') {
    return;
  }
  isMoving = isInMotion;
  send({ kind: 'show', number, at, most: isInMotion ? cells.moving : cells.still });
  clearTimeout(stillTimer);
  if (isInMotion) {
    stillTimer = setTimeout(() => {
      if (simulation.shown !== null) {
        show({ moves: simulation.shown.moves }, false);
      }
    }, STILL_AFTER_MS);
  }
}

let isRunningBefore = false;
let lastSeen = '';

/** Call it with each status: the picture follows the machine while a program runs. */
export function followMachine(): void {
  const { status } = machine;
  const isRunning = status !== null && status.task.mode === 'AUTO' && status.task.interp_state !== 'IDLE';
  const isNew = isRunning && !isRunningBefore;
  isRunningBefore = isRunning;
  if (!isRunning || !simulation.isLive || simulation.phase !== 'ready') {
    return;
  }
  const tip = tipOf(status.trajectory.position_fb, status.offsets.tool, frame);
  const seen = JSON.stringify([status.task.motion_line, tip]);
  if (seen !== lastSeen || isNew) {
    lastSeen = seen;
    show({ machine: { line: status.task.motion_line, tip, isNew } }, true);
  }
}
