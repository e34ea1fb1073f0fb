// SPDX-License-Identifier: GPL-2.0-or-later
import { expect, it } from 'vitest';
import { Dismissed } from '../src/lib/dismissed';

function storage(): Pick<Storage, 'getItem' | 'setItem'> {
  const all = new Map<string, string>();
  return { getItem: (key) => all.get(key) ?? null, setItem: (key, value) => void all.set(key, value) };
}
const ERROR = { kind: 'OPERATOR_ERROR', text: 'joint 0 following error', at: 1_000_000, number: 4, run: 'a' };
const NOTE = { kind: 'OPERATOR_TEXT', text: 'door open', at: 1_000_000, number: 0, run: 's' };

it('knows after a reload what was dismissed', () => {
  const kept = storage();
  new Dismissed(kept).add([ERROR, NOTE]);
  const again = new Dismissed(kept);
  // the message number is unique, also from another server
  expect(again.has({ ...ERROR, at: ERROR.at + 60_000 })).toBe(true);
  expect(again.has({ ...NOTE, at: NOTE.at + 1000 })).toBe(true);
});

it('shows what is new, and the same fault again', () => {
  const kept = new Dismissed(storage());
  kept.add([ERROR, NOTE]);
  expect(kept.has({ ...ERROR, number: 5 })).toBe(false);
  expect(kept.has({ ...ERROR, run: 'b' })).toBe(false); // the message of a machine that was restarted
  expect(kept.has({ ...NOTE, run: 'other' })).toBe(false); // of another server
  expect(kept.has({ ...NOTE, at: NOTE.at + 5000 })).toBe(false);
});

it('keeps the last 200, and does without a storage', () => {
  const kept = storage();
  const dismissed = new Dismissed(kept);
  dismissed.add(Array.from({ length: 300 }, (_, number) => ({ ...ERROR, number: number + 1 })));
  expect((JSON.parse(kept.getItem('millwright.dismissed') ?? '[]') as unknown[]).length).toBe(200);
  expect(dismissed.has({ ...ERROR, number: 300 })).toBe(true);
  expect(new Dismissed({ getItem: () => '{', setItem: () => undefined }).has(ERROR)).toBe(false);
  new Dismissed(null).add([ERROR]);
});
