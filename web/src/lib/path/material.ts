// SPDX-License-Identifier: GPL-2.0-or-later
// The material of a path.
import { Color, GLSL3, ShaderMaterial } from 'three';
import type { ColorBy } from './shades';

export interface SceneColors {
  background: string;
  rapid: string;
  feed: string;
  arc: string;
  probe: string;
  current: string;
  limits: string;
  tool: string;
  trail: string;
  /** From slow to fast. */
  scale: readonly string[];
  /** Colours of tools, repeated after the last one. */
  tools: readonly string[];
}

export const SCALE_STOPS = 5;
export const TOOL_COLORS = 8;

// Under `flat` the point at the end of a move determines its colour.
const VERTEX = `
  in float kind;
  in float shade;
  in uint line;
  flat out float vKind;
  flat out float vShade;
  flat out uint vLine;
  void main() {
    vKind = kind;
    vShade = shade;
    vLine = line;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  }`;
const FRAGMENT = `
  precision highp float;
  flat in float vKind;
  flat in float vShade;
  flat in uint vLine;
  uniform vec3 rapid, feed, arc, probe, current, background;
  uniform vec3 scale[${SCALE_STOPS}];
  uniform vec3 tools[${TOOL_COLORS}];
  uniform int colorBy;
  uniform float fade;
  uniform uint currentLine;
  out vec4 color;
  void main() {
    vec3 shade = vKind < 0.5 ? rapid : vKind < 1.5 ? feed : vKind < 2.5 ? arc : probe;
    if (colorBy != 0 && vKind > 0.5 && vKind < 2.5) {
      if (colorBy == 2) {
        shade = tools[int(vShade) % ${TOOL_COLORS}];
      } else {
        float at = vShade / 255.0 * ${(SCALE_STOPS - 1).toFixed(1)};
        int below = min(int(at), ${SCALE_STOPS - 2});
        shade = mix(scale[below], scale[below + 1], at - float(below));
      }
    }
    shade = mix(shade, background, fade);
    if (currentLine > 0u && vLine == currentLine) { shade = current; }
    color = vec4(shade, 1.0);
  }`;

const NUMBERS: Record<ColorBy, number> = { kind: 0, feed: 1, tool: 2, speed: 1 };
const NAMES = ['rapid', 'feed', 'arc', 'probe', 'current', 'background'] as const;

/** Materials for the path, and in paler colours for the other end of a foam cutter's wire. */
export class PathMaterials {
  readonly path: ShaderMaterial;
  readonly wire: ShaderMaterial;

  constructor() {
    const uniforms: Record<string, { value: unknown }> = {
      colorBy: { value: 0 },
      currentLine: { value: 0 },
      scale: { value: Array.from({ length: SCALE_STOPS }, () => new Color()) },
      tools: { value: Array.from({ length: TOOL_COLORS }, () => new Color()) },
    };
    for (const name of NAMES) {
      uniforms[name] = { value: new Color() };
    }
    const make = (fade: number): ShaderMaterial =>
      new ShaderMaterial({ glslVersion: GLSL3, vertexShader: VERTEX, fragmentShader: FRAGMENT, uniforms: { ...uniforms, fade: { value: fade } } });
    this.path = make(0);
    this.wire = make(0.45);
  }

  setColors(colors: SceneColors): void {
    const { uniforms } = this.path;
    for (const name of NAMES) {
      uniforms[name]?.value.set(colors[name]);
    }
    (uniforms['scale']?.value as Color[]).forEach((one, i) => one.set(colors.scale[i] ?? colors.feed));
    (uniforms['tools']?.value as Color[]).forEach((one, i) => one.set(colors.tools[i] ?? colors.feed));
  }

  colorBy(what: ColorBy): void {
    const { colorBy } = this.path.uniforms;
    if (colorBy !== undefined) {
      colorBy.value = NUMBERS[what];
    }
  }

  /** False if it is the current line already. */
  setCurrentLine(line: number): boolean {
    const { currentLine } = this.path.uniforms;
    const isOther = currentLine !== undefined && currentLine.value !== line;
    if (isOther) {
      currentLine.value = line;
    }
    return isOther;
  }

  dispose(): void {
    this.path.dispose();
    this.wire.dispose();
  }
}
