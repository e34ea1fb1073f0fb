// SPDX-License-Identifier: GPL-2.0-or-later
// The last part of the tool path.
import { BufferAttribute, BufferGeometry, Line, LineBasicMaterial } from 'three';

const MOST_POINTS = 4000;

export class Trail {
  readonly line: Line<BufferGeometry, LineBasicMaterial>;
  private readonly places = new Float32Array(MOST_POINTS * 3);
  private count = 0;

  constructor() {
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(this.places, 3));
    geometry.setDrawRange(0, 0);
    this.line = new Line(geometry, new LineBasicMaterial());
    this.line.frustumCulled = false;
  }

  setColor(color: string): void {
    this.line.material.color.set(color);
  }

  clear(): void {
    this.count = 0;
    this.line.geometry.setDrawRange(0, 0);
  }

  add(x: number, y: number, z: number): void {
    if (this.count === MOST_POINTS) {
      this.places.copyWithin(0, 3);
      this.count -= 1;
    }
    this.places.set([x, y, z], this.count * 3);
    this.count += 1;
    this.line.geometry.setDrawRange(0, this.count);
    const position = this.line.geometry.getAttribute('position');
    position.needsUpdate = true;
  }
}
