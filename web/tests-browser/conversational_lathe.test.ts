// SPDX-License-Identifier: GPL-2.0-or-later
// Tests conversational programming on a lathe: the forms are those of the machine, and the machine reads each
// generated program (J1).
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import type { Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, expect, it } from 'vitest';
import { errorsOf, openView, Rig, showFailure, sleep, until } from './rig';

const rig = new Rig(undefined, 'lathe');
let page: Page;
beforeAll(async () => {
  await rig.startServer();
  await rig.startMachine();
  page = await rig.page();
  await openView(page, 'conversational');
});
afterEach(async (context) => showFailure(context, page));
afterAll(async () => {
  await rig.end();
});

it('makes one program of all lathe operations, without errors', async () => {
  const field = (id: string) => page.getByTestId(`conv-${id}`);
  for (const kind of ['lathe_face', 'turn', 'chamfer', 'radius', 'lathe_bore', 'lathe_thread', 'groove', 'part_off']) {
    await field('save').waitFor();
    await sleep(50);
    if (await field('back').isVisible()) {
      await field('back').click();
    }
    await field('add').click();
    expect(await field('add-rect_pocket').count()).toBe(0);
    await field(`add-${kind}`).click();
    await field('tool').selectOption(kind === 'groove' || kind === 'part_off' ? '3' : '1');
  }
  await page.getByTestId('reset').click();
  await page.getByTestId('on').click();
  await field('save-open').click();
  await page.getByTestId('path-done').waitFor();
  const file = join(rig.programs, 'Part 1.ngc');
  await until(() => readFileSync(file, 'utf8').includes('G76 P1.5'), 'the program');
  await openView(page, 'path');
  expect(await page.getByTestId('path-errors').count()).toBe(0);
  expect(errorsOf(page)).toEqual([]);
});
