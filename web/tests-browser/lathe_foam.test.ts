// SPDX-License-Identifier: GPL-2.0-or-later
// Tests the views of a lathe and a foam cutter, and the colours of a path.
import { afterAll, describe, expect, it } from 'vitest';
import type { Page } from 'playwright-core';
import { errorsOf, judgeByAxe, Rig, sleep, text, until, untilText } from './rig';

const rigs: Rig[] = [];
const PICTURES = process.env['MW_SCREEN_PICTURES'];

async function start(machine: string, change: (ini: string) => string, program: string): Promise<{ rig: Rig; page: Page }> {
  const rig = new Rig(change, machine);
  rigs.push(rig);
  rig.write('part.ngc', program);
  await rig.startServer();
  await rig.startMachine();
  const page = await rig.page();
  await page.getByTestId('tab-programs').click();
  await page.getByTestId('open-part.ngc').click();
  await page.getByTestId('path-done').waitFor();
  return { rig, page };
}

afterAll(async () => {
  await Promise.all(rigs.map((rig) => rig.end()));
});

/** Saves a picture of the path in each size. */
async function pictures(page: Page, name: string): Promise<void> {
  for (const [width, height] of PICTURES === undefined ? [] : ([[390, 844], [800, 480], [1280, 800]] as const)) {
    await page.setViewportSize({ width, height });
    await page.getByTestId('tab-path').click();
    await sleep(600);
    await page.screenshot({ path: `${PICTURES}/${name}_${width}x${height}.png` });
  }
}

/** Position of a point in the orthographic camera, as fractions of the picture to the right and up. */
async function seen(page: Page, point: [number, number, number]): Promise<{ right: number; up: number }> {
  return page.evaluate((at) => {
    const scene = (document.querySelector('canvas') as unknown as { scene: { camera: { position: { clone(): { set(...a: number[]): { project(c: unknown): { x: number; y: number } } } } } } }).scene;
    const spot = scene.camera.position.clone().set(...at).project(scene.camera);
    return { right: spot.x, up: spot.y };
  }, point);
}

/** Fraction of the picture with about this colour. */
async function pixelsOf(page: Page, color: [number, number, number]): Promise<number> {
  return page.evaluate((wanted) => {
    const canvas = document.querySelector('canvas') as HTMLCanvasElement;
    const copy = document.createElement('canvas');
    [copy.width, copy.height] = [canvas.width, canvas.height];
    const pen = copy.getContext('2d') as CanvasRenderingContext2D;
    pen.drawImage(canvas, 0, 0);
    const { data } = pen.getImageData(0, 0, copy.width, copy.height);
    let count = 0;
    for (let i = 0; i < data.length; i += 4) {
      count += Math.abs((data[i] ?? 0) - wanted[0]) + Math.abs((data[i + 1] ?? 0) - wanted[1]) + Math.abs((data[i + 2] ?? 0) - wanted[2]) < 12 ? 1 : 0;
    }
    return count;
  }, color);
}

const TURNING = 'G21 G90 G18 G8 F300\nT1 M6\nG0 X25 Z2\nG1 Z-30\nG1 X30 F600\nG0 X40 Z10\nT2 M6\nG1 X20 Z0 F300\nG1 Z-20\nM2\n';

describe.each([['lathe', 'before', -1], ['back_lathe', 'behind', 1]] as const)('%s', (kind, _where, up) => {
  let page: Page;
  let rig: Rig;
  it('is seen with Z to the right, and X towards the tool', async () => {
    ({ rig, page } = await start('lathe', (ini) => (kind === 'lathe' ? ini : ini.replace('LATHE = 1', 'LATHE = 1\nBACK_TOOL_LATHE = 1')), TURNING));
    const canvas = page.getByTestId('path-canvas');
    await until(async () => (await canvas.getAttribute('data-view')) === kind, 'the view of a lathe');
    const [origin, z, x] = [await seen(page, [0, 0, 0]), await seen(page, [0, 0, 10]), await seen(page, [10, 0, 0])];
    expect(z.right - origin.right).toBeGreaterThan(0.01);
    expect(z.up - origin.up).toBeCloseTo(0, 6);
    expect((x.up - origin.up) * up).toBeGreaterThan(0.01);
    expect(x.right - origin.right).toBeCloseTo(0, 6);
    expect(await text(page, 'path-extents')).toMatch(/^X r 20\.000 … 60\.000 {1,2}Z -30\.000 … 80\.000 mm/);
  });

  it('shows X as programs count it, and takes offsets so', async () => {
    await page.getByTestId('reset').click();
    await page.getByTestId('on').click();
    await untilText(page, 'state', 'On');
    await page.getByTestId('home-all').click();
    await untilText(page, 'homed-1', 'homed', 30_000);
    await untilText(page, 'run-state', 'Idle');
    await untilText(page, 'letter-X', 'X r');
    await untilText(page, 'machine-X', '50.000');
    const send = async (line: string): Promise<void> => {
      await page.getByTestId('mdi-line').fill(line);
      await page.getByTestId('mdi-send').click();
      await untilText(page, 'run-state', 'Idle');
    };
    await send('G7');
    await untilText(page, 'letter-X', 'X⌀');
    await untilText(page, 'machine-X', '100.000');
    await page.getByTestId('touch-X').click();
    await page.getByTestId('touch-off-value').fill('30');
    await page.getByTestId('touch-off-set').click();
    await untilText(page, 'work-X', '30.000');
    await page.getByTestId('tab-offsets').click();
    await page.getByTestId('offsets-all').locator('summary').click();
    await untilText(page, 'all-G54-X', '35.000'); // radii: 50 - 15
    await page.getByTestId('all-G54-X').click();
    await page.getByTestId('offset-value').fill('20');
    await page.keyboard.press('Enter');
    await untilText(page, 'all-G54-X', '20.000');
    await untilText(page, 'work-X', '60.000');
    await send('T1 M6');
    await untilText(page, 'tool', 'T1');
    await send('G0 X70 Z5');
    await page.getByTestId('tab-path').click();
    await until(async () => (await pixelsOf(page, [0xd9, 0x98, 0x43])) > 20, 'the tip of the tool');
    await pictures(page, kind);
    expect(errorsOf(page)).toEqual([]);
    await rig.end();
  }, 60_000);
});

describe('colours', () => {
  it('by feed and by tool, with what they mean, kept for the next time', async () => {
    const { page } = await start('mill_mm', (ini) => ini, 'G21 G90\nG0 Z5\nT1 M6\nG1 X20 F300\nX40 F600\nX60 F1200\nT2 M6\nG1 Y20\nM2\n');
    const colors = (): Promise<string | null> => page.getByTestId('path-canvas').getAttribute('data-colors');
    expect(await colors()).toBe('kind');
    await page.getByTestId('color-by').selectOption('feed');
    await untilText(page, 'legend', /Feed 300.*1200 mm\/min/);
    const [slow, fast, feed] = [[0x5b, 0x7c, 0xff], [0xff, 0x6b, 0x5e], [0x6c, 0xc0, 0xff]] as [number, number, number][];
    await until(async () => (await pixelsOf(page, slow as never)) > 10 && (await pixelsOf(page, fast as never)) > 10, 'slow and fast');
    expect(await pixelsOf(page, feed as never)).toBe(0);
    await judgeByAxe(page, 'colours by feed');
    await pictures(page, 'by_feed');
    await page.getByTestId('color-by').selectOption('tool');
    await untilText(page, 'legend', /T1.*T2/);
    await until(async () => (await pixelsOf(page, [0x7e, 0xe0, 0xa8])) > 10, 'the second tool');
    await pictures(page, 'by_tool');
    await page.reload();
    await page.getByTestId('tab-path').click();
    await untilText(page, 'legend', /T1.*T2/);
    expect(errorsOf(page)).toEqual([]);
  }, 60_000);
});

describe('a foam cutter', () => {
  it('has two planes, one picture of each, and its wire', async () => {
    const { rig, page } = await start('mill_xyza', foam, 'G21 G90 F600\nG1 X10 Y0 U30 V10\nX10 Y20 U30 V40\nM2\n');
    const canvas = page.getByTestId('path-canvas');
    await until(async () => (await canvas.getAttribute('data-view')) === 'iso', 'a view');
    const blue: [number, number, number] = [0x6c, 0xc0, 0xff];
    const pale: [number, number, number] = [0x43, 0x73, 0x98];
    await until(async () => (await pixelsOf(page, blue)) > 10 && (await pixelsOf(page, pale)) > 10, 'both paths');
    await page.getByTestId('view-xy').click();
    await until(async () => (await pixelsOf(page, pale)) === 0 && (await pixelsOf(page, blue)) > 10, 'X and Y alone');
    await page.getByTestId('view-uv').click();
    await until(async () => (await pixelsOf(page, blue)) === 0 && (await pixelsOf(page, pale)) > 10, 'U and V alone');
    await page.getByTestId('view-iso').click();
    await page.getByTestId('reset').click();
    await page.getByTestId('on').click();
    await untilText(page, 'state', 'On');
    const wire = (): Promise<number[]> =>
      page.evaluate(() => [...(document.querySelector('canvas') as unknown as { scene: { wire: { geometry: { attributes: { position: { array: Float32Array } } } } } }).scene.wire.geometry.attributes.position.array]);
    await until(async () => (await wire())[5] === 150, 'the wire');
    await pictures(page, 'foam');
    expect(errorsOf(page)).toEqual([]);
    await rig.end();
  }, 60_000);
});

/** X, Y, U and V from a mill with X, Y, Z and A. */
function foam(ini: string): string {
  return ini
    .replace('[DISPLAY]\n', '[DISPLAY]\nFOAM = 1\nFOAM_W = 150\n')
    .replace(/TOOL_CHANGE_POSITION.*\n/, '')
    .replace('COORDINATES = X Y Z A', 'COORDINATES = X Y U V')
    .replace('coordinates=XYZA', 'coordinates=XYUV')
    .replace('[AXIS_Z]', '[AXIS_U]')
    .replace('[AXIS_A]', '[AXIS_V]')
    .replace('TYPE = ANGULAR', 'TYPE = LINEAR');
}
