// SPDX-License-Identifier: GPL-2.0-or-later
// Models of tool, holder, fixtures and axes for three.js. Z points up. [mm]
import { BoxGeometry, BufferAttribute, BufferGeometry, CylinderGeometry, EdgesGeometry, LatheGeometry, Vector2 } from 'three';
import { cutterOf, heightAt, type ToolShape } from '../simulation/shapes';
import type { Box } from '../simulation/stock';

const SIDES = 32;
const PROFILE_POINTS = 12;

/** Length in the drawing if the length of a tool is not known. */
export function drawnStickout(tool: ToolShape): number {
  return tool.stickout_mm ?? Math.max(4 * tool.diameter_mm, 25);
}

/** The tool with its tip at 0. */
export function toolGeometry(tool: ToolShape): BufferGeometry {
  const cutter = cutterOf(tool);
  const points = [new Vector2(0, 0)];
  for (let i = 0; i <= PROFILE_POINTS; ++i) {
    const distance = cutter.flat_radius + ((cutter.radius - cutter.flat_radius) * i) / PROFILE_POINTS;
    points.push(new Vector2(Math.max(distance, 1e-6), heightAt(cutter, distance)));
  }
  points.push(new Vector2(cutter.radius, Math.max(drawnStickout(tool), heightAt(cutter, cutter.radius))));
  const geometry = new LatheGeometry(points, SIDES);
  geometry.rotateX(Math.PI / 2);
  return geometry;
}

export function holderGeometry(tool: ToolShape): BufferGeometry {
  const length = Math.max(tool.holder_diameter_mm, 20);
  const geometry = new CylinderGeometry(tool.holder_diameter_mm / 2, tool.holder_diameter_mm / 2, length, SIDES);
  geometry.rotateX(Math.PI / 2);
  geometry.translate(0, 0, drawnStickout(tool) + length / 2);
  return geometry;
}

function placed(box: Box): BoxGeometry {
  const [x, y, z] = [0, 1, 2].map((axis) => (box.high[axis] ?? 0) - (box.low[axis] ?? 0)) as [number, number, number];
  const geometry = new BoxGeometry(x, y, z);
  geometry.translate(...([0, 1, 2].map((axis) => ((box.high[axis] ?? 0) + (box.low[axis] ?? 0)) / 2) as [number, number, number]));
  return geometry;
}

export function boxGeometry(box: Box): BufferGeometry {
  return placed(box);
}

export function edgesOf(box: Box): BufferGeometry {
  const solid = placed(box);
  const edges = new EdgesGeometry(solid);
  solid.dispose();
  return edges;
}

/** X, Y and Z of the work coordinates from their origin, each with a colour. */
export function axesGeometry(length: number): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(Float32Array.of(0, 0, 0, length, 0, 0, 0, 0, 0, 0, length, 0, 0, 0, 0, 0, 0, length), 3));
  geometry.setAttribute('color', new BufferAttribute(Float32Array.of(0.9, 0.2, 0.2, 0.9, 0.2, 0.2, 0.2, 0.75, 0.3, 0.2, 0.75, 0.3, 0.3, 0.5, 1, 0.3, 0.5, 1), 3));
  return geometry;
}
