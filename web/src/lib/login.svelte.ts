// SPDX-License-Identifier: GPL-2.0-or-later
// The role of this screen at the server. A token is stored in a cookie that scripts cannot read, and not
// here.

export interface Login {
  role: string;
  protection: string;
}

export const login = $state<{ isNeeded: boolean; reason: string }>({ isNeeded: false, reason: '' });

async function ask(method: string, body?: object): Promise<Login> {
  const answer = await fetch('/api/login', { method, ...(body === undefined ? {} : { body: JSON.stringify(body) }) });
  const told = (await answer.json()) as Partial<Login> & { error?: string };
  if (!answer.ok) {
    throw new Error(told.error ?? `${method} /api/login: ${answer.status}`);
  }
  return { role: told.role ?? '', protection: told.protection ?? '' };
}

/** The token of an address that ends in #token=..., which is removed from the address bar and the history. */
function tokenOfAddress(): string | null {
  const found = /^#token=([\w-]+)$/.exec(location.hash)?.[1] ?? null;
  if (found !== null) {
    history.replaceState(null, '', location.pathname + location.search);
  }
  return found;
}

export async function enter(token: string): Promise<boolean> {
  try {
    await ask('POST', { token });
    login.isNeeded = false;
    login.reason = '';
    return true;
  } catch (error) {
    login.reason = error instanceof Error ? error.message : String(error);
    return false;
  }
}

/** True if a token is required and no valid one is present. */
export async function checkLogin(): Promise<void> {
  try {
    login.isNeeded = (await ask('GET')).role === '';
  } catch {
    // No server answers; the connection state shows this.
  }
}

export async function beginLogin(): Promise<void> {
  const token = tokenOfAddress();
  await checkLogin();
  if (token !== null && login.isNeeded) {
    await enter(token);
  }
}

export async function leave(): Promise<void> {
  await ask('DELETE').catch(() => undefined);
  location.reload();
}
