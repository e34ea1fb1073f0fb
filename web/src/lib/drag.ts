// SPDX-License-Identifier: GPL-2.0-or-later
// A drag of a knob along its track. A swipe that scrolls the page is not a drag, and a short flick has little
// effect.

/** A shorter movement is a touch. [px] */
const SLOP_PX = 8;
/** A longer drag is deliberate. */
export const DELIBERATE_MS = 500;

export interface Scale {
  min: number;
  max: number;
  step: number;
  /** Change that is ignored until a drag is deliberate, up or down. */
  free: number;
  /** Travel of the knob on the track. [px] */
  width: number;
}

export function onScale(value: number, scale: { min: number; max: number; step: number }): number {
  const stepped = scale.min + Math.round((value - scale.min) / scale.step) * scale.step;
  return Math.min(Math.max(stepped, scale.min), scale.max);
}

export class Drag {
  private begunMs: number | null = null;
  private isScroll = false;
  private readonly x: number;
  private readonly y: number;

  constructor(
    at: { x: number; y: number },
    private readonly value: number,
    private readonly scale: Scale,
  ) {
    this.x = at.x;
    this.y = at.y;
  }

  /** The value at the pointer; null if this is not a drag. */
  move(at: { x: number; y: number }, nowMs: number): number | null {
    const [dx, dy] = [at.x - this.x, at.y - this.y];
    if (this.begunMs === null) {
      this.isScroll ||= Math.abs(dy) >= SLOP_PX && Math.abs(dx) <= 2 * Math.abs(dy);
      if (this.isScroll || Math.abs(dx) < SLOP_PX) {
        return null;
      }
      this.begunMs = nowMs;
    }
    const { min, max, free, width } = this.scale;
    const change = ((dx - Math.sign(dx) * Math.min(Math.abs(dx), SLOP_PX)) / Math.max(width, 1)) * (max - min);
    const isDeliberate = nowMs - this.begunMs >= DELIBERATE_MS;
    const allowed = isDeliberate ? change : Math.min(Math.max(change, -free), free);
    return onScale(this.value + allowed, this.scale);
  }
}
