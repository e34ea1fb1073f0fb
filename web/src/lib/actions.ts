// SPDX-License-Identifier: GPL-2.0-or-later
// Actions of an operator as sequences of commands. A sequence ends with the first command that is not done.
import { Jogger } from './jog';
import type { Command, Outcome } from './link';
import { canOpen } from './gates';
import { machine, send, sendQuietly, tellLocally, untilStatus, view, whenLost } from './machine.svelte';
import { t } from './i18n/index.svelte';
import { followOutcome } from './run.svelte';
import { mustApplyLength, toolLength } from './tool_length';
import { tools, type Tool } from './tools.svelte';
import { axisIndex, isAngularAxis, isProgramInches, type MachineStatus, type Mode } from './status';

function isDone(outcome: Outcome): boolean {
  return outcome.progress === 'DONE';
}

async function inOrder(...commands: Command[]): Promise<Outcome> {
  let outcome: Outcome = { progress: 'DONE', reason: '' };
  for (const command of commands) {
    outcome = await send(command);
    if (!isDone(outcome)) {
      return outcome;
    }
  }
  return outcome;
}

function toMode(mode: Mode): Command[] {
  return machine.status?.task.mode === mode ? [] : [{ message: 'SetMode', mode }];
}

// Stops: one command each, sent in the event handler itself.

export function emergencyStop(): void {
  jogger.releaseAll();
  void send({ message: 'SetState', state: 'ESTOP' });
}

export function stopAll(): void {
  jogger.releaseAll();
  void send({ message: 'AbortAll' });
}

export function hold(): void {
  void send({ message: 'PauseProgram' });
}

export function stopSpindle(spindle: number): void {
  void send({ message: 'SpindleOff', spindle });
}

// Power and homing

export const resetEmergencyStop = (): Promise<Outcome> => send({ message: 'SetState', state: 'ESTOP_RESET' });
export const switchOn = (): Promise<Outcome> => send({ message: 'SetState', state: 'ON' });
export const switchOff = (): Promise<Outcome> => send({ message: 'SetState', state: 'OFF' });

/** Homes joints in joint mode; -1: all. */
export function home(joint: number): Promise<Outcome> {
  return inOrder(...toMode('MANUAL'), { message: 'SetTeleop', teleop: false }, { message: 'HomeJoint', joint });
}

export function unhome(joint: number): Promise<Outcome> {
  return inOrder(...toMode('MANUAL'), { message: 'UnhomeJoint', joint });
}

// Jogs

function isPrepared(isJoint: boolean): boolean {
  const status = machine.status;
  const wanted = isJoint ? 'FREE' : 'TELEOP';
  const isManual = status?.task.mode === 'MANUAL' || status?.task.is_away === true;
  return isManual && status?.trajectory.mode === wanted;
}

const onJogsEnd: (() => void)[] = [];

/** `act` is called when a jog has ended although the operator did not release it. */
export function whenJogsEnd(act: () => void): void {
  onJogsEnd.push(act);
}

export const jogger = new Jogger({
  post: sendQuietly,
  isPrepared,
  prepare: async (isJoint) => {
    const isAway = machine.status?.task.is_away === true;
    const mode = isAway ? [] : toMode('MANUAL');
    return isDone(await inOrder(...mode, { message: 'SetTeleop', teleop: !isJoint }));
  },
  every: (act, ms) => setInterval(act, ms),
  cancel: (timer) => clearInterval(timer as number),
  ended(reason) {
    tellLocally(t('jog.ended', { reason }));
    onJogsEnd.forEach((act) => act());
  },
});

whenLost(() => jogger.releaseAll());

/** Ends all jogs on every event that ends a touch or the operator's attention. */
export function endJogsWithAttention(target: Window): void {
  const end = (): void => jogger.releaseAll();
  target.addEventListener('blur', end);
  target.addEventListener('pagehide', end);
  target.addEventListener('freeze', end);
  target.document.addEventListener('visibilitychange', () => {
    if (target.document.hidden) {
      end();
    }
  });
}

// Programs

export function openProgram(path: string): Promise<Outcome> {
  return inOrder(...toMode('AUTO'), { message: 'OpenProgram', path });
}

async function start(command: Command): Promise<Outcome> {
  const outcome = await inOrder(...toMode('AUTO'), command);
  followOutcome(outcome.progress);
  return outcome;
}

export function run(): Promise<Outcome> {
  return start({ message: 'RunProgram' });
}

export function runFromLine(line: number): Promise<Outcome> {
  return start({ message: 'RunProgram', from_line: line });
}

export const resume = (): Promise<Outcome> => send({ message: 'ResumeProgram' });
export const releaseAxes = (): Promise<Outcome> => send({ message: 'ReleaseAxes' });
export const confirmApproach = (number: number): Promise<Outcome> => send({ message: 'ConfirmApproach', number });
export const confirmToolChange = (): Promise<Outcome> => send({ message: 'ConfirmToolChange' });

export function step(): Promise<Outcome> {
  const isIdle = machine.status?.task.interp_state === 'IDLE';
  return inOrder(...(isIdle ? toMode('AUTO') : []), { message: 'StepProgram' });
}

export const setOptionalStop = (on: boolean): Promise<Outcome> => send({ message: 'SetOptionalStop', on });
export const setBlockDelete = (on: boolean): Promise<Outcome> => send({ message: 'SetBlockDelete', on });

// MDI

export function mdi(line: string): Promise<Outcome> {
  return inOrder(...toMode('MDI'), { message: 'Mdi', line });
}

/**
 * Makes task write its parameter file, from which the path of a program is read; so an offset also survives a
 * power cut.
 */
export function keepOffsets(): Promise<Outcome> {
  return canOpen(view()) === null ? sendQuietly({ message: 'SynchInterpreter' }) : Promise.resolve({ progress: 'REFUSED', reason: '' });
}

const MM_PER_INCH = 25.4;

/** A length in machine units, in the active unit of the program. */
export function inProgramUnits(value: number, letter: string): number {
  if (isAngularAxis(axisIndex(letter)) || machine.facts === null || machine.status === null) {
    return value;
  }
  const isMachineInch = machine.facts.linear_unit === 'inch';
  const isInch = isProgramInches(machine.status.codes);
  return isMachineInch === isInch ? value : isInch ? value / MM_PER_INCH : value * MM_PER_INCH;
}

/** Sets the current tool position to `value` (machine units) in the active coordinate system. */
export function touchOff(letter: string, value: number): Promise<Outcome> {
  return mdi(`G10 L20 P0 ${letter}${inProgramUnits(value, letter).toFixed(6)}`);
}

// Tools

function copyOf(status: MachineStatus): MachineStatus {
  return JSON.parse(JSON.stringify(status)) as MachineStatus;
}

/** A status created after the outcome of a command; the first status received may have been sent before the outcome. */
async function laterStatus(): Promise<MachineStatus | null> {
  await untilStatus(() => true);
  await untilStatus(() => true);
  return machine.status === null ? null : copyOf(machine.status);
}

/**
 * As T and M6 in an MDI line, including the actions that the INI file sets for a tool change. If a tool
 * length is active, G43 applies that of the new tool; under G49 no length is applied, and a length set by a
 * remap of M6 is kept.
 */
export async function changeTool(toolno: number): Promise<Outcome> {
  const before = machine.status === null ? null : copyOf(machine.status);
  const outcome = await mdi(`T${toolno} M6`);
  if (!isDone(outcome) || before === null) {
    return outcome;
  }
  const after = await laterStatus();
  const isLoaded = after !== null && after.tool.in_spindle === toolno;
  return isLoaded && mustApplyLength(before, after, tools.list) ? mdi('G43') : outcome;
}

/** Activates the length of the tool in the spindle: G43, or G49 for an empty spindle. Done when it is active. */
export async function applyLength(): Promise<Outcome> {
  const outcome = await mdi(machine.status?.tool.in_spindle === 0 ? 'G49' : 'G43');
  if (!isDone(outcome)) {
    return outcome;
  }
  const now = await laterStatus();
  if (now !== null && toolLength(now, tools.list).wrongAxes.length === 0) {
    return outcome;
  }
  const reason = t('length.not_applied');
  tellLocally(reason);
  return { progress: 'FAILED', reason };
}

/** Sets the tip of the tool in the spindle to `value` (machine units) of the work coordinates. */
export async function measureTool(toolno: number, value: number): Promise<Outcome> {
  const outcome = await mdi(`G10 L10 P${toolno} Z${inProgramUnits(value, 'Z').toFixed(6)}`);
  return isDone(outcome) ? mdi('G43') : outcome;
}

/** Fields as messages name them. */
function fieldsOf(tool: Tool) {
  return {
    toolno: tool.toolno,
    pocket: tool.pocketno,
    offset: [...tool.offset],
    diameter: tool.diameter,
    frontangle_deg: tool.frontangle_deg,
    backangle_deg: tool.backangle_deg,
    orientation: tool.orientation,
  };
}

export function setToolEntry(tool: Tool): Promise<Outcome> {
  return send({ message: 'SetToolEntry', ...fieldsOf(tool) });
}

/** Pocket 0: any free pocket. */
export function addTool(tool: Tool): Promise<Outcome> {
  return send({ message: 'AddTool', ...fieldsOf(tool), comment: tool.comment });
}

export function removeTool(toolno: number): Promise<Outcome> {
  return send({ message: 'RemoveTool', toolno });
}

// Spindle, coolant, overrides

export function startSpindle(spindle: number, speed: number): Promise<Outcome> {
  return send({ message: 'SpindleOn', spindle, speed_rpm: speed });
}

export const setFlood = (on: boolean): Promise<Outcome> => send({ message: on ? 'FloodOn' : 'FloodOff' });
export const setMist = (on: boolean): Promise<Outcome> => send({ message: on ? 'MistOn' : 'MistOff' });

export const setFeedOverride = (factor: number): Promise<Outcome> => send({ message: 'SetFeedOverride', factor });
export const setRapidOverride = (factor: number): Promise<Outcome> => send({ message: 'SetRapidOverride', factor });
export const setMaxVelocity = (velocity: number): Promise<Outcome> => send({ message: 'SetMaxVelocity', velocity });
export const setSpindleOverride = (spindle: number, factor: number): Promise<Outcome> =>
  send({ message: 'SetSpindleOverride', spindle, factor });
export const overrideLimits = (): Promise<Outcome> => send({ message: 'OverrideLimits', joint: -1 });
