// SPDX-License-Identifier: GPL-2.0-or-later
// Reads a path in a worker, because the main thread renews the leases of jogs in this time.
import { readChunks, type Chunk } from './chunks';

export interface PathOrder {
  file: string;
  number: number;
}

export type PathNews =
  | { number: number; chunk: Chunk }
  | { number: number; failed: string };

let current: AbortController | null = null;

async function read(order: PathOrder, signal: AbortSignal): Promise<void> {
  const answer = await fetch(`/api/path?file=${encodeURIComponent(order.file)}`, { signal });
  if (!answer.ok || answer.body === null) {
    const told = (await answer.json().catch(() => null)) as { error?: string } | null;
    throw new Error(told?.error ?? `GET /api/path: ${answer.status}`);
  }
  let isEnded = false;
  for await (const chunk of readChunks(answer.body)) {
    isEnded = isEnded || chunk.kind === 'end';
    const news: PathNews = { number: order.number, chunk };
    // points, lines and types share one buffer
    const moved = chunk.kind === 'moves' || chunk.kind === 'wires' ? [chunk.places.buffer, chunk.shades.buffer] : [];
    postMessage(news, { transfer: moved as ArrayBuffer[] });
  }
  if (!isEnded) {
    throw new Error('the path has ended in the middle');
  }
}

addEventListener('message', (event: MessageEvent<PathOrder>) => {
  current?.abort();
  const mine = new AbortController();
  current = mine;
  read(event.data, mine.signal).catch((error: unknown) => {
    if (!mine.signal.aborted) {
      const text = error instanceof Error ? error.message : String(error);
      const news: PathNews = { number: event.data.number, failed: text };
      postMessage(news);
    }
  });
});
