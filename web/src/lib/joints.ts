// SPDX-License-Identifier: GPL-2.0-or-later
// Name of a joint: the axis letter if each axis has one joint, as on a plain mill.
import type { MachineFacts, MachineStatus } from './status';

/** Empty if the joint does not correspond to an axis. */
export function letterOfJoint(facts: Pick<MachineFacts, 'axes' | 'joints'> | null, status: Pick<MachineStatus, 'settings'> | null, index: number): string {
  const isSame = facts !== null && status?.settings.kinematics === 'IDENTITY' && facts.joints === facts.axes.length;
  return isSame ? (facts.axes[index] ?? '') : '';
}
