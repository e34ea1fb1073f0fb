// SPDX-License-Identifier: GPL-2.0-or-later
// Programs in the machine's folder, by docs/reference/api.md.

export interface ProgramFile {
  name: string;
  size: number;
  modified_s: number;
}

export const PIECE_BYTES = 1024 * 1024;

async function ask(method: string, path: string, body?: Blob | string): Promise<Response> {
  const answer = await fetch(path, { method, ...(body === undefined ? {} : { body }) });
  if (!answer.ok) {
    const told = (await answer.json().catch(() => null)) as { error?: string } | null;
    throw new Error(told?.error ?? `${method} ${path}: ${answer.status}`);
  }
  return answer;
}

function address(name: string): string {
  return `/api/files/${encodeURIComponent(name)}`;
}

export async function listPrograms(): Promise<ProgramFile[]> {
  const told = (await (await ask('GET', '/api/files')).json()) as { files: ProgramFile[] };
  return told.files;
}

/** `isMade`: reads the program that a filter has created from the file. */
export async function readProgram(name: string, isMade = false): Promise<string> {
  return (await ask('GET', `${address(name)}${isMade ? '?made' : ''}`)).text();
}

/** The version that the last save has replaced; null if there is none. */
export async function readFormer(name: string): Promise<string | null> {
  const answer = await fetch(`${address(name)}?former`);
  if (answer.status === 404) {
    return null;
  }
  if (!answer.ok) {
    const told = (await answer.json().catch(() => null)) as { error?: string } | null;
    throw new Error(told?.error ?? `GET ${address(name)}?former: ${answer.status}`);
  }
  return answer.text();
}

type FilterLine = { progress: number } | { made: string } | { error: string };

/** Runs the filter of a file and returns the path of the program. The signal aborts it. */
export async function runFilter(name: string, tell: (percent: number) => void, signal: AbortSignal): Promise<string> {
  const answer = await fetch(`/api/filter?file=${encodeURIComponent(name)}`, { method: 'POST', signal });
  if (!answer.ok || answer.body === null) {
    const told = (await answer.json().catch(() => null)) as { error?: string } | null;
    throw new Error(told?.error ?? `POST /api/filter: ${answer.status}`);
  }
  const reader = answer.body.pipeThrough(new TextDecoderStream()).getReader();
  let rest = '';
  for (;;) {
    const { done, value } = await reader.read();
    rest += value ?? '';
    for (let end = rest.indexOf('\n'); end >= 0; end = rest.indexOf('\n')) {
      const line = JSON.parse(rest.slice(0, end)) as FilterLine;
      rest = rest.slice(end + 1);
      if ('made' in line) {
        return line.made;
      }
      if ('error' in line) {
        throw new Error(line.error);
      }
      tell(line.progress);
    }
    if (done) {
      throw new Error('the filter has told no end');
    }
  }
}

export async function deleteProgram(name: string): Promise<void> {
  await ask('DELETE', address(name));
}

/** Sends the file in pieces, because a jog renews its lease on the same connection and must not wait for a file. */
export async function uploadProgram(name: string, content: Blob, tell: (share: number) => void): Promise<void> {
  if (content.size === 0) {
    await ask('PUT', address(name), '');
    return;
  }
  for (let at = 0; at < content.size; at += PIECE_BYTES) {
    tell(at / content.size);
    const piece = content.slice(at, at + PIECE_BYTES);
    await ask('PUT', `${address(name)}?offset=${at}&size=${content.size}`, piece);
  }
  tell(1);
}
