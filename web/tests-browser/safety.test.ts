// SPDX-License-Identifier: GPL-2.0-or-later
// Tests controls that could hurt a person or a part: edited programs, keys, gestures, and controls that
// change position (row J2).
import { readFileSync } from 'node:fs';
import type { Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, describe, expect, it } from 'vitest';
import { bringUp, byHand, openView, Rig, showFailure, sleep, until, untilText } from './rig';

const PART = 'G21 G90 F600\nG0 X0 Y0\nG1 X3\nG1 Y3\nM2\n';
const rig = new Rig(byHand);
let page: Page;

async function tab(id: string): Promise<void> {
  await page.getByTestId(`tab-${id}`).click();
}
async function open(name: string): Promise<void> {
  await tab('programs');
  await page.getByTestId(`open-${name}`).click();
}
/** Checks that the machine does not move for a sufficiently long time. */
async function staysStopped(): Promise<void> {
  const before = [rig.position(0), rig.position(1)];
  await sleep(400);
  expect([rig.position(0), rig.position(1)]).toEqual(before);
  await untilText(page, 'run-state', 'Idle');
}

beforeAll(async () => {
  rig.write('part.ngc', PART);
  rig.write('other.ngc', 'G21\nM2\n');
  await rig.startServer();
  await rig.startMachine();
  page = await rig.page();
  await bringUp(page);
});

afterEach(async (context) => showFailure(context, page));

afterAll(async () => {
  await rig.end();
});

describe('a saved program', () => {
  it('has its former version, which comes back as a change that is not saved', async () => {
    rig.write('twice.ngc', 'G21 (first)\nM2\n');
    await open('twice.ngc');
    await tab('text');
    await untilText(page, 'text-room', /first/);
    await page.getByTestId('text-former').click();
    await untilText(page, 'notice', /no previous version of twice\.ngc/);
    await page.locator('.cm-content').click();
    await page.keyboard.press('Control+A');
    await page.keyboard.type('G21 (second)\nM2\n');
    await page.getByTestId('text-save').click();
    await page.getByTestId('text-changed').waitFor({ state: 'detached' });
    expect(readFileSync(`${rig.programs}/twice.ngc~`, 'utf8')).toBe('G21 (first)\nM2\n');
    await page.getByTestId('text-former').click();
    await untilText(page, 'text-room', /first/);
    await page.getByTestId('text-changed').waitFor();
    expect(readFileSync(`${rig.programs}/twice.ngc`, 'utf8')).toMatch(/second/);
    await page.getByTestId('text-discard').click();
    await untilText(page, 'text-room', /second/);
    await page.getByTestId('strip-dismiss').click();
  });
});

describe('changes in the editor that are not saved', () => {
  it('survive another view', async () => {
    await open('part.ngc');
    await page.getByTestId('path-done').waitFor();
    await tab('text');
    await untilText(page, 'text-room', /G1 X3/);
    await page.locator('.cm-content').click();
    await page.keyboard.press('Control+End');
    await page.keyboard.type('(changed)');
    await page.getByTestId('text-changed').waitFor();
    await tab('offsets');
    await tab('text');
    await untilText(page, 'text-room', /\(changed\)/);
    await page.getByTestId('text-changed').waitFor();
  });

  it('are not run as the file of before', async () => {
    await page.getByTestId('run').click({ force: true });
    await untilText(page, 'why', /unsaved changes/);
    await page.getByTestId('step').click({ force: true });
    await untilText(page, 'why', /Step.*unsaved changes/s);
    await staysStopped();
  });

  it('ask before another program is opened, and before the page is left', async () => {
    await open('other.ngc');
    await untilText(page, 'unsaved-dialog', /part\.ngc/);
    await page.getByTestId('unsaved-dialog').getByText('Close').click();
    await tab('text');
    await untilText(page, 'text-room', /\(changed\)/);
    const asked = new Promise<string>((done) => page.once('dialog', (dialog) => {
      done(dialog.type());
      void dialog.dismiss();
    }));
    await page.close({ runBeforeUnload: true });
    expect(await asked).toBe('beforeunload');
    await open('other.ngc');
    await page.getByTestId('unsaved-save').click();
    await until(() => readFileSync(`${rig.programs}/part.ngc`, 'utf8') === `${PART}(changed)`, 'the file');
    await untilText(page, 'program', 'other.ngc');
  });

  it('are marked where another client runs the file, and no line of them as running', async () => {
    rig.write('part.ngc', PART.replace('F600', 'F60'));
    await open('part.ngc');
    await tab('text');
    await untilText(page, 'text-room', /F60\b/);
    await page.locator('.cm-content').click();
    await page.keyboard.type('(new)');
    await page.getByTestId('text-changed').waitFor();
    const other = await rig.page();
    await other.getByTestId('run').click();
    await untilText(page, 'text-runs-saved', /saved program/);
    await untilText(page, 'line', /Line 3/);
    expect(await page.locator('.cm-running').count()).toBe(0);
    await page.getByTestId('stop').click();
    await untilText(page, 'run-state', 'Idle');
    await other.context().close();
    await page.getByTestId('text-discard').click();
    expect(await page.getByTestId('text-room').innerText()).not.toContain('(new)');
    await page.getByTestId('text-changed').waitFor({ state: 'detached' });
  });
});

describe('a key', () => {
  it.each(['r', 't'])('%s starts nothing without a confirmation', async (key) => {
    await tab('path');
    await page.getByTestId('dro').click();
    await page.keyboard.press(key);
    await page.getByTestId('key-start').waitFor();
    await staysStopped();
    await page.keyboard.press('Escape');
    await page.getByTestId('key-start').waitFor({ state: 'detached' });
    await staysStopped();
  });

  it('r starts the program when it is confirmed', async () => {
    await page.keyboard.press('r');
    await untilText(page, 'key-start', /part\.ngc/);
    await page.keyboard.press('Enter');
    await untilText(page, 'run-state', 'Running');
    await page.keyboard.press('Escape');
    await untilText(page, 'run-state', 'Idle');
  });
});

describe('the note of a tool change', () => {
  it('names no key that means something else on this screen', async () => {
    await page.getByTestId('mdi-line').fill('T1 M6');
    await page.getByTestId('mdi-send').click();
    await page.getByTestId('tool-change-done').click();
    await untilText(page, 'tool', 'T1');
    await tab('messages');
    await untilText(page, 'messages', /load tool 1/);
    expect(await page.getByTestId('messages').innerText()).not.toMatch(/\bkey\b/);
  });
});

describe('Clear of an offset', () => {
  it.each([
    ['offset-clear-X', 'G10 L20 P1 X5', /X\t(?!0\.000)/, /G54 X.*-?\d+\.\d{3}/],
    ['clear-rotation', 'G10 L2 P1 R12.5', /12\.500/, /12\.500°/],
    ['clear-g92', 'G92 Y1', /Y\t-?\d+\.\d+\t(?!0\.000)/, /Y 0\.000|Y -?\d/],
  ] as const)('%s asks first', async (button, line, there, shown) => {
    await tab('offsets');
    await page.getByTestId('mdi-line').fill(line);
    await page.getByTestId('mdi-send').click();
    await until(async () => there.test(await page.getByTestId('offsets').innerText()), `the offset of ${line}`);
    const before = await page.getByTestId('offsets').locator('table').first().innerText();
    await page.getByTestId(button).click();
    await untilText(page, 'clear-dialog', shown);
    await page.getByTestId('clear-dialog').getByText('Close').click();
    await sleep(300);
    expect(await page.getByTestId('offsets').locator('table').first().innerText()).toBe(before);
    await page.getByTestId(button).click();
    await page.getByTestId('clear-confirm').click();
    await page.getByTestId('clear-dialog').waitFor({ state: 'detached' });
  });

  it('acts when it is confirmed', async () => {
    await tab('offsets');
    await page.getByTestId('mdi-line').fill('G10 L2 P1 X5');
    await page.getByTestId('mdi-send').click();
    await untilText(page, 'g5x-X', '5.000');
    await page.getByTestId('offset-clear-X').click();
    await page.getByTestId('clear-confirm').click();
    await untilText(page, 'g5x-X', '0.000');
  });
});

describe('messages', () => {
  it('keep their time after a reload', async () => {
    await page.getByTestId('mdi-line').fill('G1 Q9');
    await page.getByTestId('mdi-send').click();
    await tab('messages');
    const row = page.getByTestId('messages').locator('li', { hasText: /Q/ }).first();
    const shown = async (): Promise<number> => Date.parse((await row.locator('time').getAttribute('datetime')) ?? '');
    await row.waitFor();
    const before = await shown();
    await sleep(2500);
    await page.reload();
    await tab('messages');
    await row.waitFor();
    expect(Math.abs((await shown()) - before)).toBeLessThan(1000);
  });
});

describe('three messages', () => {
  const other = async (width: number, height: number): Promise<Page> => rig.page({ viewport: { width, height } });
  let raised = 0;
  async function raise(screen: Page, count: number): Promise<void> {
    for (let i = 0; i < count; ++i) {
      await page.getByTestId('mdi-line').fill(`(MSG, message ${++raised})`);
      await page.getByTestId('mdi-send').click();
      await untilText(screen, 'notice', new RegExp(`message ${raised}`));
    }
  }

  it.each([[800, 480, 'jog'], [390, 844, 'jog'], [390, 844, 'process'], [390, 844, 'programs'], [1280, 800, 'programs']])('cover no control and move none at %i by %i in %s', async (width, height, id) => {
    const screen = await other(width, height);
    await openView(screen, id);
    await sleep(300);
    if ((await screen.getByTestId('strip-dismiss').count()) > 0) {
      await screen.getByTestId('strip-dismiss').click();
    }
    const places = (): Promise<string[]> => screen.evaluate(() => [...document.querySelectorAll<HTMLElement>('.app button, .app input, .app select')].filter((one) => one.closest('[data-testid="strip"]') === null).map((one) => {
      const { x, y, width: wide, height: high } = one.getBoundingClientRect();
      return `${one.dataset['testid'] ?? one.textContent} ${[x, y, wide, high].map(Math.round).join(' ')}`;
    }));
    const before = await places();
    await raise(screen, 3);
    expect(await places()).toEqual(before);
    const found = await screen.evaluate(() => {
      const boxOf = (one: Element): DOMRect => one.getBoundingClientRect();
      const strip = document.querySelector('[data-testid="strip"]');
      if (strip === null) {
        return ['no strip'];
      }
      const [own, notice] = [boxOf(strip), boxOf(document.querySelector('[data-testid="notice"]') ?? strip)];
      const others = [...document.querySelectorAll('header, footer, .tabs, .content, .left, .right')].filter((one) => {
        const box = boxOf(one);
        return box.height > 0 && box.bottom > own.top + 1 && box.top < own.bottom - 1 && box.right > own.left && box.left < own.right;
      });
      return [...others.map((one) => `covers ${one.className || one.tagName}`), ...(notice.top < own.top || notice.bottom > own.bottom ? ['the message leaves the strip'] : [])];
    });
    expect(found).toEqual([]);
    await screen.context().close();
  });

  it('are listed on demand, and dismissed by one touch also for the page that is loaded again', async () => {
    const screen = await other(800, 480);
    await raise(screen, 3);
    await screen.getByTestId('strip-all').click();
    for (const number of [raised - 2, raised - 1, raised]) {
      await untilText(screen, 'strip-list', new RegExp(`message ${number}`));
    }
    await screen.getByTestId('strip-list-dismiss').click();
    await screen.getByTestId('notice').waitFor({ state: 'detached' });
    await screen.reload();
    await untilText(screen, 'state', 'On');
    await sleep(500);
    expect(await screen.getByTestId('notice').count()).toBe(0);
    await raise(screen, 1);
    expect(await screen.getByTestId('strip-all').innerText()).toBe('…');
    await openView(screen, 'messages');
    await untilText(screen, 'messages', new RegExp(`message ${raised - 1}`));
    await screen.context().close();
  });
});

describe('an override on a phone', () => {
  let phone: Page;
  async function gesture(from: { x: number; y: number }, by: { x: number; y: number }, steps = 10): Promise<void> {
    const session = await phone.context().newCDPSession(phone);
    const send = (type: 'touchStart' | 'touchMove' | 'touchEnd', points: { x: number; y: number }[]): Promise<unknown> => session.send('Input.dispatchTouchEvent', { type, touchPoints: points });
    await send('touchStart', [from]);
    for (let i = 1; i <= steps; ++i) {
      await send('touchMove', [{ x: from.x + (by.x * i) / steps, y: from.y + (by.y * i) / steps }]);
    }
    await send('touchEnd', []);
    await session.detach();
  }
  async function middle(id: string): Promise<{ x: number; y: number; width: number }> {
    await phone.getByTestId(id).scrollIntoViewIfNeeded();
    const box = await phone.getByTestId(id).boundingBox();
    const found = { x: (box?.x ?? 0) + (box?.width ?? 0) / 2, y: (box?.y ?? 0) + (box?.height ?? 0) / 2, width: box?.width ?? 0 };
    expect(await phone.evaluate(([x, y]) => document.elementFromPoint(x ?? 0, y ?? 0)?.closest('.slider') !== null, [found.x, found.y]), `${id} can be touched`).toBe(true);
    return found;
  }

  it('is not changed by a swipe that scrolls, nor by a tap on its track', async () => {
    phone = await rig.page({ viewport: { width: 390, height: 844 }, hasTouch: true });
    await openView(phone, 'process');
    await untilText(phone, 'feed-override-value', '100 %');
    await sleep(300);
    const track = await middle('feed-override');
    for (const x of [track.x - 0.4 * track.width, track.x + 0.4 * track.width]) {
      await gesture({ x, y: track.y }, { x: 15, y: -200 });
      await phone.touchscreen.tap(x, (await middle('feed-override')).y);
    }
    await gesture(await middle('feed-override-knob'), { x: 20, y: -200 });
    await sleep(400);
    await untilText(phone, 'feed-override-value', '100 %');
    await untilText(page, 'step-feed-now', '100 %');
  });

  it('changes 20 percent at most by a flick of its knob, and by steps of its buttons', async () => {
    await gesture(await middle('feed-override-knob'), { x: -120, y: 0 }, 5);
    await untilText(phone, 'feed-override-value', '80 %');
    await phone.getByTestId('feed-override-more').click();
    await untilText(phone, 'feed-override-value', '85 %');
    await phone.getByTestId('feed-override-less').click();
    await untilText(phone, 'feed-override-value', '80 %');
    await phone.getByTestId('feed-override-reset').click();
    await untilText(phone, 'feed-override-value', '100 %');
    await phone.context().close();
  });
});

describe('the layout at 1280 by 800 and 1920 by 1080', () => {
  it.each([[1280, 800], [1920, 1080]])('keeps the jog pad under the finger at %i by %i', async (width, height) => {
    await page.setViewportSize({ width, height });
    rig.write('wait.ngc', 'G21\nG4 P60\nM2\n');
    await open('wait.ngc');
    const ids = ['jog-Y-', 'jog-X+', 'jog-Z-', 'increment-continuous', 'jog-speed-knob', 'mdi-send'];
    const places = async (): Promise<unknown[]> => Promise.all(ids.map((id) => page.getByTestId(id).boundingBox()));
    await page.getByTestId('run').waitFor();
    const before = await places();
    await page.getByTestId('run').click();
    await untilText(page, 'jog-gate', /program is running/);
    expect(await places()).toEqual(before);
    await page.getByTestId('hold').click();
    await untilText(page, 'jog-gate', /is paused/);
    expect(await places()).toEqual(before);
    await page.getByTestId('stop').click();
    await untilText(page, 'run-state', 'Idle');
    expect(await places()).toEqual(before);
  });

  it.each([[1280, 800], [1920, 1080], [800, 480], [390, 844]])('shows long positions and their buttons in full at %i by %i', async (width, height) => {
    await page.setViewportSize({ width: 1280, height: 800 });
    for (const value of ['-249.5', '-1249.5', '-12249.5']) {
      await page.setViewportSize({ width: 1280, height: 800 });
      await page.getByTestId('mdi-line').fill(`G10 L20 P1 X${value}`);
      await page.getByTestId('mdi-send').click();
      await page.setViewportSize({ width, height });
      await untilText(page, 'work-X', `${value}00`);
      const wrong = await page.getByTestId('dro').evaluate((card) => {
        const inner = card.getBoundingClientRect().right - 7;
        const out = [...card.querySelectorAll('.axis > *')].filter((one) => one.getBoundingClientRect().right > inner || one.scrollWidth > one.clientWidth + 1);
        const column = card.parentElement as HTMLElement;
        return [...out.map((one) => one.outerHTML.slice(0, 80)), ...(column.scrollWidth > column.clientWidth ? ['a scroll bar'] : [])];
      });
      expect(wrong, value).toEqual([]);
    }
  });
});
