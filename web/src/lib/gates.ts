// SPDX-License-Identifier: GPL-2.0-or-later
// The commands that are possible now; otherwise the reason and the remedy. Gates disable buttons whose
// commands the machine would reject; the machine checks again and decides. Stops have no gate.
import type { TextKey } from './i18n/en';
import type { Values } from './i18n/text';
import type { MachineFacts, MachineStatus } from './status';

export interface Closed {
  key: TextKey;
  values?: Values;
}

/** Null if the command is possible. */
export type Gate = Closed | null;

export interface View {
  isConnected: boolean;
  isMachineUp: boolean;
  role: string;
  client: number;
  status: MachineStatus | null;
  facts: MachineFacts | null;
  /** The program with unsaved changes in the editor. */
  unsaved: string | null;
}

type Situation = 'estop' | 'off' | 'idle' | 'running' | 'held' | 'proposed' | 'away' | 'line';

/** The situation in the words of states.md, with those of the modes combined. */
export function situation(status: MachineStatus): Situation {
  const { task } = status;
  if (task.state === 'ESTOP') {
    return 'estop';
  }
  if (task.state !== 'ON') {
    return 'off';
  }
  if (status.approach.number !== 0) {
    return 'proposed';
  }
  if (task.is_away) {
    return 'away';
  }
  if (task.interp_state === 'IDLE') {
    return 'idle';
  }
  if (task.mode === 'MDI') {
    return 'line';
  }
  return task.is_paused ? 'held' : 'running';
}

const BUSY: Partial<Record<Situation, TextKey>> = {
  running: 'gate.running',
  held: 'gate.held',
  proposed: 'gate.proposed',
  away: 'gate.held',
  line: 'gate.line',
};

/** Conditions for all commands except stops. */
export function reach(view: View): Gate {
  if (!view.isConnected) {
    return { key: 'gate.connection' };
  }
  if (!view.isMachineUp || view.status === null || view.facts === null) {
    return { key: 'gate.machine' };
  }
  if (view.role === 'view') {
    return { key: 'gate.role' };
  }
  const { holder } = view.status.operation;
  return holder !== 0 && holder !== view.client ? { key: 'gate.holder', values: { client: holder } } : null;
}

function closed(key: TextKey | undefined): Gate {
  return key === undefined ? null : { key };
}

function atPower(status: MachineStatus): Gate {
  const now = situation(status);
  return now === 'estop' ? { key: 'gate.estop' } : now === 'off' ? { key: 'gate.off' } : null;
}

type Rule = (status: MachineStatus, facts: MachineFacts) => Gate;

/** Creates a gate from reach() and rules in order. The first closed rule is shown, because it must be fulfilled first. */
function gate(...rules: Rule[]): (view: View) => Gate {
  return (view) => {
    const first = reach(view);
    if (first !== null || view.status === null || view.facts === null) {
      return first;
    }
    for (const rule of rules) {
      const found = rule(view.status, view.facts);
      if (found !== null) {
        return found;
      }
    }
    return null;
  };
}

const isHomed: Rule = (status, facts) =>
  facts.is_homing_forced && !status.trajectory.all_homed ? { key: 'gate.homed' } : null;
const isIdle: Rule = (status) => closed(BUSY[situation(status)]);
const isNotHoming: Rule = (status) => (status.trajectory.is_homing ? { key: 'gate.homing' } : null);

/** Changes of the running configuration: HAL values, and the oscilloscope in the servo thread. */
export function canConfigure(view: View): Gate {
  return reach(view) ?? (view.role === 'configure' ? null : { key: 'gate.configure' });
}

export const canReset = gate();
export const canSwitchOn = gate((status) => (status.task.state === 'ESTOP' ? { key: 'gate.estop' } : null));
export const canSwitchOff = gate(atPower);
export const canJog = gate(atPower, isNotHoming, (status) => {
  const now = situation(status);
  return now === 'away' ? null : closed(BUSY[now]);
});
export const canHome = gate(atPower, isIdle, isNotHoming);
export const canOpen = gate(isIdle);
/** False if the editor shows another text than the file that task would run. */
function isSaved(view: View): Gate {
  const { status, facts, unsaved } = view;
  const isOpen = unsaved !== null && status?.task.program === `${facts?.program_prefix}/${unsaved}`;
  return isOpen ? { key: 'gate.unsaved' } : null;
}
const canRunFile = gate(atPower, isIdle, isNotHoming, isHomed, (status) =>
  status.task.program === '' ? { key: 'gate.program' } : null,
);
export const canRun = (view: View): Gate => canRunFile(view) ?? isSaved(view);
export const canResume = gate(atPower, (status) => {
  const now = situation(status);
  const isHeld = now === 'held' || now === 'away' || (now === 'line' && status.task.is_paused);
  return isHeld ? null : now === 'proposed' ? { key: 'gate.proposed' } : { key: 'gate.not_held' };
});
const canStepFile = gate(atPower, isNotHoming, isHomed, (status) => {
  const now = situation(status);
  if (now === 'idle') {
    return status.task.program === '' ? { key: 'gate.program' } : null;
  }
  // In a running program a step pauses at the end of the current move.
  const canBe = now === 'running' || now === 'held' || (now === 'line' && status.task.is_paused);
  return canBe ? null : closed(BUSY[now]);
});
/** A step of a running program applies to the saved text. */
export const canStep = (view: View): Gate =>
  canStepFile(view) ?? (view.status !== null && situation(view.status) === 'idle' ? isSaved(view) : null);
export const canRelease = gate(atPower, (status) => {
  const now = situation(status);
  return now === 'held' || now === 'proposed' ? null : { key: 'gate.not_held' };
});
/** A line entered while another line runs is queued. */
export const canMdi = gate(atPower, isNotHoming, isHomed, (status) => {
  const now = situation(status);
  return now === 'line' && !status.task.is_paused ? null : closed(BUSY[now]);
});
/** An offset needs the same conditions as an MDI line, and no other command may be active. */
export const canTouchOff = gate(atPower, isNotHoming, isHomed, isIdle);
export const canEnergise = gate(atPower);
export const canOverride = gate();
export const canOverrideFeed = gate((status) =>
  status.overrides.feed_enabled ? null : { key: 'gate.feed_override' },
);
export const canChangeTools = gate(isIdle);

export function canOverrideSpindle(index: number): (view: View) => Gate {
  return gate((status) =>
    status.spindles[index]?.override_enabled === false ? { key: 'gate.spindle_override' } : null,
  );
}
