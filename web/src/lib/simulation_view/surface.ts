// SPDX-License-Identifier: GPL-2.0-or-later
// The stock as a shaded surface: a flat grid that the vertex shader raises to the heights of a texture. A new
// picture changes only the texture.
import { BufferAttribute, BufferGeometry, Color, DataTexture, FloatType, GLSL3, Mesh, NearestFilter, RedFormat, ShaderMaterial, UnsignedByteType, Vector2, Vector3 } from 'three';
import type { Picture } from '../simulation/display';
import type { Stock } from '../simulation/stock';

export const MAKER_COLORS = 8;

// A ring of points around the cells extends down to the bottom and forms the sides of the stock.
const VERTEX = `
  precision highp float;
  precision highp sampler2D;
  uniform sampler2D heights;
  uniform vec2 cells;
  uniform vec2 corner;
  uniform vec2 size;
  uniform vec2 extent;
  uniform float bottom;
  out vec3 vPlace;
  out vec3 vNormal;
  out float vHeight;
  out float vSide;
  float heightOf(ivec2 cell) { return texelFetch(heights, clamp(cell, ivec2(0), ivec2(cells) - 1), 0).r; }
  void main() {
    ivec2 cell = ivec2(position.xy);
    bool isRing = cell.x < 0 || cell.y < 0 || cell.x >= int(cells.x) || cell.y >= int(cells.y);
    ivec2 inside = clamp(cell, ivec2(0), ivec2(cells) - 1);
    float z = isRing ? bottom : texelFetch(heights, inside, 0).r;
    vec2 at = isRing ? clamp((vec2(cell) + 0.5) * size, vec2(0.0), extent) : min((vec2(cell) + 0.5) * size, extent);
    if (cell.x == 0) { at.x = 0.0; }
    if (cell.y == 0) { at.y = 0.0; }
    if (cell.x == int(cells.x) - 1) { at.x = extent.x; }
    if (cell.y == int(cells.y) - 1) { at.y = extent.y; }
    vPlace = vec3(corner + at, z);
    vHeight = z;
    vSide = isRing ? 1.0 : 0.0;
    // The slope of the surface around the cell, so that the steps of a slanted wall are not visible as stripes.
    vec2 slope = vec2(heightOf(inside - ivec2(1, 0)) - heightOf(inside + ivec2(1, 0)), heightOf(inside - ivec2(0, 1)) - heightOf(inside + ivec2(0, 1))) / (2.0 * size);
    vNormal = vec3(slope, 1.0);
    gl_Position = projectionMatrix * modelViewMatrix * vec4(vPlace, 1.0);
  }`;
const FRAGMENT = `
  precision highp float;
  precision highp sampler2D;
  in vec3 vPlace;
  in vec3 vNormal;
  in float vHeight;
  in float vSide;
  uniform sampler2D makers;
  uniform vec2 cells;
  uniform vec2 corner;
  uniform vec2 size;
  uniform float bottom;
  uniform float top;
  uniform int colorBy;
  uniform vec3 uncut;
  uniform vec3 tools[${MAKER_COLORS}];
  uniform vec3 shallow;
  uniform vec3 deep;
  uniform vec3 light;
  out vec4 color;
  int makerOf(ivec2 cell) { return int(texelFetch(makers, clamp(cell, ivec2(0), ivec2(cells) - 1), 0).r * 255.0 + 0.5); }
  void main() {
    if (vHeight <= bottom + 0.0005 * (top - bottom)) { discard; }
    vec3 normal = normalize(vNormal);
    ivec2 cell = clamp(ivec2((vPlace.xy - corner) / size), ivec2(0), ivec2(cells) - 1);
    int maker = makerOf(cell);
    if (maker == 0 && vHeight < top - 0.001 * (top - bottom)) {
      // A wall is coloured for the tool that has cut its lower side.
      maker = max(max(makerOf(cell + ivec2(1, 0)), makerOf(cell - ivec2(1, 0))), max(makerOf(cell + ivec2(0, 1)), makerOf(cell - ivec2(0, 1))));
    }
    if (vSide > 0.01) { maker = 0; }
    vec3 base = uncut;
    if (maker > 0) {
      base = colorBy == 1 ? mix(shallow, deep, clamp((top - vHeight) / max(top - bottom, 1e-6), 0.0, 1.0)) : tools[(maker - 1) % ${MAKER_COLORS}];
    }
    float shade = 0.45 + 0.55 * max(dot(normal, light), 0.0);
    color = vec4(base * shade, 1.0);
  }`;

export interface SurfaceColors {
  uncut: string;
  tools: readonly string[];
  shallow: string;
  deep: string;
}

export class Surface {
  readonly mesh: Mesh<BufferGeometry, ShaderMaterial>;
  private heights: DataTexture | null = null;
  private makers: DataTexture | null = null;
  private nx = 0;
  private ny = 0;

  constructor() {
    const material = new ShaderMaterial({
      glslVersion: GLSL3,
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      uniforms: {
        heights: { value: null },
        makers: { value: null },
        cells: { value: new Vector2() },
        corner: { value: new Vector2() },
        size: { value: new Vector2() },
        extent: { value: new Vector2() },
        bottom: { value: 0 },
        top: { value: 0 },
        colorBy: { value: 0 },
        uncut: { value: new Color() },
        tools: { value: Array.from({ length: MAKER_COLORS }, () => new Color()) },
        shallow: { value: new Color() },
        deep: { value: new Color() },
        light: { value: new Vector3(0.35, -0.5, 0.8).normalize() },
      },
    });
    this.mesh = new Mesh(new BufferGeometry(), material);
    this.mesh.frustumCulled = false;
    this.mesh.visible = false;
  }

  setColors(colors: SurfaceColors): void {
    for (const name of ['uncut', 'shallow', 'deep'] as const) {
      (this.value(name) as Color).set(colors[name]);
    }
    (this.value('tools') as Color[]).forEach((one, i) => one.set(colors.tools[i % colors.tools.length] ?? colors.uncut));
  }

  colorBy(what: 'tool' | 'depth'): void {
    this.set('colorBy', what === 'depth' ? 1 : 0);
  }

  private value(name: string): unknown {
    return this.mesh.material.uniforms[name]?.value;
  }

  private set(name: string, value: unknown): void {
    const uniform = this.mesh.material.uniforms[name];
    if (uniform !== undefined) {
      uniform.value = value;
    }
  }

  show(picture: Picture, stock: Stock): void {
    if (picture.nx !== this.nx || picture.ny !== this.ny) {
      this.make(picture.nx, picture.ny);
    }
    const { heights, makers } = this;
    if (heights !== null && makers !== null) {
      (heights.image as { data: unknown }).data = picture.heights;
      (makers.image as { data: unknown }).data = picture.makers;
      heights.needsUpdate = true;
      makers.needsUpdate = true;
    }
    (this.value('size') as Vector2).set(picture.cell_x, picture.cell_y);
    (this.value('corner') as Vector2).set(stock.low[0], stock.low[1]);
    (this.value('extent') as Vector2).set(stock.high[0] - stock.low[0], stock.high[1] - stock.low[1]);
    this.set('bottom', stock.low[2]);
    this.set('top', stock.high[2]);
    this.mesh.visible = true;
  }

  hide(): void {
    this.mesh.visible = false;
  }

  private make(nx: number, ny: number): void {
    [this.nx, this.ny] = [nx, ny];
    this.heights?.dispose();
    this.makers?.dispose();
    const texture = (data: Float32Array<ArrayBuffer> | Uint8Array<ArrayBuffer>): DataTexture => {
      const made = new DataTexture(data, nx, ny, RedFormat, data instanceof Float32Array ? FloatType : UnsignedByteType);
      made.minFilter = NearestFilter;
      made.magFilter = NearestFilter;
      made.unpackAlignment = 1;
      made.generateMipmaps = false;
      return made;
    };
    this.heights = texture(new Float32Array(nx * ny));
    this.makers = texture(new Uint8Array(nx * ny));
    this.set('heights', this.heights);
    this.set('makers', this.makers);
    (this.value('cells') as Vector2).set(nx, ny);
    this.mesh.geometry.dispose();
    this.mesh.geometry = grid(nx, ny);
  }

  dispose(): void {
    this.heights?.dispose();
    this.makers?.dispose();
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }
}

/** Points from -1 to the number of cells along each side, and the triangles between them. */
function grid(nx: number, ny: number): BufferGeometry {
  const [wide, high] = [nx + 2, ny + 2];
  const points = new Int16Array(wide * high * 3);
  for (let j = 0, at = 0; j < high; ++j) {
    for (let i = 0; i < wide; ++i, at += 3) {
      points[at] = i - 1;
      points[at + 1] = j - 1;
    }
  }
  const triangles = new Uint32Array((wide - 1) * (high - 1) * 6);
  for (let j = 0, at = 0; j + 1 < high; ++j) {
    for (let i = 0; i + 1 < wide; ++i, at += 6) {
      const first = j * wide + i;
      triangles.set([first, first + 1, first + wide, first + 1, first + wide + 1, first + wide], at);
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(points, 3));
  geometry.setIndex(new BufferAttribute(triangles, 1));
  return geometry;
}
