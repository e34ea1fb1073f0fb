// SPDX-License-Identifier: GPL-2.0-or-later
import { describe, expect, it } from 'vitest';
import { Jogger, LEASE_MS, RENEWAL_MS, type Jog } from '../src/lib/jog';
import type { Command, Outcome } from '../src/lib/link';

const DONE: Outcome = { progress: 'DONE', reason: '' };
const X: Jog = { isJoint: false, index: 0, velocity: 10, increment: null };

function makeRig() {
  const posted: Command[] = [];
  const ended: string[] = [];
  let timers: (() => void)[] = [];
  const state = { isPrepared: true, answer: (): Promise<Outcome> => Promise.resolve(DONE), prepare: (): Promise<boolean> => Promise.resolve(true) };
  const jogger = new Jogger({
    post: (command) => {
      posted.push(command);
      return state.answer();
    },
    prepare: () => state.prepare(),
    isPrepared: () => state.isPrepared,
    every: (act) => {
      timers.push(act);
      return act;
    },
    cancel: (timer) => {
      timers = timers.filter((one) => one !== timer);
    },
    ended: (reason) => ended.push(reason),
  });
  const tick = async (): Promise<void> => {
    timers.forEach((act) => act());
    await Promise.resolve();
    await Promise.resolve();
  };
  return { jogger, posted, ended, state, tick, count: () => timers.length };
}

const names = (posted: Command[]): string[] => posted.map((one) => `${one.message}${one['is_renewal'] === true ? ' again' : ''}`);

describe('Jogger', () => {
  it('renews well within the lease, and stops on release', async () => {
    expect(RENEWAL_MS * 3).toBeLessThan(LEASE_MS);
    const { jogger, posted, tick, count } = makeRig();
    await jogger.press(X);
    await tick();
    await tick();
    jogger.release(false, 0);
    await tick();
    expect(names(posted)).toEqual(['JogContinuous', 'JogContinuous again', 'JogContinuous again', 'JogStop']);
    expect(posted[0]).toMatchObject({ lease_ms: LEASE_MS, velocity: 10, index: 0, is_joint: false });
    expect(posted[0]?.['is_renewal']).toBeUndefined();
    expect(count()).toBe(0);
  });

  it('does not begin after a release while the mode was changing', async () => {
    const { jogger, posted, state } = makeRig();
    state.isPrepared = false;
    let go = (_ok: boolean): void => undefined;
    state.prepare = () => new Promise((resolve) => (go = resolve));
    const pressed = jogger.press(X);
    jogger.release(false, 0);
    go(true);
    await pressed;
    expect(posted).toEqual([]);
  });

  it('does not begin when the mode cannot be changed', async () => {
    const { jogger, posted, state } = makeRig();
    state.isPrepared = false;
    state.prepare = () => Promise.resolve(false);
    await jogger.press(X);
    expect(posted).toEqual([]);
    expect(jogger.isJogging).toBe(false);
  });

  it('reports a rejected renewal once, and stops renewing', async () => {
    const { jogger, posted, ended, state, tick, count } = makeRig();
    await jogger.press(X);
    state.answer = () => Promise.resolve({ progress: 'REFUSED', reason: 'it has ended' });
    await tick();
    await tick();
    expect(ended).toEqual(['it has ended']);
    expect(count()).toBe(0);
    expect(names(posted)).toEqual(['JogContinuous', 'JogContinuous again']);
  });

  it('steps once for a press, and letting go does not cut the step short', async () => {
    const { jogger, posted } = makeRig();
    await jogger.press({ ...X, velocity: -10, increment: 0.5 });
    jogger.release(false, 0);
    expect(posted).toEqual([{ message: 'JogIncrement', is_joint: false, index: 0, velocity: 10, distance: -0.5 }]);
  });

  it('ends all at once', async () => {
    const { jogger, posted } = makeRig();
    await jogger.press(X);
    await jogger.press({ ...X, index: 2 });
    await jogger.press({ ...X, index: 2, velocity: -3 }); // is pressed already
    jogger.releaseAll();
    expect(names(posted)).toEqual(['JogContinuous', 'JogContinuous', 'JogStop', 'JogStop']);
    expect(jogger.isJogging).toBe(false);
  });
});
