// SPDX-License-Identifier: GPL-2.0-or-later
import { describe, expect, it } from 'vitest';
import { Link, type LinkEvents, type Socket } from '../src/lib/link';

class FakeSocket implements Socket {
  readyState = 0;
  onopen: ((event: never) => void) | null = null;
  onclose: ((event: never) => void) | null = null;
  onmessage: ((event: { data: string }) => void) | null = null;
  sent: unknown[] = [];
  send(text: string): void {
    this.sent.push(JSON.parse(text));
  }
  close(): void {
    this.readyState = 3;
    this.onclose?.(undefined as never);
  }
  begin(): void {
    this.readyState = 1;
    this.onopen?.(undefined as never);
  }
  tell(value: unknown): void {
    this.onmessage?.({ data: JSON.stringify(value) });
  }
}

function makeRig() {
  const sockets: FakeSocket[] = [];
  const told: string[] = [];
  let now = 0;
  let timers: { at: number; act: () => void }[] = [];
  const events: LinkEvents = {
    values: () => 0,
    questions: () => 0,
    note: () => 0,
    opened: (hello) => told.push(`opened ${hello.client}`),
    closed: () => told.push('closed'),
    status: (delta, isWhole) => told.push(`status ${JSON.stringify(delta)} ${isWhole}`),
    message: (message, ageMs) => told.push(`message ${message.text}${ageMs > 0 ? ` of ${ageMs} ms ago` : ''}`),
    machine: (isUp, client, reason) => told.push(`machine ${isUp} ${client} ${reason}`),
    roundTrip: (ms) => told.push(`round trip ${ms}`),
    silent: (seconds) => told.push(`silent ${seconds}`),
  };
  const link = new Link(events, {
    makeSocket: () => {
      const socket = new FakeSocket();
      sockets.push(socket);
      return socket;
    },
    now: () => now,
    later: (act, ms) => {
      const timer = { at: now + ms, act };
      timers.push(timer);
      return timer;
    },
    cancel: (timer) => {
      timers = timers.filter((one) => one !== timer);
    },
  });
  const pass = (ms: number): void => {
    const end = now + ms;
    for (;;) {
      const next = timers.filter((one) => one.at <= end).sort((a, b) => a.at - b.at)[0];
      if (next === undefined) {
        break;
      }
      timers = timers.filter((one) => one !== next);
      now = next.at;
      next.act();
    }
    now = end;
  };
  link.open();
  return { link, sockets, told, pass };
}

describe('Link', () => {
  it('gives each command its own outcome', async () => {
    const { link, sockets } = makeRig();
    const socket = sockets[0] as FakeSocket;
    socket.begin();
    let hasStarted = false;
    const first = link.post({ message: 'Mdi', line: 'G0' }, () => (hasStarted = true));
    const second = link.post({ message: 'Null' });
    expect(socket.sent).toEqual([
      { id: 1, command: { message: 'Mdi', line: 'G0' }, sent: 0 },
      { id: 2, command: { message: 'Null' }, sent: 0 },
    ]);
    socket.tell({ outcome: { id: 1, progress: 'STARTED' } });
    socket.tell({ outcome: { id: 2, progress: 'REFUSED', reason: 'no' } });
    socket.tell({ outcome: { id: 1, progress: 'DONE' } });
    expect(hasStarted).toBe(true);
    expect(await second).toEqual({ progress: 'REFUSED', reason: 'no' });
    expect(await first).toEqual({ progress: 'DONE', reason: '' });
  });

  it('reports that task does not respond, and that it responds again', () => {
    const { sockets, told } = makeRig();
    const socket = sockets[0] as FakeSocket;
    socket.begin();
    socket.tell({ silent: 0.6 });
    socket.tell({ silent: 0 });
    expect(told.slice(-2)).toEqual(['silent 0.6', 'silent 0']);
  });

  it('sends nothing later that could not be sent at once', async () => {
    const { link, sockets } = makeRig();
    const outcome = link.post({ message: 'SetState', state: 'ON' });
    (sockets[0] as FakeSocket).begin();
    expect((await outcome).progress).toBe('FAILED');
    expect((sockets[0] as FakeSocket).sent).toEqual([]);
  });

  it('fails what was under way when the connection goes, and joins again more and more slowly', async () => {
    const { link, sockets, told, pass } = makeRig();
    (sockets[0] as FakeSocket).begin();
    const lost = link.post({ message: 'RunProgram' });
    (sockets[0] as FakeSocket).close();
    expect((await lost).progress).toBe('FAILED');
    expect(told).toEqual(['closed']);
    pass(249);
    expect(sockets.length).toBe(1);
    pass(1);
    expect(sockets.length).toBe(2);
    (sockets[1] as FakeSocket).close();
    pass(499);
    expect(sockets.length).toBe(2);
    pass(1);
    expect(sockets.length).toBe(3);
  });

  it('takes a silent connection for gone', () => {
    const { sockets, told, pass } = makeRig();
    const socket = sockets[0] as FakeSocket;
    socket.begin();
    pass(1000);
    expect(socket.sent).toEqual([{ ping: 1000 }]);
    socket.tell({ pong: 1000 });
    expect(told).toEqual(['round trip 0']);
    pass(5000);
    expect(told).toContain('closed');
    expect(sockets.length).toBeGreaterThan(1);
  });

  it('hears nothing of a socket that it has left', () => {
    const { sockets, told, pass } = makeRig();
    const old = sockets[0] as FakeSocket;
    old.begin();
    old.close();
    pass(250);
    old.tell({ machine: 'up', client: 9 });
    expect(told).toEqual(['closed']);
  });
  it('shows the age of earlier messages', () => {
    const { sockets, told } = makeRig();
    sockets[0]?.begin();
    sockets[0]?.tell({ message: { number: 1, kind: 'OPERATOR_ERROR', text: 'old' }, age_ms: 90000 });
    sockets[0]?.tell({ message: { number: 2, kind: 'OPERATOR_ERROR', text: 'new' } });
    expect(told).toEqual(['message old of 90000 ms ago', 'message new']);
  });
});
