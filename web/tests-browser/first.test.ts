// SPDX-License-Identifier: GPL-2.0-or-later
// Tests the pages without a running machine: the selector with search and pictures, and the wizard, with
// `millwright select --browser` (J1, A7).
import { copyFileSync, existsSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import type { Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, expect, it } from 'vitest';
import { errorsOf, freePort, judgeByAxe, Rig, showFailure, until, untilText } from './rig';

const PICTURES = process.env['MW_SCREEN_PICTURES'];
const rig = new Rig();
const home = join(rig.folder, 'home');
const shop = join(rig.folder, 'configs');
let page: Page;
let port: number;

async function look(name: string): Promise<void> {
  for (const [width, height] of [[1280, 800], [800, 480], [390, 844]] as const) {
    await page.setViewportSize({ width, height });
    await judgeByAxe(page, `${name} ${width}`);
    expect(await page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth), `${name} ${width}`).toBeLessThanOrEqual(1);
    if (PICTURES !== undefined) {
      await page.screenshot({ path: join(PICTURES, `first_${name}_${width}x${height}.png`) });
    }
  }
  await page.setViewportSize({ width: 1280, height: 800 });
}

beforeAll(async () => {
  mkdirSync(home);
  port = await freePort();
  // The first machine of the shop has a picture, and its screen replaces the selector.
  writeFileSync(rig.ini, readFileSync(rig.ini, 'utf8').replace('DISPLAY = millwright', `DISPLAY = millwright --port ${port}`));
  copyFileSync(fileURLToPath(new URL('../../docs/pocket.png', import.meta.url)), rig.ini.replace('.ini', '.png'));
  await rig.startSelector(port, home, shop);
  page = await rig.page();
});

afterEach(async (context) => showFailure(context, page));
afterAll(async () => {
  await rig.end();
});

it('shows nothing without the key', async () => {
  const answer = await page.request.get(`http://127.0.0.1:${port}/api/first_steps`);
  expect(answer.status()).toBe(401);
  expect((await page.request.post(`http://127.0.0.1:${port}/api/first_steps/start?key=0`, { data: '{}' })).status()).toBe(401);
});

it('finds machines by words, and shows their pictures', async () => {
  await page.getByTestId('choice-sim/lathe.ini').first().waitFor();
  await page.getByTestId('search').fill('three-axis MM');
  await until(async () => (await page.getByTestId('choice-sim/lathe.ini').count()) === 0, 'fewer');
  const mill = page.getByTestId('choice-sim/mill_mm.ini').first();
  expect(await mill.innerText()).toMatch(/Three-axis mill in millimetres/);
  await until(() => mill.locator('img').evaluate((image) => (image as HTMLImageElement).naturalWidth > 0), 'its picture');
  await page.getByTestId('search').fill('no such machine');
  await page.getByTestId('none-found').waitFor();
  await page.getByTestId('search').fill('');
  await look('selector');
});

it('creates a machine from answers, reports invalid ones, and tests it', async () => {
  await page.getByTestId('new-machine').click();
  await page.getByTestId('ask-kind').selectOption('gantry');
  await page.getByTestId('ask-drives').selectOption('stepper');
  await page.getByTestId('ask-switches').selectOption('home');
  await page.getByTestId('ask-y2.step_pin').fill('2');
  await page.getByTestId('ask-y2.step_pin').press('Tab');
  await untilText(page, 'fault-y2.step_pin', /pin 2 is used by x.step_pin/);
  expect(await page.getByTestId('make').isDisabled()).toBe(true);
  await look('wizard');
  await page.getByTestId('ask-y2.step_pin').fill('6');
  await page.getByTestId('ask-name').fill('Shop gantry');
  await page.getByTestId('ask-x.max').fill('750,5');
  await page.getByTestId('ask-x.max').press('Tab');
  await until(async () => !(await page.getByTestId('make').isDisabled()), 'no fault');
  expect(await page.getByTestId('folder').inputValue()).toBe(`${home}/millwright/configs/shop_gantry`);
  await page.getByTestId('make').click();
  await untilText(page, 'trial', /The test of the first program succeeded/, 40_000);
  const ini = readFileSync(join(home, 'millwright/configs/shop_gantry/machine.ini'), 'utf8');
  expect(ini).toContain('MACHINE = Shop gantry');
  expect(ini).toContain('MAX_LIMIT = 750.5');
  expect(existsSync(join(home, 'millwright/configs/shop_gantry/simulated_wires.hal'))).toBe(true);
  await page.getByTestId('wizard-back').click();
  await page.getByTestId('choice-shop_gantry/machine.ini').waitFor();
});

it('starts the chosen machine, whose screen takes its place', async () => {
  const group = page.getByRole('region', { name: 'From LINUXCNC_AUX_CONFIGS' });
  await group.getByTestId('start-sim/mill_mm.ini').click();
  await untilText(page, 'state', 'Emergency stop', 40_000);
  expect(readFileSync(join(home, '.linuxcncrc'), 'utf8')).toContain(`LAST_CONFIG = ${rig.ini}`);
  expect(errorsOf(page).filter((one) => !/WebSocket|Failed to load/.test(one))).toEqual([]);
});
