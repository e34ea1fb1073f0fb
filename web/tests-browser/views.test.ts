// SPDX-License-Identifier: GPL-2.0-or-later
// Tests every view in every size, light and dark: axe-core reports no fault, nothing exceeds the window, and the stops can be touched.
// MW_SCREEN_PICTURES saves the pictures of docs/user/screen.md from the running program.
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import type { Page } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, it } from 'vitest';
import { bringUp, byHand, judgeByAxe, openView, Rig, sleep, untilText } from './rig';

const PICTURES = process.env['MW_SCREEN_PICTURES'];
const SIZES = [[1280, 800], [1920, 1080], [800, 480], [390, 844]] as const;
const TABS = ['path', 'simulation', 'process', 'programs', 'conversational', 'text', 'tools', 'offsets', 'probing', 'plots', 'hal', 'messages', 'settings'];
const SMALL_TABS = ['jog', 'mdi', 'codes', ...TABS];

const rig = new Rig(byHand);
let page: Page;

const judge = (what: string): Promise<void> => judgeByAxe(page, what);

/** Controls are inside the picture, or in a scrolled element, and the stops are on top. */
async function isUsable(what: string): Promise<void> {
  const wrong = await page.evaluate(() => {
    const found: string[] = [];
    if (document.documentElement.scrollWidth > window.innerWidth + 1) {
      found.push(`the page is ${document.documentElement.scrollWidth} wide`);
    }
    // Elements that scroll sideways (tabs, long text) are exempt. No other element is cut off at the side, and no panel exceeds the bottom.
    for (const one of document.querySelectorAll('main button, main input, main select')) {
      const box = one.getBoundingClientRect();
      let above = one.closest('.tabs, .cm-editor, .hidden-text, .sideways') === null && one.checkVisibility() ? one.parentElement : null;
      // A dialog covers its owner.
      for (; above !== null && getComputedStyle(above).position !== 'fixed'; above = above.parentElement) {
        const room = above.getBoundingClientRect();
        const isClip = getComputedStyle(above).overflowX !== 'visible' || above.classList.contains('panel');
        if (isClip && (box.right > room.right + 1 || box.left < room.left - 1)) {
          found.push(`${one.getAttribute('data-testid') ?? one.tagName} is cut off`);
          break;
        }
      }
    }
    for (const one of document.querySelectorAll<HTMLElement>('main .panel')) {
      const isOpen = getComputedStyle(one).overflowY === 'visible' && one.getBoundingClientRect().height > 0;
      if (isOpen && one.scrollHeight > one.clientHeight + 2) {
        found.push(`${one.getAttribute('aria-label') ?? 'a panel'} is ${one.clientHeight} high and has ${one.scrollHeight}`);
      }
    }
    for (const one of document.querySelectorAll('.u-over')) {
      if (one.getBoundingClientRect().height < 60) {
        found.push('a plot is too flat');
      }
    }
    for (const id of ['stop', 'estop', 'hold']) {
      const element = document.querySelector(`[data-testid="${id}"]`);
      const box = element?.getBoundingClientRect();
      const top = box === undefined ? null : document.elementFromPoint(box.x + box.width / 2, box.y + box.height / 2);
      if (element === null || top !== element) {
        found.push(`${id} cannot be touched`);
      }
      if (box !== undefined && (box.width < 44 || box.height < 44)) {
        found.push(`${id} is ${box.width} by ${box.height}`);
      }
    }
    return found;
  });
  expect(wrong, what).toEqual([]);
}

async function picture(name: string): Promise<void> {
  if (PICTURES !== undefined) {
    await page.screenshot({ path: join(PICTURES, `${name}.png`) });
  }
}

beforeAll(async () => {
  rig.write('pocket.ngc', readFileSync(new URL('../../nc_files/pocket.ngc', import.meta.url), 'utf8'));
  rig.write('part.ngc', 'G21 G90 F600\nG0 Z5\nT1 M6\nG1 X10\nM2\n');
  await rig.startServer();
  await rig.startMachine();
  page = await rig.page();
});

afterAll(async () => {
  await rig.end();
});

describe('before it is on', () => {
  it.each(SIZES)('at %i by %i', async (width, height) => {
    await page.setViewportSize({ width, height });
    await untilText(page, 'state', 'Emergency stop');
    await sleep(150);
    await judge('emergency stop');
    await isUsable('emergency stop');
    await picture(`estop_${width}x${height}`);
  });
});

describe('when it is on', () => {
  beforeAll(async () => {
    await page.setViewportSize({ width: 1280, height: 800 });
    await bringUp(page);
    await page.getByTestId('tab-programs').click();
    await page.getByTestId('open-pocket.ngc').click();
    await page.getByTestId('path-done').waitFor();
    await page.getByTestId('mdi-line').fill('G0 Z10');
    await page.getByTestId('mdi-send').click();
    await untilText(page, 'machine-Z', '10.000');
    await untilText(page, 'run-state', 'Idle');
  });

  describe.each(['dark', 'light'] as const)('%s', (theme) => {
    it.each(SIZES.filter(([width]) => theme === 'dark' || width !== 1920))('each view at %i by %i', async (width, height) => {
      await page.emulateMedia({ colorScheme: theme });
      await page.setViewportSize({ width, height });
      await sleep(100);
      for (const tab of width >= 1280 ? TABS : SMALL_TABS) {
        await openView(page, tab);
        if (tab === 'simulation') {
          await page.locator('[data-testid="simulation"][data-phase="ready"]').waitFor({ timeout: 20_000 });
        }
        await sleep(['path', 'plots', 'simulation'].includes(tab) ? 350 : 120);
        await judge(`${tab} ${width}x${height} ${theme}`);
        await isUsable(`${tab} ${width}x${height} ${theme}`);
        if (theme === 'dark' || tab === 'path') {
          await picture(`${tab}_${width}x${height}${theme === 'light' ? '_light' : ''}`);
        }
      }
    }, 120_000);
  });

  it.each(['de', 'es'] as const)('in %s', async (language) => {
    await page.emulateMedia({ colorScheme: 'dark' });
    await openView(page, 'settings');
    await page.getByTestId('language').selectOption(language);
    for (const [width, height] of SIZES) {
      await page.setViewportSize({ width, height });
      for (const tab of width >= 1280 ? TABS : SMALL_TABS) {
        await openView(page, tab);
        await sleep(100);
        await isUsable(`${tab} ${width}x${height} ${language}`);
      }
    }
    await openView(page, 'settings');
    await page.getByTestId('language').selectOption('en');
  }, 120_000);

  it('a dialog, a question and a rejection', async () => {
    await page.emulateMedia({ colorScheme: 'dark' });
    for (const [width, height] of SIZES) {
      await page.setViewportSize({ width, height });
      await page.getByTestId('touch-X').click();
      await judge(`touch-off ${width}`);
      await isUsable(`touch-off ${width}`);
      await picture(`touch_off_${width}x${height}`);
      await page.getByTestId('touch-off').getByRole('button', { name: 'Close' }).click();
    }
    for (const [width, height] of SIZES) {
      await page.setViewportSize({ width, height });
      await openView(page, 'tools');
      for (const [button, name] of [['tool-add', 'tool_add'], ['edit-2', 'tool_edit']] as const) {
        await page.getByTestId(button).click();
        await judge(`${name} ${width}`);
        await isUsable(`${name} ${width}`);
        await picture(`${name}_${width}x${height}`);
        await page.getByTestId('tool-dialog').getByRole('button', { name: 'Close' }).click();
      }
    }
    await page.setViewportSize({ width: 1280, height: 800 });
    await openView(page, 'tools');
    await page.getByTestId('load-1').click();
    await page.getByTestId('tool-change').waitFor();
    await judge('tool change');
    await isUsable('tool change');
    await picture('tool_change_1280x800');
    await page.getByTestId('tool-change-done').click();
    await untilText(page, 'run-state', 'Idle');
    await page.getByTestId('resume').or(page.getByTestId('step')).first().waitFor();
    await page.getByTestId('tab-programs').click();
    await page.getByTestId('open-pocket.ngc').click();
    await page.getByTestId('path-done').waitFor();
    await page.getByTestId('run').click();
    await untilText(page, 'run-state', /Running|Stopped/);
    await sleep(3000);
    await page.getByTestId('jog-X+').click({ force: true });
    await page.getByTestId('why').waitFor();
    await judge('running');
    await isUsable('running');
    await picture('running_1280x800');
    await page.getByTestId('stop').click();
    await untilText(page, 'run-state', 'Idle');
  }, 60_000);
});
