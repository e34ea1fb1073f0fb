// SPDX-License-Identifier: GPL-2.0-or-later
// Checks that probe and tool setter work: their contact must be detected once before the first cycle.
import type { MachineStatus } from './status';

/** The probe moves with the spindle, the setter is on the table; both use motion.probe-input. */
export type Sensor = 'probe' | 'setter';

export interface ContactFacts {
  isOn: boolean;
  tool: number;
  isSpindleOn: boolean;
  isMachineOn: boolean;
  isIdle: boolean;
}

export function contactFacts(status: MachineStatus): ContactFacts {
  return {
    isOn: status.probe.on,
    tool: status.tool.in_spindle,
    isSpindleOn: status.spindles.some((one) => one.is_on),
    isMachineOn: status.task.state === 'ON',
    isIdle: status.task.interp_state === 'IDLE',
  };
}

/**
 * A contact is accepted while the operator is asked for it, nothing runs, and the input was open before. The
 * contact of the probe is invalid after another tool is loaded, the spindle rotates or the machine is
 * switched off, because a cutter may then replace the probe.
 */
export class ContactCheck {
  private last: (ContactFacts & { asked: Sensor | null }) | null = null;
  readonly seen: Record<Sensor, boolean> = { probe: false, setter: false };

  /** `now`: null while no machine is running. `asked`: the sensor that the operator is asked to touch. */
  update(now: ContactFacts | null, asked: Sensor | null): void {
    const last = this.last;
    this.last = now === null ? null : { ...now, asked };
    if (now === null) {
      this.seen.setter = this.seen.probe = false;
      return;
    }
    if (last === null || now.tool !== last.tool || now.isSpindleOn || !now.isMachineOn) {
      this.seen.probe = false;
    }
    const isFirst = last !== null && !last.isOn && now.isOn;
    if (isFirst && asked !== null && asked === last.asked && now.isIdle && now.isMachineOn && !now.isSpindleOn && now.tool === last.tool) {
      this.seen[asked] = true;
    }
  }
}
