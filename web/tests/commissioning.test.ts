// SPDX-License-Identifier: GPL-2.0-or-later
// Tests the held button of the commissioning steps (A7).
import { afterEach, beforeEach, expect, it, vi } from 'vitest';
import { StepsSession, type StepsSocket } from '../src/first/commissioning.svelte';

class FakeSocket implements StepsSocket {
  onopen: (() => void) | null = null;
  onmessage: ((event: { data: string }) => void) | null = null;
  onclose: (() => void) | null = null;
  bufferedAmount = 0;
  readonly sent: { number?: number; act?: string }[] = [];
  send(text: string): void {
    this.sent.push(JSON.parse(text) as { number?: number; act?: string });
  }
  close(): void {
    this.onclose?.();
  }
  show(number: number): void {
    this.onmessage?.({ data: JSON.stringify({ state: 'running', error: '', number, steps: [] }) });
  }
}

let socket: FakeSocket;
let session: StepsSession;
beforeEach(() => {
  vi.useFakeTimers();
  socket = new FakeSocket();
  session = new StepsSession(socket, { key: 'k', ini: '/m.ini' });
  socket.onopen?.();
  socket.show(7);
  socket.sent.length = 0;
});
afterEach(() => {
  vi.useRealTimers();
});

it('renews a press well within the time after which it counts as released', () => {
  session.press();
  vi.advanceTimersByTime(1000);
  expect(socket.sent.length).toBeGreaterThanOrEqual(9);
  expect(socket.sent.every((one) => one.act === 'hold' && one.number === 7)).toBe(true);
  session.release();
  expect(socket.sent.at(-1)).toEqual({ number: 7, act: 'release' });
  const count = socket.sent.length;
  vi.advanceTimersByTime(1000);
  expect(socket.sent.length).toBe(count);
});

it('does not carry a press into the next motion', () => {
  session.press();
  socket.show(8);
  socket.sent.length = 0;
  vi.advanceTimersByTime(1000);
  expect(socket.sent).toEqual([]);
});

it('drops renewals that cannot be sent at once', () => {
  session.press();
  socket.bufferedAmount = 10;
  const count = socket.sent.length;
  vi.advanceTimersByTime(1000);
  expect(socket.sent.length).toBe(count);
});

it('sends nothing after its end', () => {
  session.press();
  session.end();
  const count = socket.sent.length;
  vi.advanceTimersByTime(1000);
  session.confirm();
  session.press();
  expect(socket.sent.length).toBe(count);
});
