// SPDX-License-Identifier: GPL-2.0-or-later
// Tests files that a program of [FILTER] converts to programs (J1).
import { chmodSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { afterAll, beforeAll, expect, it } from 'vitest';
import type { Page } from 'playwright-core';
import { errorsOf, judgeByAxe, Rig, text, until, untilText } from './rig';

// Waits for the file GO; rejects a depth of 0.
const FILTER = `#!/bin/sh
depth=$(cat "$1")
echo FILTER_PROGRESS=25 >&2
while [ ! -e "$1.go" ]; do sleep 0.05; done
[ "$depth" != 0 ] || { echo "the depth is 0" >&2; exit 1; }
echo FILTER_PROGRESS=90 >&2
echo "G21 G90 F600"
echo "G1 X10 Z-$depth"
echo "M2"
`;
const rig = new Rig((ini) => `${ini}\n[FILTER]\nPROGRAM_EXTENSION = .depth Depths\ndepth = ./depth_filter\n`);
let page: Page;

beforeAll(async () => {
  const path = join(rig.folder, 'configs/sim/depth_filter');
  writeFileSync(path, FILTER);
  chmodSync(path, 0o755);
  rig.write('a part.depth', '3');
  rig.write('flat.depth', '0');
  rig.write('flat.depth.go', '');
  rig.write('plain.ngc', 'G21 G90 F600\nG1 X5\nM2\n');
  await rig.startServer();
  await rig.startMachine();
  page = await rig.page();
  await page.getByTestId('tab-programs').click();
  await page.getByTestId('open-plain.ngc').click();
  await page.getByTestId('path-done').waitFor();
}, 60_000);

afterAll(async () => {
  await rig.end();
});

it('shows the progress of the filter, and ends it by its button', async () => {
  await page.getByTestId('tab-programs').click();
  await page.getByTestId('open-a part.depth').click();
  await untilText(page, 'filter-progress', '25 % done');
  await judgeByAxe(page, 'a filter runs');
  await page.getByTestId('filter-cancel').click();
  await until(async () => !(await page.getByTestId('filter-dialog').isVisible()), 'no dialog');
  await until(async () => (await page.getByText(/The filter of a part\.depth was stopped/).count()) > 0, 'that it is said');
  await untilText(page, 'program', 'plain.ngc');
});

it('opens the program that it makes, with its path and text', async () => {
  rig.write('a part.depth.go', '');
  await page.getByTestId('open-a part.depth').click();
  await untilText(page, 'program', 'a part.depth');
  await page.getByTestId('path-done').waitFor();
  await until(async () => /-3\.000$/.test((await page.getByTestId('path-canvas').getAttribute('data-low')) ?? ''), 'the depth in the path');
  await page.getByTestId('tab-text').click();
  await untilText(page, 'text-room', /G1 X10 Z-3/);
  expect(await text(page, 'text-made')).toContain('a part.depth');
});

it('reports the fault, and keeps the previous program open', async () => {
  await page.getByTestId('tab-programs').click();
  await page.getByTestId('open-flat.depth').click();
  await until(async () => (await page.getByText(/has ended with status 1: the depth is 0/).count()) > 0, 'the error');
  await untilText(page, 'program', 'a part.depth');
  expect(errorsOf(page)).toEqual([]);
});
