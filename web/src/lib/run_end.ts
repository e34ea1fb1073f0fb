// SPDX-License-Identifier: GPL-2.0-or-later
// Duration of a program, and how it has ended: from the status, and from the outcome of its start if this
// page started it.
import type { MachineStatus } from './status';

export type EndKind = 'finished' | 'stopped' | 'failed' | 'ended';

export interface RunEnd {
  /** `ended`: stopped at its last line or by another screen. */
  kind: EndKind;
  program: string;
  /** Line of the last move, 0 if none was executed. */
  line: number;
  /** Null if the page did not observe the start. */
  seconds: number | null;
}

type Known = Pick<MachineStatus, 'time_ns' | 'codes'> & { task: Pick<MachineStatus['task'], 'mode' | 'interp_state' | 'program' | 'motion_line' | 'programs_ended' | 'error_code'> };

/** Index of M2 or M30 of the last block in the status. */
const M_STOP = 1;
const FAILED = 5;

export class RunWatch {
  private last: { isRunning: boolean; ended: number } | null = null;
  private start_ns: number | null = null;
  private line = 0;
  /** An outcome that arrived before the status with the end. */
  private early: string | null = null;
  /** How the last run has ended; null while a program runs and before the first run. */
  end: RunEnd | null = null;
  elapsed_s: number | null = null;

  /** Call it with each status; null: there is none. Returns true at the end of a program. */
  take(status: Known | null): boolean {
    if (status === null) {
      this.last = null;
      this.start_ns = this.elapsed_s = this.end = null;
      return false;
    }
    const { task } = status;
    const isRunning = task.mode === 'AUTO' && task.interp_state !== 'IDLE';
    const hasEnded = this.last !== null && task.programs_ended > this.last.ended;
    if (isRunning && this.last?.isRunning !== true) {
      this.start_ns = this.last === null ? null : status.time_ns;
      this.line = 0;
      this.end = null;
      this.early = null;
    }
    if (isRunning) {
      this.line = task.motion_line > 0 ? task.motion_line : this.line;
      this.elapsed_s = this.start_ns === null ? null : (status.time_ns - this.start_ns) * 1e-9;
    }
    if (hasEnded && !isRunning) {
      const wasSeen = this.last?.isRunning === true;
      const stop = status.codes.m[M_STOP];
      const kind = task.error_code === FAILED ? 'failed' : stop === 2 || stop === 30 ? 'finished' : 'ended';
      const seconds = wasSeen && this.start_ns !== null ? (status.time_ns - this.start_ns) * 1e-9 : null;
      this.end = { kind, program: task.program, line: wasSeen ? this.line : task.motion_line, seconds };
      if (this.early !== null) {
        this.outcome(this.early);
        this.early = null;
      }
    }
    if (!isRunning) {
      this.elapsed_s = null;
    }
    this.last = { isRunning, ended: task.programs_ended };
    return hasEnded && !isRunning;
  }

  /** Processes the outcome of the start command, which only the page that sent it receives. Returns true if the program is now complete. */
  outcome(progress: string): boolean {
    if (this.last?.isRunning === true) {
      this.early = progress;
    }
    if (this.end?.kind !== 'ended') {
      return false;
    }
    this.end = { ...this.end, kind: progress === 'DONE' ? 'finished' : 'stopped' };
    return progress === 'DONE';
  }
}
