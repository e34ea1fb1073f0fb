// SPDX-License-Identifier: GPL-2.0-or-later
// Tests the material simulation in the screen: a rapid move in the stock is reported with its line, the slider selects the shown move, and
// the picture follows the machine. MW_SCREEN_PICTURES saves pictures.
import { join } from 'node:path';
import type { Page } from 'playwright-core';
import { afterAll, beforeAll, expect, it, onTestFailed } from 'vitest';
import { bringUp, errorsOf, judgeByAxe, openView, Rig, sleep, until, untilText } from './rig';

const PICTURES = process.env['MW_SCREEN_PICTURES'];
const SIZES = [[1280, 800], [800, 480], [390, 844]] as const;

// T1 is an end mill of 6 mm that is 33 mm long. The stock goes from 2 mm around and below the cuts to Z0: from X5 Y5 Z-10.
const PLANTED = `G21 G90 G17 G54 F1200
T1 M6
G43 H1
G0 Z5
G0 X10 Y10
G1 Z-4
G1 X50 Y10
G2 X50 Y40 I0 J15
G0 X10 Y40
G0 Z5
G0 X30 Y25
G1 Z-8 F2000
G3 X30 Y25 I-6 J0
G0 Z5
M2
`;

const rig = new Rig();
let page: Page;

interface Probe {
  frameTimes: number[];
  pictures: number;
}
const scene = (): Promise<Probe> => page.evaluate(() => {
  const { frameTimes, pictures } = (document.querySelector('[data-testid="simulation-canvas"]') as HTMLCanvasElement & { scene: { frameTimes: number[]; pictures: number } }).scene;
  return { frameTimes: [...frameTimes], pictures };
});
const moves = async (): Promise<number> => Number(await page.getByTestId('simulation-canvas').getAttribute('data-moves'));

async function picture(name: string): Promise<void> {
  if (PICTURES !== undefined) {
    await page.screenshot({ path: join(PICTURES, `simulation_${name}.png`) });
  }
}

/** An open view may cover the buttons. */
async function openDrawer(id: string): Promise<void> {
  const close = page.getByTestId('simulation-close');
  if (await close.isVisible()) {
    await close.click();
  }
  await page.getByTestId(`simulation-open-${id}`).click();
}

async function open(name: string): Promise<void> {
  await openView(page, 'programs');
  await page.getByTestId(`open-${name}`).click();
  await openView(page, 'simulation');
}

beforeAll(async () => {
  rig.write('planted.ngc', PLANTED);
  rig.write('rotary.ngc', 'G21 G90 F600\nT1 M6\nG0 Z5\nG1 X10 Z-1\nG1 A90\nM2\n');
  await rig.startServer();
  await rig.startMachine();
  page = await rig.page();
  await bringUp(page);
});

afterAll(async () => {
  await rig.end();
});

it('finds the rapid in the stock, with its line', async () => {
  onTestFailed(() => picture('failed'));
  await open('planted.ngc');
  await page.getByTestId('simulation-ready').waitFor({ timeout: 20_000 });
  await openDrawer('findings');
  const found = page.getByTestId('simulation-findings').getByRole('button');
  expect(await found.count()).toBe(1);
  await untilText(page, 'finding-9', /Line 9: rapid in stock[^]*4\.00 mm deep[^]*G0 X10 Y40/);
  await picture('findings');
  await page.getByTestId('finding-9').click();
  await untilText(page, 'simulation-line', /^9\s+G0 X10 Y40/);
  expect(await page.getByTestId('finding-9').getAttribute('aria-pressed')).toBe('true');
  await judgeByAxe(page, 'findings');
});

it('shows any time and any line of the program', async () => {
  const slider = page.getByTestId('simulation-slider');
  await slider.fill('0');
  await until(async () => (await moves()) === 0, 'the start');
  const before = (await scene()).pictures;
  const whole = Number(await slider.getAttribute('max'));
  await slider.fill((whole / 2).toFixed(1));
  await until(async () => (await moves()) > 0, 'the middle');
  expect((await scene()).pictures).toBeGreaterThan(before);
  await page.getByTestId('simulation-line-wanted').fill('8');
  await page.getByTestId('simulation-go').click();
  await untilText(page, 'simulation-line', /^8\s+G2 X50 Y40/);
  await page.getByTestId('simulation-speed').selectOption('100');
  await page.getByTestId('simulation-play').click();
  await untilText(page, 'simulation-line', /^1[24]\s/, 20_000);
});

it('takes another stock and another tool, and keeps them', async () => {
  await openDrawer('stock');
  await page.getByTestId('stock-floor').fill('-6');
  await page.getByTestId('stock-apply').click();
  await openDrawer('findings');
  await untilText(page, 'finding-12', /tool below the lowest tool position/);
  await openDrawer('tools');
  await page.getByTestId('stickout-1').fill('7');
  await page.getByTestId('stickout-1').blur();
  await openDrawer('findings');
  await untilText(page, 'finding-12', /holder in stock, tool below the lowest tool position/);
  await picture('holder');
  await page.reload();
  await openView(page, 'simulation');
  await page.getByTestId('simulation-ready').waitFor({ timeout: 20_000 });
  await openDrawer('findings');
  await untilText(page, 'finding-12', /holder in stock, tool below the lowest tool position/);
});

it('takes an STL file as stock', async () => {
  const corners = [[5, 5, -10], [60, 5, -10], [60, 45, -10], [5, 45, -10], [30, 25, 0]] as const;
  const faces = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]] as const;
  const stl = faces.map((face) => `facet normal 0 0 1 outer loop ${face.map((i) => `vertex ${(corners[i] as readonly number[]).join(' ')}`).join(' ')} endloop endfacet`).join('\n');
  await openDrawer('stock');
  await page.getByTestId('stock-stl').setInputFiles({ name: 'blank.stl', mimeType: 'model/stl', buffer: Buffer.from(`solid blank\n${stl}\nendsolid blank\n`) });
  await until(async () => (await page.getByTestId('stock-size-X').inputValue()) === '55', 'the size of the mesh');
  expect(await page.getByTestId('stock-kind').inputValue()).toBe('mesh');
  await page.getByTestId('stock-apply').click();
  await page.locator('[data-testid="simulation"][data-phase="ready"]').waitFor();
  await picture('mesh');
  await openDrawer('stock');
  await page.getByTestId('stock-kind').selectOption('box');
  await page.getByTestId('stock-default').click();
  await page.getByTestId('stock-floor').fill('-6');
  await page.getByTestId('stock-apply').click();
  await page.locator('[data-testid="simulation"][data-phase="ready"]').waitFor();
});

it('follows the machine while it cuts', async () => {
  await page.getByTestId('simulation-slider').fill('0');
  await until(async () => (await moves()) === 0, 'the start');
  await page.getByTestId('simulation-live').click();
  await page.getByTestId('run').click();
  await untilText(page, 'simulation-line', /^7\s/, 30_000);
  const first = await moves();
  await until(async () => (await moves()) > first, 'the next move');
  await untilText(page, 'run-state', 'Idle', 60_000);
  // The picture is kept although the tool table has changed with the tool and the path is read again.
  await sleep(500);
  await untilText(page, 'simulation-line', /^1[2-4]\s/, 20_000);
  await page.getByTestId('simulation-live').click();
});

it('shows no picture of a program that moves a rotary axis', async () => {
  const four = new Rig(undefined, 'mill_xyza');
  try {
    four.write('rotary.ngc', 'G21 G90 F600\nG0 Z5\nG1 X10 Z-1\nG1 A90\nM2\n');
    await four.startServer();
    await four.startMachine();
    const other = await four.page();
    await bringUp(other);
    await openView(other, 'programs');
    await other.getByTestId('open-rotary.ngc').click();
    await openView(other, 'simulation');
    await untilText(other, 'simulation-state', /Line 4 moves a rotary axis/, 20_000);
  } finally {
    await four.end();
  }
});

it.each([['dark', 'en'], ['light', 'en'], ['dark', 'de'], ['light', 'es']] as const)('is usable in each size, %s %s', async (theme, language) => {
  await page.emulateMedia({ colorScheme: theme });
  await openView(page, 'settings');
  await page.getByTestId('language').selectOption(language);
  for (const [width, height] of SIZES) {
    await page.setViewportSize({ width, height });
    await openView(page, 'simulation');
    await page.locator('[data-testid="simulation"][data-phase="ready"]').waitFor({ timeout: 20_000 });
    if (await page.getByTestId('simulation-drawer').isVisible()) {
      await page.getByTestId('simulation-close').click();
    }
    await sleep(400);
    await picture(`view_only_${width}x${height}_${theme}_${language}`);
    await judgeByAxe(page, `simulation ${width}x${height} ${theme}_${language}`);
    for (const id of ['findings', 'stock', 'tools', ...(width < 1280 ? ['view'] : [])]) {
      await openDrawer(id);
      await sleep(150);
      await picture(`${id}_${width}x${height}_${theme}_${language}`);
      await judgeByAxe(page, `simulation ${id} ${width}x${height} ${theme}_${language}`);
      const small = await page.evaluate(() => [...document.querySelectorAll('[data-testid="simulation"] button, [data-testid="simulation"] select, [data-testid="simulation"] input')]
        .filter((one) => one.checkVisibility() && (one.getBoundingClientRect().height < 43.5 || one.getBoundingClientRect().right > window.innerWidth))
        .map((one) => one.outerHTML.slice(0, 90)));
      expect(small, `${id} ${width}x${height}`).toEqual([]);
      const cut = await page.evaluate(() => [...document.querySelectorAll<HTMLElement>('[data-testid="simulation"] button, [data-testid="simulation"] label, [data-testid="simulation"] h2')]
        .filter((one) => one.checkVisibility() && one.scrollWidth > one.clientWidth + 1 && getComputedStyle(one).display !== 'inline')
        .map((one) => one.outerHTML.slice(0, 90)));
      expect(cut, `${id} ${width}x${height} ${language}`).toEqual([]);
    }
    await page.getByTestId('simulation-close').click();
  }
  await page.setViewportSize({ width: 1280, height: 800 });
  await openView(page, 'settings');
  await page.getByTestId('language').selectOption('en');
}, 120_000);

it('prepares 100,000 moves, and draws them while the slider moves', async () => {
  // A surface cut by the ball nose T5. The printed times depend on the other jobs of the computer.
  const lines = ['G21 G90 G17 G54 F3000', 'T5 M6', 'G43 H5', 'G0 Z5', 'G0 X0 Y0'];
  let [x, y, step] = [0, 0, 0.5];
  for (let i = 0; i < 100_000; ++i) {
    x += step;
    if (x > 100 || x < 0) {
      step = -step;
      y += 0.16;
    }
    lines.push(`G1 X${x.toFixed(3)} Y${y.toFixed(3)} Z${(-3 - 1.5 * Math.sin(x / 9) * Math.cos(y / 7)).toFixed(3)}`);
  }
  rig.write('surface.ngc', `${lines.join('\n')}\nG0 Z5\nM2\n`);
  const start = await rig.processorTime();
  await open('surface.ngc');
  const ready = page.getByTestId('simulation-ready');
  await ready.waitFor({ timeout: 60_000 });
  const used = (await rig.processorTime()) - start;
  const before = await rig.processorTime();
  const pictures = await page.evaluate(async () => {
    const slider = document.querySelector('[data-testid="simulation-slider"]') as HTMLInputElement;
    const { scene } = document.querySelector('[data-testid="simulation-canvas"]') as HTMLCanvasElement & { scene: { pictures: number } };
    const [first, begin, MS] = [scene.pictures, performance.now(), 4000];
    for (let now = begin; now - begin < MS; now = performance.now()) {
      slider.value = String((0.5 - 0.5 * Math.cos((now - begin) / 500)) * Number(slider.max));
      slider.dispatchEvent(new Event('input', { bubbles: true }));
      await new Promise((done) => requestAnimationFrame(done));
    }
    return scene.pictures - first;
  });
  const each_ms = (((await rig.processorTime()) - before) * 1000) / pictures;
  console.log(`100,000 moves: ready after ${await ready.getAttribute('data-took')} ms and ${used.toFixed(2)} s of processor time of the browser, path drawing included; ${pictures / 4} pictures per second, ${each_ms.toFixed(1)} ms of processor time each`);
  expect(pictures).toBeGreaterThan(0);
}, 120_000);

it('has reported no error', () => expect(errorsOf(page)).toEqual([]));
