// SPDX-License-Identifier: GPL-2.0-or-later
// Conversational programming from the screen: a bolt circle is filled in, saved, run by the simulated machine, and opened again (J1).
import { existsSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import type { Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, expect, it } from 'vitest';
import { bringUp, errorsOf, judgeByAxe, openView, Rig, showFailure, sleep, until, untilText } from './rig';

const PICTURES = process.env['MW_SCREEN_PICTURES'];
const rig = new Rig();
let page: Page;

beforeAll(async () => {
  await rig.startServer();
  await rig.startMachine();
  page = await rig.page();
  await bringUp(page);
  await openView(page, 'conversational');
});
afterEach(async (context) => showFailure(context, page));
afterAll(async () => {
  await rig.end();
});

const program = (): string => join(rig.programs, 'Flange.ngc');
const field = (id: string) => page.getByTestId(`conv-${id}`);
/** In a narrow view the list and the form are on separate pages. */
async function toList(): Promise<void> {
  await field('save').waitFor();
  await sleep(50);
  if (await field('back').isVisible()) {
    await field('back').click();
  }
}

it('rejects a value at its field and saves nothing', async () => {
  await field('add').click();
  await field('add-drill').click();
  await field('holes').fill('60');
  await untilText(page, 'conv-holes-fault', /Holes overlap/);
  await field('save').click();
  await sleep(300);
  expect(existsSync(join(rig.programs, 'Part 1.ngc'))).toBe(false);
  await field('holes').fill('3+3');
  await untilText(page, 'conv-holes-result', '= 6');
  expect(await field('holes-fault').count()).toBe(0);
});

it('lights up the dimension that is typed', async () => {
  await field('circle_diameter').fill('60');
  expect(await page.locator('[data-testid="conv-sketch"] .lit').getAttribute('data-field')).toBe('circle_diameter');
  expect(await field('sketch').textContent()).toContain('60 mm');
});

it('saves a program that the machine runs', async () => {
  await toList();
  await field('program').click();
  await field('name').fill('Flange');
  await field('code').click();
  await untilText(page, 'conv-preview', /G98 G83 X30 Y0 Z-15 R2 Q\S+ F300/);
  await field('save-open').click();
  await until(() => existsSync(program()), 'the file');
  await page.getByTestId('path-done').waitFor();
  expect(readFileSync(program(), 'utf8')).toContain('G43 H3');
  expect(errorsOf(page)).toEqual([]);
});

it('opens it again with the same values, and replaces it only after a question', async () => {
  await page.reload();
  await untilText(page, 'state', 'On');
  await openView(page, 'conversational');
  await toList();
  await field('new').click();
  await field('open').click();
  await field('open-Flange.ngc').click();
  await field('circle_diameter').waitFor();
  expect(await field('circle_diameter').inputValue()).toBe('60');
  await field('depth').fill('12');
  await field('save').click();
  await until(() => readFileSync(program(), 'utf8').includes('Z-12'), 'the changed file');
  expect(readFileSync(`${program()}~`, 'utf8')).toContain('Z-15');
  // Changed by another program since.
  rig.write('Flange.ngc', readFileSync(program(), 'utf8').replace('S1500', 'S1600'));
  await field('depth').fill('11');
  await field('save').click();
  await field('replace').click();
  await until(() => readFileSync(program(), 'utf8').includes('Z-11'), 'the replaced file');
  expect(readFileSync(`${program()}~`, 'utf8')).toContain('S1600');
  const before = readFileSync(program(), 'utf8');
  await toList();
  await field('new').click();
  await field('add').click();
  await field('add-drill').click();
  await toList();
  await field('program').click();
  await field('name').fill('Flange');
  await field('save').click();
  await field('replace').waitFor();
  expect(readFileSync(program(), 'utf8')).toBe(before);
  await page.getByTestId('conv-replace-dialog').getByRole('button', { name: 'Close' }).click();
});

it('reports that the G-code was changed by hand', async () => {
  rig.write('Flange.ngc', readFileSync(program(), 'utf8').replace('S1500', 'S1400'));
  await toList();
  await field('open').click();
  await field('discard').click();
  await field('open-Flange.ngc').click();
  await untilText(page, 'conv-edited-dialog', /edited by hand/);
  await field('edit-text').click();
  await untilText(page, 'text-room', /S1400/);
});

it('shows each form in all sizes', async () => {
  for (const [width, height] of [[1280, 800], [1920, 1080], [800, 480], [390, 844]] as const) {
    await page.setViewportSize({ width: 1280, height: 800 });
    await openView(page, 'conversational');
    await toList();
    await field('add').click();
    await page.setViewportSize({ width, height });
    await sleep(150);
    await judgeByAxe(page, `operations ${width}`);
    await field('add-rect_pocket').click();
    await field('length').focus();
    await sleep(150);
    await judgeByAxe(page, `form ${width}`);
    expect(await page.evaluate(() => document.documentElement.scrollWidth <= window.innerWidth + 1)).toBe(true);
    const flat = await page.locator('[data-testid="conversational"] button:visible, [data-testid="conversational"] select:visible, [data-testid="conversational"] input.number:visible').evaluateAll((all) => all.filter((one) => one.getBoundingClientRect().height < 44).map((one) => one.getAttribute('data-testid')));
    expect(flat, `${width}`).toEqual([]);
    if (PICTURES !== undefined) {
      await page.screenshot({ path: join(PICTURES, `conversational_form_${width}x${height}.png`) });
    }
  }
});
