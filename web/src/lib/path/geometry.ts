// SPDX-License-Identifier: GPL-2.0-or-later
// Position of a pose in the picture: [DISPLAY]GEOMETRY, as the server applies it to the points of a path.
import { AXIS_LETTERS, isAngularAxis } from '../status';

export type Spot = [number, number, number];

interface Step {
  axis: number;
  sign: number;
}

/** In the order of execution: from the last letter to the first. */
function stepsOf(geometry: string, axes: string): Step[] {
  const steps: Step[] = [];
  let sign = 1;
  for (const letter of geometry.toUpperCase()) {
    const axis = AXIS_LETTERS.indexOf(letter);
    if (letter === '-') {
      sign = -1;
    } else if (axis >= 0) {
      if (axes.includes(letter)) {
        steps.unshift({ axis, sign });
      }
      sign = 1;
    }
  }
  return steps;
}

function turn(spot: Spot, about: number, degrees: number): void {
  const [first, second] = [(about + 1) % 3, (about + 2) % 3];
  const angle = (degrees * Math.PI) / 180;
  const [a, b] = [spot[first] ?? 0, spot[second] ?? 0];
  spot[first] = a * Math.cos(angle) - b * Math.sin(angle);
  spot[second] = a * Math.sin(angle) + b * Math.cos(angle);
}

/** A function from nine coordinates to X, Y, Z of the picture. */
export function placer(geometry: string, axes: string): (pose: readonly number[]) => Spot {
  const steps = stepsOf(geometry, axes);
  return (pose) => {
    const spot: Spot = [0, 0, 0];
    for (const { axis, sign } of steps) {
      const value = sign * (pose[axis] ?? 0);
      if (isAngularAxis(axis)) {
        turn(spot, axis - 3, value);
      } else {
        spot[axis % 3] = (spot[axis % 3] ?? 0) + value;
      }
    }
    return spot;
  };
}

/** True if the picture shows X, Y, Z of the machine, so that its limits can be drawn. */
export function isPlain(geometry: string, axes: string): boolean {
  let hasMoved = false;
  for (const { axis, sign } of stepsOf(geometry, axes)) {
    const isTurn = isAngularAxis(axis);
    if ((isTurn && hasMoved) || (!isTurn && (sign < 0 || axis >= 6))) {
      return false;
    }
    hasMoved ||= !isTurn;
  }
  return true;
}
