// SPDX-License-Identifier: GPL-2.0-or-later
// Reads the times of a program off the main thread.
import { readChunks } from './chunks';
import type { TimeSum } from './times';

export interface TimesOrder {
  number: number;
  file: string;
  feed: number;
  rapid: number;
  maxVelocity: number;
}

export interface TimedMoves {
  points: Uint32Array;
  lines: Uint32Array;
  seconds: Float32Array;
  velocities: Float32Array;
}

export type TimesNews = { number: number; moves: TimedMoves } | { number: number; sum: TimeSum } | { number: number; failed: string };

let current: AbortController | null = null;

async function read(order: TimesOrder, signal: AbortSignal): Promise<void> {
  const query = new URLSearchParams({ file: order.file, feed: String(order.feed), rapid: String(order.rapid), max_velocity: String(order.maxVelocity) });
  const answer = await fetch(`/api/times?${query.toString()}`, { signal });
  if (!answer.ok || answer.body === null) {
    const told = (await answer.json().catch(() => null)) as { error?: string } | null;
    throw new Error(told?.error ?? `GET /api/times: ${answer.status}`);
  }
  let isEnded = false;
  let fault = '';
  for await (const chunk of readChunks(answer.body)) {
    if (chunk.kind === 'times') {
      const { moves } = chunk;
      const news: TimesNews = { number: order.number, moves };
      postMessage(news, { transfer: [moves.points.buffer, moves.lines.buffer, moves.seconds.buffer, moves.velocities.buffer] as ArrayBuffer[] });
    } else if (chunk.kind === 'time_sum') {
      isEnded = true;
      const news: TimesNews = { number: order.number, sum: chunk.sum };
      postMessage(news);
    } else if (chunk.kind === 'error') {
      fault ||= chunk.text;
    }
  }
  if (!isEnded) {
    throw new Error(fault || 'the times have ended in the middle');
  }
}

addEventListener('message', (event: MessageEvent<TimesOrder>) => {
  current?.abort();
  const mine = new AbortController();
  current = mine;
  read(event.data, mine.signal).catch((error: unknown) => {
    if (!mine.signal.aborted) {
      const news: TimesNews = { number: event.data.number, failed: error instanceof Error ? error.message : String(error) };
      postMessage(news);
    }
  });
});
