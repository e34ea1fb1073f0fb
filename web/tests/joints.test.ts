// SPDX-License-Identifier: GPL-2.0-or-later
import { describe, expect, it } from 'vitest';
import { letterOfJoint } from '../src/lib/joints';
import type { MachineStatus } from '../src/lib/status';

const status = (kinematics: string): MachineStatus => ({ settings: { kinematics } }) as MachineStatus;

describe('the name of a joint', () => {
  it('is the letter of its axis where each axis is one joint', () => {
    expect([0, 1].map((index) => letterOfJoint({ axes: 'XZ', joints: 2 }, status('IDENTITY'), index))).toEqual(['X', 'Z']);
  });
  it('is none of a gantry, whose axis has two joints, of a robot, and before the status is known', () => {
    expect(letterOfJoint({ axes: 'XYZ', joints: 4 }, status('IDENTITY'), 1)).toBe('');
    expect(letterOfJoint({ axes: 'XYZ', joints: 3 }, status('BOTH'), 1)).toBe('');
    expect(letterOfJoint({ axes: 'XYZ', joints: 3 }, null, 1)).toBe('');
    expect(letterOfJoint(null, status('IDENTITY'), 1)).toBe('');
  });
});
