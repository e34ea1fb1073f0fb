// SPDX-License-Identifier: GPL-2.0-or-later
// The targets that can be jogged now, and their speed.
import { jogger } from './actions';
import { letterOfJoint } from './joints';
import { machine } from './machine.svelte';
import { prefs } from './prefs.svelte';
import { axisIndex, isAngularAxis } from './status';

export interface Target {
  isJoint: boolean;
  index: number;
  letter: string;
  name: string;
  /** Label of its buttons. */
  label: string;
  /** A short name, independent of the label. */
  short: string;
  isAngular: boolean;
}

export const jogKeys = $state({ isOn: true });

/** Axes when all joints are homed, else single joints. */
export function targets(): Target[] {
  const { facts, status } = machine;
  if (facts === null || status === null) {
    return [];
  }
  if (status.trajectory.all_homed || !facts.is_homing_forced) {
    return [...facts.axes].map((letter) => ({
      isJoint: false,
      index: axisIndex(letter),
      letter,
      name: letter,
      label: letter,
      short: letter,
      isAngular: isAngularAxis(axisIndex(letter)),
    }));
  }
  return facts.joint_kinds.map((kind, index) => {
    const letter = letterOfJoint(facts, status, index);
    const name = letter === '' ? `J${index}` : letter;
    return { isJoint: true, index, letter, name, label: name, short: `J${index}`, isAngular: kind === 'ANGULAR' };
  });
}

/** The fraction of the maximum speed for jogs: the operator's, else that of [DISPLAY]DEFAULT_..._VELOCITY. */
export function jogShare(isAngular: boolean): number {
  const { facts } = machine;
  const highest = (isAngular ? facts?.max_angular_velocity : facts?.max_linear_velocity) ?? 0;
  const preset = (isAngular ? facts?.default_angular_velocity : facts?.default_linear_velocity) ?? 0;
  return prefs.jogShare ?? (highest > 0 ? Math.min(1, preset / highest) : 1);
}

/** Machine units or degrees per second. */
export function jogSpeed(isAngular: boolean, isRapid: boolean): number {
  const { facts } = machine;
  const highest = isAngular ? (facts?.max_angular_velocity ?? 0) : (facts?.max_linear_velocity ?? 0);
  const lowest = isAngular ? (facts?.min_angular_velocity ?? 0) : (facts?.min_linear_velocity ?? 0);
  return isRapid ? highest : Math.max(lowest, highest * jogShare(isAngular));
}

export function press(target: Target, sign: number, isRapid: boolean): void {
  void jogger.press({
    isJoint: target.isJoint,
    index: target.index,
    velocity: sign * jogSpeed(target.isAngular, isRapid),
    increment: prefs.increment,
  });
}

export function release(target: { isJoint: boolean; index: number }): void {
  jogger.release(target.isJoint, target.index);
}

/** The target of a key. */
export function targetOfKey(letter: string): Target | undefined {
  return targets().find((one) => one.letter === letter);
}
