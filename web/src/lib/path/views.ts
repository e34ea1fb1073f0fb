// SPDX-License-Identifier: GPL-2.0-or-later
// Camera views of a path.
import { Vector3, type Box3, type Matrix4 } from 'three';
import type { Spot } from './geometry';

export type ViewName = 'top' | 'front' | 'side' | 'iso' | 'lathe' | 'back_lathe' | 'xy' | 'uv';

/**
 * Position of the camera relative to its target, and the upward direction of the picture. A lathe has Z to
 * the right, and X downwards if the tool is in front of the part.
 */
export const VIEWS: Record<ViewName, { from: Spot; up: Spot; isFlat?: boolean }> = {
  top: { from: [0, -0.0001, 1], up: [0, 0, 1] },
  front: { from: [0, -1, 0], up: [0, 0, 1] },
  side: { from: [1, 0, 0], up: [0, 0, 1] },
  iso: { from: [-0.6, -1, 0.75], up: [0, 0, 1] },
  lathe: { from: [0, -1, 0], up: [-1, 0, 0], isFlat: true },
  back_lathe: { from: [0, 1, 0], up: [1, 0, 0], isFlat: true },
  xy: { from: [0, -0.0001, 1], up: [0, 0, 1], isFlat: true },
  uv: { from: [0, -0.0001, 1], up: [0, 0, 1], isFlat: true },
};

/** Half size of a box in the camera's view, to the right and upwards; never zero. */
export function halfSize(box: Box3, toCamera: Matrix4): [number, number] {
  let [wide, high] = [1e-3, 1e-3];
  for (let i = 0; i < 8; ++i) {
    const corner = new Vector3(i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y, i & 4 ? box.max.z : box.min.z).applyMatrix4(toCamera);
    wide = Math.max(wide, Math.abs(corner.x));
    high = Math.max(high, Math.abs(corner.y));
  }
  return [wide, high];
}
