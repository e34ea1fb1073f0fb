// SPDX-License-Identifier: GPL-2.0-or-later
// Offers of a shop: which are shown, and what a decision sends.
import { afterEach, expect, test, vi } from 'vitest';
import { decide, isShown, listOffers, type Offer } from '../src/lib/offers';

const offer = (state: Offer['state'], job = false): Offer => ({ id: 'a', name: 'a.ngc', from: 'Eva', note: '', parts: 2, bytes: 3, files: ['a.ngc'], received_ms: 0, state, job });
const answers = (status: number, body: unknown): void => {
  vi.stubGlobal('fetch', vi.fn(() => Promise.resolve(new Response(JSON.stringify(body), { status }))));
};
afterEach(() => vi.unstubAllGlobals());

test('offers that wait and accepted jobs are shown', () => {
  expect([offer('received'), offer('accepted', true), offer('accepted'), offer('declined'), offer('withdrawn'), offer('rejected')].map(isShown)).toEqual([true, true, false, false, false, false]);
});

test('an acceptance sends the name of the operator, and asks before it replaces', async () => {
  answers(409, { error: 'a.ngc exists with another content.', replaces: ['a.ngc'] });
  expect(await decide('a', 'Jo', { decision: 'accept', replace: false })).toEqual(['a.ngc']);
  expect(fetch).toHaveBeenCalledWith('/api/offers/a', { method: 'POST', body: '{"decision":"accept","replace":false,"by":"Jo"}' });
  answers(200, {});
  expect(await decide('a', 'Jo', { decision: 'accept', replace: true })).toBeNull();
});

test('an error is the text of the server', async () => {
  answers(409, { error: 'A program is running.' });
  await expect(decide('a', '', { decision: 'accept', replace: false })).rejects.toThrow('A program is running.');
  answers(503, { error: 'The index is damaged.' });
  await expect(listOffers()).rejects.toThrow('The index is damaged.');
});
