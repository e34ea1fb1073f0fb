// SPDX-License-Identifier: GPL-2.0-or-later
import { expect, it } from 'vitest';
import { notices, tell } from '../src/lib/machine.svelte';

it('a message shows when it came, and once although it is sent again', () => {
  const before = Date.now();
  tell('OPERATOR_ERROR', 'joint 0 following error', 90_000);
  tell('OPERATOR_ERROR', 'joint 0 following error', 90_010); // after another connection
  tell('OPERATOR_ERROR', 'joint 0 following error'); // the same fault again
  const times = notices.list.map((one) => one.at.getTime() - before);
  expect(times).toHaveLength(2);
  expect(times[0]).toBeLessThan(5_000);
  expect(times[0]).toBeGreaterThanOrEqual(0);
  expect(Math.abs((times[1] ?? 0) + 90_000)).toBeLessThan(5_000);
});
