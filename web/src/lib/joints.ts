// SPDX-License-Identifier: GPL-2.0-or-later
// What a joint is called: by its axis where each axis is one joint, as on a plain mill.
import type { MachineFacts, MachineStatus } from './status';

/** Empty where the joint is not the same as an axis. */
export function letterOfJoint(facts: Pick<MachineFacts, 'axes' | 'joints'> | null, status: Pick<MachineStatus, 'settings'> | null, index: number): string {
  const isSame = facts !== null && status?.settings.kinematics === 'IDENTITY' && facts.joints === facts.axes.length;
  return isSame ? (facts.axes[index] ?? '') : '';
}
