// SPDX-License-Identifier: GPL-2.0-or-later
// Runs the simulation in a worker, because the main thread renews the leases of jogs in this time.
import { readChunks } from '../path/chunks';
import type { News, Order } from './protocol';
import { Session } from './session';

let session: Session | null = null;
let number = 0;
let reading: AbortController | null = null;
/** The newest request; earlier ones are not shown. */
let wanted: Extract<Order, { kind: 'show' }> | null = null;
let isShowing = false;

function tell(news: News, moved: ArrayBufferLike[] = []): void {
  postMessage(news, { transfer: moved as ArrayBuffer[] });
}

/** Processes waiting messages. A timer would wait for milliseconds. */
function pause(): Promise<void> {
  return new Promise((done) => {
    const { port1, port2 } = new MessageChannel();
    port1.onmessage = () => {
      port1.close();
      done();
    };
    port2.postMessage(null);
  });
}

const TOO_MANY = 429;
const TRIES = 15;
const RETRY_MS = 1000;

/** The server reads only a few programs at a time, so this request waits until programs of other views or screens are read. */
async function fetchBody(address: string, signal: AbortSignal): Promise<ReadableStream<Uint8Array>> {
  let answer = await fetch(address, { signal });
  for (let tries = 1; answer.status === TOO_MANY && tries < TRIES; ++tries) {
    await new Promise((done) => setTimeout(done, RETRY_MS));
    answer = await fetch(address, { signal });
  }
  if (!answer.ok || answer.body === null) {
    const told = (await answer.json().catch(() => null)) as { error?: string } | null;
    throw new Error(told?.error ?? `GET ${address}: ${answer.status}`);
  }
  return answer.body;
}

const POINTS_PER_REPORT = 50_000;

async function open(order: Extract<Order, { kind: 'open' }>, signal: AbortSignal): Promise<void> {
  const mine = new Session(order.frame, order.first_tool, order.rapid_mm_s);
  let isEnded = false;
  let reported = 0;
  for await (const chunk of readChunks(await fetchBody(`/api/path?file=${encodeURIComponent(order.file)}`, signal))) {
    mine.take(chunk);
    isEnded ||= chunk.kind === 'end';
    if (mine.moves.count - reported > POINTS_PER_REPORT) {
      reported = mine.moves.count;
      tell({ number: order.number, kind: 'reading', points: reported });
    }
    if (mine.moves.isCut) {
      isEnded = true;
      break;
    }
  }
  if (!isEnded) {
    throw new Error('the path has ended in the middle');
  }
  session = mine;
  tell({ number: order.number, kind: 'read', facts: mine.finish() });
  tellClock(order.number, mine);
  await readTimes(order, mine, signal);
}

function tellClock(of: number, from: Session): void {
  tell({ number: of, kind: 'clock', total_s: from.clock?.total ?? 0, isPlanned: from.clock?.isPlanned ?? false });
}

/** If the planner cannot calculate the times, the estimate is kept. */
async function readTimes(order: Extract<Order, { kind: 'open' }>, into: Session, signal: AbortSignal): Promise<void> {
  const { feed, rapid, max_velocity } = order.times;
  const query = new URLSearchParams({ file: order.file, feed: String(feed), rapid: String(rapid), max_velocity: String(max_velocity) });
  let hasSum = false;
  try {
    for await (const chunk of readChunks(await fetchBody(`/api/times?${query.toString()}`, signal))) {
      if (chunk.kind === 'times') {
        into.clock?.take(chunk.moves);
      }
      hasSum ||= chunk.kind === 'time_sum';
    }
  } catch {
    return;
  }
  if (hasSum && !into.moves.isCut) {
    into.clock?.finish();
    tellClock(order.number, into);
  }
}

async function prepare(order: Extract<Order, { kind: 'prepare' }>): Promise<void> {
  const { stock, fixtures, floor_mm, tools } = order.setup;
  const prepared = await session?.prepare({ stock, fixtures, floor_mm, tools: new Map(tools), cell_mm: null }, pause, (part) => tell({ number, kind: 'preparing', part }));
  if (prepared !== null && prepared !== undefined && order.number === number) {
    tell({ number, kind: 'prepared', prepared });
  }
}

async function show(): Promise<void> {
  if (isShowing) {
    return;
  }
  isShowing = true;
  while (wanted !== null) {
    const order = wanted;
    wanted = null;
    const shown = order.number === number ? (session?.show(order.at, order.most) ?? null) : null;
    if (shown !== null) {
      tell({ number, kind: 'shown', shown }, [shown.picture.heights.buffer, shown.picture.makers.buffer]);
    }
    await pause();
  }
  isShowing = false;
}

function fail(of: number, error: unknown): void {
  tell({ number: of, kind: 'failed', reason: error instanceof Error ? error.message : String(error) });
}

addEventListener('message', (event: MessageEvent<Order>) => {
  const order = event.data;
  if (order.kind === 'show') {
    // The next position must not hide a restart of the machine.
    const isNew = wanted !== null && 'machine' in wanted.at && wanted.at.machine.isNew;
    wanted = isNew && 'machine' in order.at ? { ...order, at: { machine: { ...order.at.machine, isNew } } } : order;
    void show();
  } else if (order.kind === 'prepare') {
    if (order.number === number) {
      prepare(order).catch((error: unknown) => fail(order.number, error));
    }
  } else {
    session?.cancel();
    session = null;
    reading?.abort();
    number = order.number;
    if (order.kind === 'open') {
      const mine = new AbortController();
      reading = mine;
      open(order, mine.signal).catch((error: unknown) => {
        if (!mine.signal.aborted) {
          fail(order.number, error);
        }
      });
    }
  }
});
