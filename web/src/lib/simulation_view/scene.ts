// SPDX-License-Identifier: GPL-2.0-or-later
// The picture of the simulation, drawn after each change. Work coordinates; Z points up. [mm]
import { Box3, BufferGeometry, Color, ColorManagement, DoubleSide, Group, LinearSRGBColorSpace, LineBasicMaterial, LineSegments, Mesh, MeshBasicMaterial, MeshLambertMaterial, OrthographicCamera, AmbientLight, DirectionalLight, Scene, SphereGeometry, Vector3, WebGLRenderer } from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { isSoftware } from '../path/graphics';
import { halfSize, VIEWS, type ViewName } from '../path/views';
import { reduced, type Picture } from '../simulation/display';
import type { ToolShape } from '../simulation/shapes';
import type { Fixture, Stock, Triple } from '../simulation/stock';
import { axesGeometry, boxGeometry, edgesOf, holderGeometry, toolGeometry } from './models';
import { Surface, type SurfaceColors } from './surface';

export interface SceneColors extends SurfaceColors {
  background: string;
  edges: string;
  tool: string;
  holder: string;
  fixture: string;
  finding: string;
}

/** Maximum cells of the picture along a side while it changes, and when it is still. */
const MOST_IN_MOTION = { software: 96, hardware: 512 };
const MOST_STILL = { software: 384, hardware: 1024 };
const MOST_FRAME_TIMES = 600;
const STILL_AFTER_MS = 180;

/** Slightly wider than the stock. */
function floorUnder(stock: Stock, floor_mm: number): { low: Triple; high: Triple } {
  const margin = Math.max(stock.high[0] - stock.low[0], stock.high[1] - stock.low[1]) / 10;
  return { low: [stock.low[0] - margin, stock.low[1] - margin, floor_mm], high: [stock.high[0] + margin, stock.high[1] + margin, floor_mm] };
}

export class SimulationScene {
  readonly isSlow = isSoftware();
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly camera = new OrthographicCamera(-100, 100, 100, -100, -1e5, 1e5);
  private readonly controls: OrbitControls;
  /** Drawn during motion (coarse) and at standstill (fine). */
  private readonly coarse = new Surface();
  private readonly fine = new Surface();
  private hasFine = false;
  private stillTimer: ReturnType<typeof setTimeout> | undefined;
  private readonly tool = new Mesh(new BufferGeometry(), new MeshLambertMaterial({ side: DoubleSide }));
  private readonly holder = new Mesh(new BufferGeometry(), new MeshLambertMaterial({ side: DoubleSide, transparent: true, opacity: 0.45 }));
  private readonly fixtures = new Group();
  private readonly fixture_material = new MeshLambertMaterial();
  private readonly edges = new LineSegments(new BufferGeometry(), new LineBasicMaterial());
  /** The lowest position of a tool. */
  private readonly floor = new LineSegments(new BufferGeometry(), new LineBasicMaterial());
  private readonly axes = new LineSegments(axesGeometry(1), new LineBasicMaterial({ vertexColors: true, depthTest: false }));
  private readonly mark = new Mesh(new SphereGeometry(1, 16, 12), new MeshBasicMaterial({ depthTest: false, transparent: true, opacity: 0.85 }));
  private readonly box = new Box3();
  private stock: Stock | null = null;
  private shown_tool = '';
  private frame = 0;
  private last_frame = 0;
  /** Duration of the last consecutive frames. [ms] */
  readonly frameTimes: number[] = [];
  /** Number of drawn pictures. */
  pictures = 0;

  constructor(canvas: HTMLCanvasElement) {
    ColorManagement.enabled = false; // colours are those of the page
    this.renderer = new WebGLRenderer({ canvas, antialias: !this.isSlow, powerPreference: 'low-power' });
    this.renderer.outputColorSpace = LinearSRGBColorSpace;
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false;
    this.controls.addEventListener('change', () => this.noteMotion());
    const light = new DirectionalLight('#ffffff', 2);
    light.position.set(0.35, -0.5, 0.8);
    this.tool.visible = this.holder.visible = this.mark.visible = false;
    this.mark.renderOrder = 2;
    this.axes.renderOrder = 1;
    this.scene.add(this.coarse.mesh, this.fine.mesh, this.tool, this.holder, this.fixtures, this.edges, this.floor, this.axes, this.mark, light, new AmbientLight('#ffffff', 1.4));
    this.look('iso');
  }

  /** Cells along a side of the next picture. */
  cells(isMoving: boolean): number {
    return (isMoving ? MOST_IN_MOTION : MOST_STILL)[this.isSlow ? 'software' : 'hardware'];
  }

  setColors(colors: SceneColors): void {
    this.renderer.setClearColor(new Color(colors.background));
    this.coarse.setColors(colors);
    this.fine.setColors(colors);
    this.tool.material.color.set(colors.tool);
    this.holder.material.color.set(colors.holder);
    this.fixture_material.color.set(colors.fixture);
    this.edges.material.color.set(colors.edges);
    this.floor.material.color.set(colors.fixture);
    this.mark.material.color.set(colors.finding);
    this.draw();
  }

  colorBy(what: 'tool' | 'depth'): void {
    this.coarse.colorBy(what);
    this.fine.colorBy(what);
    this.draw();
  }

  /** Shows outlines until a picture of the stock is available. */
  setStock(stock: Stock, fixtures: readonly Fixture[], floor_mm: number): void {
    const isFirst = this.stock === null;
    this.stock = stock;
    this.coarse.hide();
    this.fine.hide();
    this.hasFine = false;
    this.edges.geometry.dispose();
    this.edges.geometry = edgesOf(stock);
    for (const child of this.fixtures.children) {
      (child as Mesh).geometry.dispose();
    }
    this.fixtures.clear();
    this.floor.geometry.dispose();
    this.floor.geometry = edgesOf(floorUnder(stock, floor_mm));
    this.box.makeEmpty();
    this.box.expandByPoint(new Vector3(...stock.low)).expandByPoint(new Vector3(...stock.high));
    const size = this.box.getSize(new Vector3());
    this.axes.scale.setScalar(Math.max(size.x, size.y) / 5);
    for (const fixture of fixtures) {
      this.fixtures.add(new Mesh(boxGeometry(fixture), this.fixture_material));
      this.box.expandByPoint(new Vector3(...fixture.low)).expandByPoint(new Vector3(...fixture.high));
    }
    this.box.expandByPoint(new Vector3());
    this.mark.scale.setScalar(Math.max(size.x, size.y) / 60);
    if (isFirst) {
      this.fit();
    }
    this.draw();
  }

  show(picture: Picture): void {
    if (this.stock !== null) {
      const most = this.cells(true);
      this.hasFine = Math.max(picture.nx, picture.ny) > most;
      if (this.hasFine) {
        this.fine.show(picture, this.stock);
      }
      this.coarse.show(this.hasFine ? reduced(picture, most) : picture, this.stock);
      this.choose(this.hasFine);
      this.pictures += 1;
      this.draw();
    }
  }

  setTool(shape: ToolShape | null, tip: Triple): void {
    const wanted = shape === null ? '' : JSON.stringify(shape);
    this.tool.visible = this.holder.visible = shape !== null && shape.diameter_mm > 0;
    if (wanted !== this.shown_tool && shape !== null) {
      this.tool.geometry.dispose();
      this.holder.geometry.dispose();
      this.tool.geometry = toolGeometry(shape);
      this.holder.geometry = holderGeometry(shape);
    }
    this.shown_tool = wanted;
    this.tool.position.set(...tip);
    this.holder.position.set(...tip);
    this.draw();
  }

  setMark(place: Triple | null): void {
    this.mark.visible = place !== null;
    if (place !== null) {
      this.mark.position.set(...place);
    }
    this.draw();
  }

  look(name: ViewName): void {
    const { from, up } = VIEWS[name];
    const { target } = this.controls;
    this.camera.up.set(...up);
    this.camera.position.set(target.x + from[0] * 1000, target.y + from[1] * 1000, target.z + from[2] * 1000);
    this.camera.lookAt(target);
    this.fit();
  }

  fit(): void {
    if (this.box.isEmpty()) {
      return;
    }
    const centre = this.box.getCenter(new Vector3());
    const offset = this.camera.position.clone().sub(this.controls.target).setLength(1000);
    this.controls.target.copy(centre);
    this.camera.position.copy(centre).add(offset);
    this.camera.lookAt(centre);
    this.camera.updateMatrixWorld();
    const [wide, high] = halfSize(this.box, this.camera.matrixWorldInverse);
    const MARGIN = 1.2;
    this.camera.zoom = 1 / (MARGIN * Math.max(wide / this.camera.right, high / this.camera.top));
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  resize(width: number, height: number): void {
    if (width < 2 || height < 2) {
      return;
    }
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, this.isSlow ? 1 : 2));
    this.renderer.setSize(width, height, false);
    const HALF = 100;
    this.camera.top = HALF;
    this.camera.bottom = -HALF;
    this.camera.right = (HALF * width) / height;
    this.camera.left = -this.camera.right;
    this.camera.updateProjectionMatrix();
    this.fit();
  }

  dispose(): void {
    cancelAnimationFrame(this.frame);
    this.controls.dispose();
    clearTimeout(this.stillTimer);
    this.coarse.dispose();
    this.fine.dispose();
    this.tool.geometry.dispose();
    this.holder.geometry.dispose();
    this.renderer.dispose();
  }

  private choose(isFine: boolean): void {
    this.fine.mesh.visible = isFine;
    this.coarse.mesh.visible = !isFine;
  }

  /** The camera moves. The fine surface is drawn again when it stops. */
  private noteMotion(): void {
    if (this.hasFine) {
      this.choose(false);
      clearTimeout(this.stillTimer);
      this.stillTimer = setTimeout(() => {
        if (this.hasFine) {
          this.choose(true);
          this.draw();
        }
      }, STILL_AFTER_MS);
    }
    this.draw();
  }

  private draw(): void {
    if (this.frame === 0) {
      this.frame = requestAnimationFrame(() => this.drawFrame());
    }
  }

  private drawFrame(): void {
    this.frame = 0;
    const now = performance.now();
    this.frameTimes.push(now - this.last_frame);
    this.last_frame = now;
    if (this.frameTimes.length > MOST_FRAME_TIMES) {
      this.frameTimes.shift();
    }
    this.renderer.render(this.scene, this.camera);
  }
}
