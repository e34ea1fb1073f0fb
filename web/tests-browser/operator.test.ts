// SPDX-License-Identifier: GPL-2.0-or-later
// Tests an operator's work with the buttons and keys of the page, on the real server and a simulated mill
// (J3). Motion is read from HAL, not from the page.
import type { Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, describe, expect, it } from 'vitest';
import { errorsOf, Rig, showFailure, sleep, text, until, untilText } from './rig';

const PART = `G21 G90 G64 P0.05 F1500
G0 Z5
G0 X0 Y0
G1 X30
G3 X40 Y10 J10
G1 Y30
G2 X20 Y30 I-10 F600
G1 X0 Y0
M2
`;

const rig = new Rig((ini) =>
  `${ini}\n[MDI_COMMAND_LIST]\nMDI_COMMAND_MACRO0 = G0 X1; G0 X2, To two\n`.replace('MAX_FEED_OVERRIDE = 2.0', 'MAX_FEED_OVERRIDE = 1.5\nDEFAULT_SPINDLE_SPEED = 600'),
);
let page: Page;

async function stands(joint: number): Promise<void> {
  let last = NaN;
  await until(async () => {
    const now = rig.position(joint);
    const isStill = now === last;
    last = now;
    await sleep(60);
    return isStill;
  }, 'a joint at rest');
}

async function hold(id: string, ms: number): Promise<void> {
  const box = await page.getByTestId(id).boundingBox();
  if (box === null) {
    throw new Error(`${id} is not to be seen`);
  }
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await sleep(ms);
  await page.mouse.up();
}

async function tab(id: string): Promise<void> {
  await page.getByTestId(`tab-${id}`).click();
}

beforeAll(async () => {
  rig.write('part.ngc', PART);
  rig.write('stop.ngc', 'G21 F600\nG1 X10\nM0\nG1 X20\nM2\n');
  rig.write('bad.ngc', 'G21 F600\nG1 X10\nG1 Q\nM2\n');
  await rig.startServer();
  page = await rig.page();
});

afterEach(async (context) => showFailure(context, page));

afterAll(async () => {
  await rig.end();
});

describe('before the machine is on', () => {
  it('reports that no machine is running, then its emergency stop', async () => {
    await untilText(page, 'connection', /No machine is running/);
    await rig.startMachine();
    await untilText(page, 'state', 'Emergency stop');
    expect(await page.getByTestId('connection').count()).toBe(0);
  });

  it('gates what is unsafe, and the gate says what opens it', async () => {
    for (const id of ['home-all', 'run', 'step', 'spindle-forward-0', 'flood', 'jog-J0+', 'touch-X']) {
      expect(await page.getByTestId(id).getAttribute('aria-disabled'), id).toBe('true');
    }
    await page.getByTestId('home-all').click({ force: true });
    await untilText(page, 'why', /Press Reset, then Machine on/);
    await untilText(page, 'jog-gate', /emergency stop/);
    await hold('jog-J0+', 200);
    expect(rig.position(0)).toBe(0);
  });

  it('never gates the stops', async () => {
    for (const id of ['estop', 'stop', 'hold']) {
      expect(await page.getByTestId(id).getAttribute('aria-disabled'), id).toBeNull();
    }
  });

  it('is reset and switched on', async () => {
    await page.getByTestId('reset').click();
    await untilText(page, 'state', 'Off');
    await page.getByTestId('on').click();
    await untilText(page, 'state', 'On');
    expect(rig.pin('motion.motion-enabled')).toBe('TRUE');
  });
});

describe('by hand', () => {
  it('jogs joints before homing, shows them, and rejects programs', async () => {
    await page.getByTestId('increment-1').click();
    await hold('jog-J1+', 50);
    await until(() => rig.position(1) === 1, 'the step');
    await untilText(page, 'joint-place-1', '1.000');
    await page.getByTestId('run').click({ force: true });
    await untilText(page, 'why', /Home all first/);
  });

  it('homes one joint, then all', async () => {
    await page.getByTestId('home-1').click();
    await untilText(page, 'homed-1', 'homed', 30_000);
    expect(await text(page, 'homed-0')).toBe('not homed');
    await page.getByTestId('home-all').click();
    await page.getByTestId('all-homed').waitFor({ timeout: 30_000 });
    expect(rig.pin('joint.0.homed')).toBe('TRUE');
    await untilText(page, 'run-state', 'Idle');
  });

  it('jogs by increments, with their sign', async () => {
    const before = rig.position(0);
    await page.getByTestId('increment-10').click();
    await hold('jog-X+', 50);
    await until(() => Math.abs(rig.position(0) - before - 10) < 1e-6, 'ten to the right');
    await page.getByTestId('increment-0.1').click();
    await hold('jog-X-', 50);
    await until(() => Math.abs(rig.position(0) - before - 9.9) < 1e-6, 'a tenth back');
    await untilText(page, 'machine-X', (before + 9.9).toFixed(3));
  });

  it('jogs as long as a button is touched', async () => {
    await page.getByTestId('increment-continuous').click();
    const before = rig.position(1);
    await hold('jog-Y+', 600);
    await stands(1);
    const way = rig.position(1) - before;
    expect(way).toBeGreaterThan(15); // 50 mm/s, longer than the lease of 100 ms
    expect(way).toBeLessThan(60);
  });

  it('jogs as long as a key is pressed', async () => {
    const before = rig.position(0);
    await page.keyboard.down('ArrowLeft');
    await sleep(400);
    await page.keyboard.up('ArrowLeft');
    await stands(0);
    expect(before - rig.position(0)).toBeGreaterThan(8);
    expect(before - rig.position(0)).toBeLessThan(45);
  });

  it.each([
    ['the window loses the attention', () => page.evaluate(() => window.dispatchEvent(new Event('blur')))],
    ['the page is hidden', () => page.evaluate(() => {
      Object.defineProperty(document, 'hidden', { value: true, configurable: true });
      document.dispatchEvent(new Event('visibilitychange'));
      Object.defineProperty(document, 'hidden', { value: false, configurable: true });
    })],
    ['the pointer is lost', () => page.evaluate(() => document.querySelector('[data-testid="jog-X+"]')?.dispatchEvent(new PointerEvent('pointercancel')))],
    ['Stop is pressed', () => page.keyboard.press('Escape')],
  ])('ends a jog when %s', async (_what, end) => {
    const box = await page.getByTestId('jog-X+').boundingBox();
    await page.mouse.move((box?.x ?? 0) + 20, (box?.y ?? 0) + 20);
    const before = rig.position(0);
    await page.mouse.down();
    await until(() => rig.position(0) > before + 2, 'a jog');
    await end();
    await sleep(250);
    const there = rig.position(0);
    await sleep(200);
    expect(rig.position(0)).toBe(there);
    await page.mouse.up();
    await page.getByTestId('increment-10').click();
    await hold('jog-X-', 30);
    await sleep(600);
    await page.getByTestId('increment-continuous').click();
  });

  it('begins nothing by keys while a question is open', async () => {
    await page.getByTestId('touch-X').click();
    await page.getByTestId('touch-off').focus();
    const before = rig.position(0);
    await page.keyboard.down('ArrowRight');
    await sleep(200);
    await page.keyboard.up('ArrowRight');
    expect(rig.position(0)).toBe(before);
    await page.keyboard.press('Escape');
    expect(await page.getByTestId('touch-off').count()).toBe(0);
  });

  it('does not jog by keys in text fields', async () => {
    const before = rig.position(0);
    await page.getByTestId('mdi-line').focus();
    await page.keyboard.down('ArrowRight');
    await sleep(200);
    await page.keyboard.up('ArrowRight');
    expect(rig.position(0)).toBe(before);
  });
});

describe('home again', () => {
  it('homes one joint that is homed, by its letter, after a confirmation', async () => {
    await page.getByTestId('home-again').click();
    const lost = rig.pin('joint.0.homed');
    await page.getByTestId('home-again-dialog').getByText('Close').click();
    expect([lost, rig.pin('joint.0.homed')]).toEqual(['TRUE', 'TRUE']);
    await page.getByTestId('home-again').click();
    expect(await text(page, 'home-again-1')).toBe('Home Y');
    await page.getByTestId('home-again-1').click();
    await until(() => rig.pin('joint.1.homing') === 'TRUE' || rig.pin('joint.1.homed') === 'FALSE', 'homing of Y');
    await until(() => [0, 1, 2].every((joint) => rig.pin(`joint.${joint}.homed`) === 'TRUE'), 'all joints homed');
    await untilText(page, 'run-state', 'Idle');
  });
});

describe('MDI', () => {
  it('executes a line, and keeps it', async () => {
    await page.getByTestId('mdi-line').fill('G0 X10 Y5');
    await page.getByTestId('mdi-send').click();
    await until(() => Math.abs(rig.position(0) - 10) < 1e-6 && Math.abs(rig.position(1) - 5) < 1e-6, 'the place');
    await untilText(page, 'mdi-history', /G0 X10 Y5/);
    await page.getByTestId('mdi-line').press('ArrowUp');
    expect(await page.getByTestId('mdi-line').inputValue()).toBe('G0 X10 Y5');
    await page.getByTestId('mdi-line').fill('');
  });

  it('says what is wrong with a line', async () => {
    await page.getByTestId('mdi-line').fill('G1 Q5');
    await page.getByTestId('mdi-line').press('Enter');
    await page.getByTestId('notice').first().waitFor();
    await tab('messages');
    await untilText(page, 'messages', /Error.*Q/s);
    await page.getByTestId('put-away').click();
    expect(await page.getByTestId('notice').count()).toBe(0);
    await tab('path');
  });

  it('plays a macro with several lines', async () => {
    expect(await text(page, 'macro-0')).toBe('To two');
    await page.getByTestId('macro-0').click();
    await until(() => Math.abs(rig.position(0) - 2) < 1e-6, 'the macro');
  });

  it('sets a work offset to what the operator says, with a comma', async () => {
    await page.getByTestId('touch-X').click();
    await page.getByTestId('touch-off-value').fill('10+5/2');
    await untilText(page, 'touch-off-value-result', '= 12.5 mm');
    await page.getByTestId('touch-off-value').fill('12,5+');
    expect(await page.getByTestId('touch-off-set').getAttribute('aria-disabled')).toBe('true');
    await page.getByTestId('touch-off-value').fill('12,5x');
    expect(await page.getByTestId('touch-off-set').getAttribute('aria-disabled')).toBe('true');
    await page.getByTestId('touch-off-value').fill('12,5');
    await page.getByTestId('touch-off-set').click();
    await untilText(page, 'work-X', '12.500');
    expect(await text(page, 'machine-X')).toBe('2.000');
    await page.getByTestId('touch-X').click();
    await page.getByTestId('touch-off-value').fill('2');
    await page.getByTestId('touch-off-value').press('Enter');
    await untilText(page, 'work-X', '2.000');
  });
});

describe('spindle, coolant, overrides', () => {
  it('turns the spindle both ways and stops it', async () => {
    expect(await page.getByTestId('spindle-set-0').inputValue()).toBe('600');
    await page.getByTestId('spindle-forward-0').click();
    await until(() => Number(rig.pin('spindle.0.speed-out')) === 600, 'forward');
    await untilText(page, 'spindle-state-0', /Forward 600/);
    await page.getByTestId('spindle-set-0').fill('250.5');
    await page.getByTestId('spindle-reverse-0').click();
    await until(() => Number(rig.pin('spindle.0.speed-out')) === -250.5, 'reverse');
    await page.getByTestId('spindle-stop-0').click();
    await until(() => rig.pin('spindle.0.on') === 'FALSE', 'a stop');
    await untilText(page, 'spindle-state-0', 'stopped');
  });

  it('switches coolant', async () => {
    await page.getByTestId('flood').click();
    await until(() => rig.pin('iocontrol.0.coolant-flood') === 'TRUE', 'flood');
    await untilText(page, 'flood', 'Flood: on');
    await page.getByTestId('flood').click();
    await until(() => rig.pin('iocontrol.0.coolant-flood') === 'FALSE', 'no flood');
    await page.getByTestId('mist').click();
    await until(() => rig.pin('iocontrol.0.coolant-mist') === 'TRUE', 'mist');
    await page.getByTestId('mist').click();
  });

  it('overrides within what the machine allows, and shows what it has', async () => {
    const slide = async (id: string, value: number): Promise<void> => {
      await page.getByTestId(id).evaluate((element, wanted) => {
        const input = element as HTMLInputElement;
        input.value = String(wanted);
        input.dispatchEvent(new Event('input', { bubbles: true }));
        input.dispatchEvent(new Event('change', { bubbles: true }));
      }, value);
    };
    await tab('process');
    expect(await page.getByTestId('feed-override').getAttribute('max')).toBe('150');
    await slide('feed-override', 50);
    await untilText(page, 'feed-override-value', '50 %');
    await slide('rapid-override', 25);
    await untilText(page, 'rapid-override-value', '25 %');
    await page.getByTestId('feed-override-reset').click();
    await untilText(page, 'feed-override-value', '100 %');
    await page.getByTestId('rapid-override-reset').click();
    await untilText(page, 'rapid-override-value', '100 %');
    await slide('spindle-override-0', 80);
    await untilText(page, 'spindle-override-0-value', '80 %');
    await page.getByTestId('spindle-override-0-reset').click();
  });
});

describe('overrides by steps', () => {
  it('add up, are at least 44 px large, and go back to 100 percent, in each size without opening anything', async () => {
    for (const [width, height] of [[1280, 800], [1920, 1080], [800, 480], [390, 844]] as const) {
      await page.setViewportSize({ width, height });
      for (const id of ['step-feed', 'step-rapid', 'step-spindle']) {
        for (const end of ['less', 'more']) {
          const box = await page.getByTestId(`${id}-${end}`).boundingBox();
          expect(Math.min(box?.width ?? 0, box?.height ?? 0), `${id}-${end} at ${width}`).toBeGreaterThanOrEqual(44);
          expect((box?.y ?? Infinity) + (box?.height ?? 0), `${id}-${end} at ${width}`).toBeLessThan(height);
        }
      }
      await page.getByTestId('step-feed-less').evaluate((button: HTMLElement) => {
        for (let i = 0; i < 3; ++i) {
          button.click();
        }
      });
      await until(async () => (await page.getByTestId('step-feed-now').textContent()) === '70 %', 'three steps down');
      await page.getByTestId('step-feed-100').click();
      await until(async () => (await page.getByTestId('step-feed-now').textContent()) === '100 %', 'the feed of the program');
    }
    await page.setViewportSize({ width: 1280, height: 800 });
  });

  it('the spindle and coolant are in sight at 1280 by 800 and 800 by 480', async () => {
    for (const [width, height] of [[1280, 800], [800, 480]] as const) {
      await page.setViewportSize({ width, height });
      for (const id of ['spindle-reverse-0', 'spindle-stop-0', 'spindle-forward-0', 'flood', 'mist']) {
        // The page layout changes shortly after a change of the window size.
        await until(() => page.getByTestId(id).evaluate((button) => {
          const { x, y, width: wide, height: high } = button.getBoundingClientRect();
          return x >= 0 && wide >= 44 && high >= 44 && button.contains(document.elementFromPoint(x + wide / 2, y + high / 2));
        }), `${id} in sight at ${width}`);
      }
    }
    await page.setViewportSize({ width: 1280, height: 800 });
  });
});

describe('the card of the positions', () => {
  it('shows F and S as programmed, and the meaning of the active codes', async () => {
    await page.getByTestId('mdi-line').fill('G21 G94 F600 S1200');
    await page.getByTestId('mdi-send').click();
    await untilText(page, 'programmed-feed', 'F600');
    await untilText(page, 'programmed-speed', 'S1200');
    await untilText(page, 'codes', /G21\s+millimetre/);
    await untilText(page, 'codes', /G54\s+work offset 1/);
    await page.getByTestId('mdi-line').fill('');
  });
});

describe('programs', () => {
  it('are listed, opened, and their path is drawn', async () => {
    await tab('programs');
    await untilText(page, 'program-list', /part\.ngc/);
    await page.getByTestId('open-part.ngc').click();
    await page.getByTestId('path-done').waitFor();
    expect(Number(await page.getByTestId('path-canvas').getAttribute('data-points'))).toBeGreaterThan(20);
    await untilText(page, 'program', 'part.ngc');
    const drawn = await page.getByTestId('path-canvas').screenshot();
    expect(drawn.length).toBeGreaterThan(3000); // an empty picture is smaller
  });

  it('are drawn where the offsets put them, also when those change', async () => {
    const low = async (): Promise<string> => (await page.getByTestId('path-canvas').getAttribute('data-low')) ?? '';
    expect(await low()).toMatch(/^0\.000 0\.000 /);
    const give = async (line: string): Promise<void> => {
      await page.getByTestId('mdi-line').fill(line);
      await page.getByTestId('mdi-line').press('Enter');
    };
    await give('G10 L2 P1 X-7 Y-4');
    await until(async () => /^-7\.000 -4\.000 /.test(await low()), 'the path at its new place');
    await give('G10 L2 P1 X0 Y0');
    await until(async () => /^0\.000 0\.000 /.test(await low()), 'the path at its old place');
  });

  it('run, hold, resume, and end where they say', async () => {
    await page.getByTestId('run').click();
    await untilText(page, 'run-state', 'Running');
    await untilText(page, 'line', /Line [2-9]/);
    await page.getByTestId('hold').click();
    await untilText(page, 'run-state', 'Paused');
    await stands(0);
    const held = rig.position(0);
    await sleep(300);
    expect(rig.position(0)).toBe(held);
    await page.getByTestId('resume').click();
    await untilText(page, 'run-state', 'Running');
    await untilText(page, 'run-state', 'Idle', 20_000);
    expect(rig.position(0)).toBeCloseTo(0, 5);
  });

  it('show when they are finished, in which time, and how many parts there are', async () => {
    await untilText(page, 'run-end', /Finished in 0:\d\d\. Parts in this session: 1/);
    await page.reload();
    await untilText(page, 'run-state', 'Idle');
    await page.getByTestId('run').click();
    await untilText(page, 'elapsed', /0:0\d elapsed/);
    await untilText(page, 'percent', /^\d+ %$/);
    expect(await page.getByTestId('run-end').count()).toBe(0);
    await untilText(page, 'run-end', /Parts in this session: 2/, 20_000);
  });

  it('stop at once and start again', async () => {
    await page.getByTestId('run').click();
    await untilText(page, 'run-state', 'Running');
    await until(() => rig.position(0) > 1, 'moves');
    await untilText(page, 'line', /Line 4/);
    await page.getByTestId('stop').click();
    await untilText(page, 'run-state', 'Idle');
    await stands(0);
    await untilText(page, 'run-end', /Stopped at line 4 after 0:0\d/);
    expect(await text(page, 'program')).toContain('part.ngc');
  });

  it('wait at M0 for a person', async () => {
    await tab('programs');
    await page.getByTestId('open-stop.ngc').click();
    await page.getByTestId('run').click();
    await untilText(page, 'run-state', 'Stopped by the program');
    await page.getByTestId('resume').click();
    await untilText(page, 'run-state', 'Idle', 20_000);
    expect(rig.position(0)).toBeCloseTo(20, 5);
  });

  it('tell their errors with their place', async () => {
    await tab('programs');
    await page.getByTestId('open-bad.ngc').click();
    await untilText(page, 'path-errors', /1 errors/);
    await page.getByTestId('path-errors').locator('summary').click();
    await untilText(page, 'path-errors', /bad\.ngc:3/);
  });

  it('are added and deleted', async () => {
    await tab('programs');
    await page.getByTestId('upload').setInputFiles({ name: 'new.ngc', mimeType: 'text/plain', buffer: Buffer.from('G21\nG0 X1\nM2\n') });
    await untilText(page, 'program-list', /new\.ngc/);
    expect(await page.getByTestId('delete-new.ngc').count()).toBe(0); // never beside Open
    await page.getByTestId('programs-tidy').click();
    expect(await page.getByTestId('open-new.ngc').count()).toBe(0);
    await page.getByTestId('delete-new.ngc').click();
    await page.getByTestId('delete-confirm').click();
    await until(async () => !(await text(page, 'program-list')).includes('new.ngc'), 'the file is gone');
    await page.getByTestId('programs-tidy').click();
    await page.getByTestId('open-part.ngc').waitFor();
  });
});

describe('emergency stop', () => {
  it('acts by one touch while a program runs', async () => {
    await tab('programs');
    await page.getByTestId('open-part.ngc').click();
    await page.getByTestId('run').click();
    await untilText(page, 'run-state', 'Running');
    await page.getByTestId('estop').dispatchEvent('pointerdown');
    await untilText(page, 'state', 'Emergency stop', 1000);
    expect(rig.pin('motion.motion-enabled')).toBe('FALSE');
    await stands(0);
  });

  it('acts by its key', async () => {
    await page.getByTestId('reset').click();
    await page.getByTestId('on').click();
    await untilText(page, 'state', 'On');
    await page.keyboard.press('F1');
    await untilText(page, 'state', 'Emergency stop', 1000);
  });

  it('has left no error in the page', () => {
    expect(errorsOf(page)).toEqual([]);
  });
});

describe('a second screen', () => {
  it('shows the same, and one that reloads joins again', async () => {
    const other = await rig.page();
    await bringUp2(other);
    await untilText(page, 'state', 'On');
    await other.context().close();
    await page.reload();
    await untilText(page, 'state', 'On');
  });
});

async function bringUp2(other: Page): Promise<void> {
  await other.getByTestId('reset').click();
  await other.getByTestId('on').click();
  await untilText(other, 'state', 'On');
}
