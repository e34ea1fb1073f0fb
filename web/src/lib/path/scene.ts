// SPDX-License-Identifier: GPL-2.0-or-later
// The path, the tool and the limits of the machine, drawn after each change. Machine coordinates; Z points
// up.
import {
  Box3,
  BoxGeometry,
  BufferGeometry,
  Color,
  ColorManagement,
  EdgesGeometry,
  Group,
  Line,
  LinearSRGBColorSpace,
  LineBasicMaterial,
  LineSegments,
  type Material,
  MeshBasicMaterial,
  OrthographicCamera,
  Scene,
  Vector3,
  WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import type { Moves } from './chunks';
import type { Spot } from './geometry';
import { isSoftware } from './graphics';
import { makeLine, makeSegments, movesOf } from './lines';
import { PathMaterials, type SceneColors } from './material';
import { joined, Pace, shuffled } from './motion';
import { shade, type ColorBy, type Ranges, type Shading } from './shades';
import { sparse } from './sparse';
import { thin } from './thin';
import { makeCone, makeWire, tipGeometry, type LatheTip } from './tool';
import { Trail } from './trail';
import { halfSize, VIEWS, type ViewName } from './views';

export type { SceneColors } from './material';
/** A path with more points is drawn coarsely during motion if drawing is slow. */
const POINTS_IN_MOTION = 25_000;
/** Along the diagonal of the path. */
const CELLS = 250;
/** Drawing time for POINTS_IN_MOTION on a slow computer; one with a GPU takes less than a tenth. */
const SLOW_MS = 6;
const MOST_FRAME_TIMES = 600;
/** Of a display. */
const FRAME_MS = 16;
const STILL_AFTER_MS = 180;
/** Interval between frames of a long path while it is read, because reading and drawing share the processor. */
const READING_FRAME_MS = 250;

/** Number of pieces drawn coarsely at first, while the speed of the computer is not known. */
const FIRST_PACE = 6000;

/** Length of the edges of a lathe tool in the picture, as a fraction of the machine's size. */
const TIP_SHARE = 1 / 12;

/** The same moves with all points and with fewer; `coarse` while they are read. */
interface Piece {
  /** Number of its first point. */
  first: number;
  /** True for the path of the other end of a foam cutter's wire. */
  isWire: boolean;
  whole: Line;
  fine: Line | null;
  coarse: Line | null;
}

export class PathScene {
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly camera = new OrthographicCamera(-100, 100, 100, -100, -1e5, 1e5);
  private readonly controls: OrbitControls;
  private readonly materials = new PathMaterials();
  private readonly path = new Group();
  private readonly tool = makeCone();
  private readonly wire = makeWire();
  private isLatheTool = false;
  private tip: LatheTip | null = null;
  private view: ViewName = 'iso';
  private readonly limits: LineSegments;
  private readonly trail = new Trail();
  private pieces: Piece[] = [];
  private box = new Box3();
  private limitBox = new Box3();
  private frame = 0;
  private stillTimer: ReturnType<typeof setTimeout> | undefined;
  private readingTimer: ReturnType<typeof setTimeout> | undefined;
  private isMoving = false;
  /** Complete pieces take too long for this computer. */
  private isSlow = false;
  private lastFrameAt = 0;
  private askedAt = 0;
  /** The path in few pieces, for drawing during motion. */
  private motion: LineSegments | null = null;
  private pace = new Pace(0);
  /** Pieces of the fine path that have been drawn over the coarse path; null: no refinement is active. */
  private refined: number | null = null;
  private perFrame = 1;
  private isThinned = false;
  private isRead = false;
  private generation = 0;
  private readonly seen = new Set<number>();
  private points = 0;
  /** Duration of the last frames during motion. [ms] */
  readonly frameTimes: number[] = [];

  constructor(canvas: HTMLCanvasElement) {
    ColorManagement.enabled = false; // colours are those of the page
    this.renderer = new WebGLRenderer({ canvas, antialias: window.devicePixelRatio < 2 && !isSoftware(), powerPreference: 'low-power', preserveDrawingBuffer: true });
    this.renderer.outputColorSpace = LinearSRGBColorSpace;
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false;
    // refinement must not occur before its first move
    this.controls.addEventListener('start', () => this.noteMotion());
    this.controls.addEventListener('change', () => this.noteMotion());
    this.limits = new LineSegments(new BufferGeometry(), new LineBasicMaterial());
    this.scene.add(this.path, this.limits, this.trail.line, this.tool, this.wire);
    this.look('iso');
  }

  setColors(colors: SceneColors): void {
    this.renderer.setClearColor(new Color(colors.background));
    this.materials.setColors(colors);
    (this.limits.material as LineBasicMaterial).color.set(colors.limits);
    this.trail.setColor(colors.trail);
    (this.tool.material as MeshBasicMaterial).color.set(colors.tool);
    (this.wire.material as LineBasicMaterial).color.set(colors.tool);
    this.draw();
  }

  clearPath(): void {
    for (const { whole, fine, coarse } of this.pieces) {
      whole.geometry.dispose();
      fine?.geometry.dispose();
      coarse?.geometry.dispose();
    }
    this.path.clear();
    this.pieces = [];
    this.points = 0;
    this.isSlow = false;
    this.isThinned = false;
    this.isRead = false;
    this.generation += 1;
    this.seen.clear();
    this.motion?.geometry.dispose();
    this.motion = null;
    this.refined = null;
    this.box.makeEmpty();
    this.trail.clear();
    this.draw();
  }

  /** The first point is the end of the previous moves. `isWire`: the same moves at the other end of the wire, added after
   * those of the tool. */
  addMoves(moves: Moves, isWire = false): void {
    const whole = makeLine(moves, this.materialOf(isWire));
    const first = isWire ? this.points - moves.count : Math.max(this.points - 1, 0);
    const isFirst = this.box.isEmpty();
    this.box.union(whole.geometry.boundingBox ?? new Box3());
    this.points = isWire ? this.points : first + moves.count;
    // While a long path is read it is drawn coarsely, because each chunk causes a new drawing.
    const isLong = this.points > POINTS_IN_MOTION;
    const cell = this.box.getSize(new Vector3()).length() / CELLS;
    const coarse = isLong ? makeSegments(sparse(moves, cell, this.seen), this.materialOf(isWire)) : null;
    const piece = { whole, fine: null, coarse, first: Math.max(first, 0), isWire };
    this.pieces.push(piece);
    if (this.isShown(piece)) {
      this.path.add(coarse ?? whole);
    }
    if (isFirst) {
      this.fit();
    } else if (!isLong || this.isMoving) {
      this.draw();
    } else {
      this.readingTimer ??= setTimeout(() => this.draw(), READING_FRAME_MS);
    }
  }

  /** Called at the end of the path. */
  async finish(): Promise<void> {
    this.isRead = true;
    this.fit();
    await this.prepareForMotion();
  }

  /** Prepares the pieces of a long path for slow drawing one by one, so that jogs are renewed. */
  private async prepareForMotion(): Promise<void> {
    if (this.points <= POINTS_IN_MOTION) {
      this.showAll();
      return;
    }
    const mine = ++this.generation;
    const size = this.box.getSize(new Vector3()).length();
    const seen = new Set<number>();
    const parts: Moves[] = [];
    for (const piece of this.pieces) {
      const moves = movesOf(piece.whole);
      piece.fine?.geometry.dispose();
      const fewer = thin(moves, size / 2000);
      piece.fine = fewer === moves ? null : makeLine(fewer, this.materialOf(piece.isWire));
      if (this.isShown(piece)) {
        parts.push(sparse(moves, size / CELLS, seen));
      }
      await new Promise((done) => setTimeout(done));
      if (mine !== this.generation) {
        return; // another program is open
      }
    }
    const pairs = shuffled(joined(parts));
    this.motion?.geometry.dispose();
    this.motion = makeSegments(pairs, this.materials.path);
    this.pace = new Pace(pairs.count / 2, FIRST_PACE);
    this.isThinned = true;
    this.isSlow = this.measure();
    this.showAll();
  }

  private isShown(piece: Piece): boolean {
    return this.view === 'xy' ? !piece.isWire : this.view === 'uv' ? piece.isWire : true;
  }

  private showAll(): void {
    this.path.clear();
    const pieces = this.pieces.filter((piece) => this.isShown(piece));
    this.path.add(...(this.isSlow && this.motion !== null ? [this.motion] : pieces.map((piece) => piece.whole)));
    this.draw();
  }

  /** Colours the path by these values; without values, by the type of moves. */
  async setColoring(by: ColorBy, ranges: Ranges | null, shading: Shading): Promise<void> {
    this.materials.colorBy(ranges === null ? 'kind' : by);
    if (ranges !== null) {
      for (const piece of this.pieces) {
        shade(movesOf(piece.whole), piece.first, ranges, shading);
        const attribute = piece.whole.geometry.getAttribute('shade');
        attribute.needsUpdate = true;
      }
      if (this.isRead) {
        await this.prepareForMotion();
      }
    }
    this.draw();
  }

  setLimits(low: [number, number, number], high: [number, number, number]): void {
    this.limitBox.set(new Vector3(...low), new Vector3(...high));
    const size = this.limitBox.getSize(new Vector3());
    const box = new BoxGeometry(size.x, size.y, size.z);
    this.limits.geometry.dispose();
    this.limits.geometry = new EdgesGeometry(box);
    box.dispose();
    this.limitBox.getCenter(this.limits.position);
    this.limits.visible = true;
    this.makeTip();
    if (this.box.isEmpty()) {
      this.fit();
    }
    this.draw();
  }

  /** For tests: the pieces of a long path that are drawn while it is rotated. */
  get piecesInMotion(): number {
    return this.pace.pieces;
  }

  isBeyondLimits(): boolean {
    const slack = 1e-4;
    return !this.box.isEmpty() && !this.limitBox.isEmpty() && !this.limitBox.clone().expandByScalar(slack).containsBox(this.box);
  }

  /** Hides the limits, because the picture is not in their coordinates. */
  hideLimits(): void {
    this.limitBox.makeEmpty();
    this.limits.visible = false;
  }

  /** Sets the position of the controlled point, with a trail of earlier positions. `other`: the other end of a foam cutter's wire. */
  setTool(spot: Spot, isCutting: boolean, other: Spot | null = null): void {
    const [x, y, z] = spot;
    const { position } = this.tool;
    const ends = this.wire.geometry.getAttribute('position');
    const isSame = other === null || (this.wire.visible && ends.getX(1) === Math.fround(other[0]) && ends.getY(1) === Math.fround(other[1]));
    if (position.x === x && position.y === y && position.z === z && isSame) {
      return;
    }
    position.set(x, y, z);
    this.wire.visible = other !== null;
    this.tool.visible = other === null && (!this.isLatheTool || this.tip !== null);
    if (other !== null) {
      ends.setXYZ(0, x, y, z);
      ends.setXYZ(1, ...other);
      ends.needsUpdate = true;
    }
    if (isCutting) {
      this.trail.add(x, y, z);
    }
    this.noteMotion();
  }

  /** Draws the tool of a lathe; null: the spindle is empty. */
  setLatheTool(tip: LatheTip | null): void {
    this.isLatheTool = true;
    this.tip = tip;
    this.makeTip();
    this.draw();
  }

  private makeTip(): void {
    if (!this.isLatheTool) {
      return;
    }
    const length = this.limitBox.isEmpty() ? 20 : this.limitBox.getSize(new Vector3()).length() * TIP_SHARE;
    this.tool.visible = this.tip !== null;
    if (this.tip !== null) {
      this.tool.geometry.dispose();
      this.tool.geometry = tipGeometry(this.tip, length);
      this.tool.scale.setScalar(1);
    }
  }

  setCurrentLine(line: number): void {
    if (this.materials.setCurrentLine(line)) {
      this.draw();
    }
  }

  look(name: ViewName): void {
    const { from, up, isFlat } = VIEWS[name];
    const isOther = this.isShownBy(name) !== this.isShownBy(this.view);
    this.view = name;
    const target = this.controls.target;
    this.camera.up.set(...up);
    this.camera.position.set(target.x + from[0] * 1000, target.y + from[1] * 1000, target.z + from[2] * 1000);
    this.camera.lookAt(target);
    this.controls.enableRotate = isFlat !== true;
    this.fit();
    if (isOther) {
      void this.prepareForMotion();
    }
  }

  private isShownBy(view: ViewName): string {
    return view === 'xy' || view === 'uv' ? view : 'all';
  }

  /** Fits the path into the picture, or the machine's working space if there is no path. */
  fit(): void {
    const box = this.box.isEmpty() ? this.limitBox : this.box;
    if (box.isEmpty()) {
      return;
    }
    const centre = box.getCenter(new Vector3());
    const offset = this.camera.position.clone().sub(this.controls.target).setLength(1000);
    this.controls.target.copy(centre);
    this.camera.position.copy(centre).add(offset);
    this.camera.lookAt(centre);
    this.camera.updateMatrixWorld();
    const [wide, high] = halfSize(box, this.camera.matrixWorldInverse);
    const room = 1.12;
    this.camera.zoom = 1 / (room * Math.max(wide / this.camera.right, high / this.camera.top));
    this.camera.updateProjectionMatrix();
    this.scaleTool();
    this.draw();
  }

  resize(width: number, height: number): void {
    if (width < 2 || height < 2) {
      return;
    }
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    const half = 100;
    const aspect = width / height;
    this.camera.top = half;
    this.camera.bottom = -half;
    this.camera.right = half * aspect;
    this.camera.left = -half * aspect;
    this.camera.updateProjectionMatrix();
    this.fit();
  }

  dispose(): void {
    this.clearPath();
    cancelAnimationFrame(this.frame);
    clearTimeout(this.stillTimer);
    this.controls.dispose();
    this.materials.dispose();
    this.renderer.dispose();
  }

  private materialOf(isWire: boolean): Material {
    return isWire ? this.materials.wire : this.materials.path;
  }

  private noteMotion(): void {
    this.isMoving = true;
    clearTimeout(this.stillTimer);
    this.stillTimer = setTimeout(() => {
      this.isMoving = false;
      this.draw();
    }, STILL_AFTER_MS);
    this.scaleTool();
    this.draw();
  }

  /** Keeps the size on the screen constant at any zoom. */
  private scaleTool(): void {
    if (this.isLatheTool) {
      return;
    }
    this.tool.scale.setScalar(1 / this.camera.zoom);
  }

  private stopReadingTimer(): void {
    clearTimeout(this.readingTimer);
    this.readingTimer = undefined;
  }

  private draw(): void {
    this.stopReadingTimer();
    this.refined = null; // draws the refined part again
    this.ask();
  }

  private ask(): void {
    if (this.frame === 0) {
      this.askedAt = performance.now();
      this.frame = requestAnimationFrame(() => this.drawFrame());
    }
  }

  private drawFrame(): void {
    this.frame = 0;
    this.judgeFrame();
    if (this.refined !== null) {
      this.refine(this.refined);
      return;
    }
    if (this.isThinned && this.isSlow) {
      this.motion?.geometry.setDrawRange(0, this.pace.pieces * 2);
    }
    this.renderer.render(this.scene, this.camera);
    if (this.isThinned && this.isSlow && !this.isMoving) {
      this.perFrame = 1;
      this.askToRefine(0);
    }
  }

  /** Draws the fine path over the coarse path, a few pieces in each frame, so that the next touch is not delayed. */
  private refine(done: number): void {
    const pieces = this.pieces.slice(done, done + this.perFrame);
    this.path.clear();
    this.path.add(...pieces.filter((piece) => this.isShown(piece)).map((piece) => piece.fine ?? piece.whole));
    this.renderer.autoClear = false;
    this.renderer.render(this.scene, this.camera);
    this.renderer.autoClear = true;
    this.path.clear();
    this.path.add(...(this.motion === null ? [] : [this.motion]));
    this.askToRefine(done + pieces.length);
  }

  private askToRefine(done: number): void {
    this.refined = done < this.pieces.length ? done : null;
    if (this.refined !== null) {
      this.ask();
    }
  }

  /** The time is measured from the previous frame, or from the request of this frame if nothing was drawn in between. */
  private judgeFrame(): void {
    const now = performance.now();
    const took = now - Math.max(this.lastFrameAt, this.askedAt - FRAME_MS);
    this.lastFrameAt = now;
    if (this.isMoving) {
      this.frameTimes.push(took);
      this.pace.note(took);
    } else if (this.refined !== null) {
      this.perFrame = took < 20 ? Math.min(this.perFrame * 2, 16) : took > 30 ? Math.max(this.perFrame >> 1, 1) : this.perFrame;
    }
    if (this.frameTimes.length > MOST_FRAME_TIMES) {
      this.frameTimes.shift();
    }
  }

  /** Draws the coarse path, which is short for any computer, and measures its time. */
  private measure(): boolean {
    this.path.clear();
    this.path.add(...(this.motion === null ? [] : [this.motion]));
    const gl = this.renderer.getContext();
    const pixel = new Uint8Array(4);
    this.renderer.render(this.scene, this.camera); // created at first use
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
    const begin = performance.now();
    this.renderer.render(this.scene, this.camera);
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel); // waits until it is drawn
    return performance.now() - begin > SLOW_MS;
  }
}
