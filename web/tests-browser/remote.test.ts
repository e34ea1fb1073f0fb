// SPDX-License-Identifier: GPL-2.0-or-later
// Tests access from another computer: token, TLS, roles, and the option that disables the protection (J3). Covers all cells of the table in
// docs/reference/api.md that a browser can request.
import { request as httpsRequest } from 'node:https';
import { request as httpRequest } from 'node:http';
import type { Page } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, it } from 'vitest';
import { Rig, until, untilText } from './rig';

const rig = new Rig();
const ROLES = ['view', 'operate', 'configure'] as const;

/** The status of an answer. */
function ask(address: string, method: string, path: string, headers: Record<string, string> = {}, body = ''): Promise<number> {
  const url = new URL(path, address);
  const begin = url.protocol === 'https:' ? httpsRequest : httpRequest;
  return new Promise((done, failed) => {
    const asked = begin(url, { method, headers, rejectUnauthorized: false }, (answer) => {
      answer.resume();
      answer.on('end', () => done(answer.statusCode ?? 0));
    });
    asked.on('error', failed);
    asked.end(body);
  });
}
const bearer = (token: string): Record<string, string> => ({ Authorization: `Bearer ${token}` });

/** Sends one command on a socket of the page and returns its outcome. */
async function command(page: Page, order: object): Promise<{ progress: string; reason?: string }> {
  return page.evaluate(
    (sent) =>
      new Promise<{ progress: string; reason?: string }>((done, failed) => {
        const socket = new WebSocket(`${location.origin.replace('http', 'ws')}/api/socket`);
        socket.onerror = () => failed(new Error('no socket'));
        socket.onmessage = (event: MessageEvent<string>) => {
          const told = JSON.parse(event.data) as { hello?: object; outcome?: { progress: string; reason?: string } };
          if (told.hello !== undefined) {
            socket.send(JSON.stringify({ id: 1, command: sent }));
          } else if (told.outcome !== undefined && told.outcome.progress !== 'STARTED') {
            socket.close();
            done(told.outcome);
          }
        };
      }),
    order,
  );
}

beforeAll(async () => {
  rig.write('part.ngc', 'G21 F600\nG1 X10\nM2\n');
  await rig.startServer(0, ['--listen', '127.0.0.1:0']);
  await rig.startMachine();
  await until(async () => (await ask(rig.remoteAddress, 'GET', '/api/tools', bearer(rig.token('view')))) === 200, 'the server to find the machine');
});

afterAll(async () => {
  await rig.end();
});

describe('with a token and TLS', () => {
  it.each(ROLES)('%s may do what the table says, and no more', async (role) => {
    const shown = bearer(rig.token(role));
    const may = { view: 0, operate: 1, configure: 2 }[role];
    const at = rig.remoteAddress;
    for (const path of ['/api/schema', '/api/machine', '/api/tools', '/api/files', '/api/files/part.ngc', '/api/path?file=part.ngc', '/api/hal?glob=motion.*', '/api/scope', '/metrics']) {
      expect(await ask(at, 'GET', path, shown), path).toBe(200);
    }
    expect(await ask(at, 'PUT', '/api/files/new.ngc', shown, 'M2\n')).toBe(may >= 1 ? 200 : 403);
    expect(await ask(at, 'DELETE', '/api/files/new.ngc', shown)).toBe(may >= 1 ? 200 : 403);
    expect(await ask(at, 'POST', '/api/questions', shown, '{"id":"x","yes":true}')).toBe(may >= 1 ? 409 : 403);
    expect(await ask(at, 'PUT', '/api/hal/halui.abort', shown, '{"value":"x"}')).toBe(may >= 2 ? 400 : 403);
    expect(await ask(at, 'POST', '/api/scope', shown, '{}')).toBe(may >= 2 ? 400 : 403);
    expect(await ask(at, 'DELETE', '/api/scope', shown)).toBe(may >= 2 ? 200 : 403);
  });

  it('without one, or with a wrong one, only the page itself is had', async () => {
    const at = rig.remoteAddress;
    for (const headers of [{}, bearer('wrong'), bearer('0'.repeat(64)), { Cookie: `millwright_token_${new URL(at).port}=wrong` }]) {
      expect(await ask(at, 'GET', '/', headers)).toBe(200);
      for (const path of ['/api/machine', '/api/files', '/api/hal', '/metrics', '/api/socket']) {
        expect(await ask(at, 'GET', path, headers), path).toBe(401);
      }
    }
  });

  it('pages of other sites, and other names, reach nothing', async () => {
    const shown = bearer(rig.token('configure'));
    const at = rig.remoteAddress;
    expect(await ask(at, 'GET', '/api/machine', { ...shown, Origin: at.slice(0, -1) })).toBe(200);
    for (const origin of ['https://evil.example', 'null', at.slice(0, -1).replace('https', 'http')]) {
      expect(await ask(at, 'GET', '/api/machine', { ...shown, Origin: origin }), origin).toBe(403);
    }
    expect(await ask(at, 'GET', '/api/machine', { ...shown, Host: 'evil.example' })).toBe(403);
    expect(await ask(at, 'GET', '/api/machine', { ...shown, 'Sec-Fetch-Site': 'cross-site' })).toBe(403);
  });

  it('a browser requires the token, reports a wrong one, and accepts the right one', async () => {
    const page = await rig.page({ ignoreHTTPSErrors: true }, rig.remoteAddress);
    await page.getByTestId('login').waitFor();
    await page.getByTestId('login-token').fill('guess');
    await page.getByTestId('login-enter').click();
    await untilText(page, 'login-wrong', /opens nothing/);
    await page.getByTestId('login-token').fill(rig.token('operate'));
    await page.getByTestId('login-enter').click();
    await untilText(page, 'state', 'Emergency stop');
    expect(await page.getByTestId('login').count()).toBe(0);
    await page.getByTestId('reset').click();
    await untilText(page, 'state', 'Off');
    expect(await page.evaluate(() => document.cookie)).toBe(''); // scripts cannot read it
    await page.reload();
    await untilText(page, 'state', 'Off');
    await page.getByTestId('tab-settings').click();
    await untilText(page, 'role', /operate the machine/);
    await page.getByTestId('login-out').click();
    await page.getByTestId('login').waitFor();
    await page.context().close();
  });

  it('a role that may only view is shown, and can still stop', async () => {
    const page = await rig.page({ ignoreHTTPSErrors: true }, `${rig.remoteAddress}#token=${rig.token('view')}`);
    await untilText(page, 'state', 'Off');
    expect(page.url()).toBe(rig.remoteAddress); // the token is not visible
    await page.getByTestId('on').click({ force: true });
    await untilText(page, 'why', /may only view/);
    expect(await command(page, { message: 'SetState', state: 'ON' })).toMatchObject({ progress: 'REFUSED' });
    expect(await command(page, { message: 'Mdi', line: 'G0 X1' })).toMatchObject({ progress: 'REFUSED' });
    expect(await command(page, { message: 'JogContinuous', is_joint: true, index: 0, velocity: 1, lease_ms: 100 })).toMatchObject({ progress: 'REFUSED' });
    expect(await command(page, { message: 'AbortAll' })).toMatchObject({ progress: 'DONE' });
    await page.getByTestId('estop').dispatchEvent('pointerdown');
    await untilText(page, 'state', 'Emergency stop');
    await page.context().close();
  });

  it('this computer needs none', async () => {
    const page = await rig.page();
    await untilText(page, 'state', 'Emergency stop');
    expect(await page.getByTestId('login').count()).toBe(0);
    expect(await page.getByTestId('unprotected').count()).toBe(0);
    await page.context().close();
  });
});

describe('without protection, by an explicit word', () => {
  it('the screen shows this in every view, and all clients have the chosen role', async () => {
    const other = new Rig();
    try {
      await other.startServer(0, ['--listen', '127.0.0.1:0', '--unprotected', 'view']);
      expect(other.remoteAddress).toMatch(/^http:/);
      const page = await other.page({}, other.remoteAddress);
      await untilText(page, 'unprotected', /unprotected.*view and stop/);
      await page.getByTestId('tab-messages').click();
      await page.getByTestId('unprotected').waitFor();
      expect(await ask(other.remoteAddress, 'PUT', '/api/files/x.ngc', {}, 'M2\n')).toBe(403);
      await until(async () => (await ask(other.remoteAddress, 'GET', '/api/files')) === 200, 'the files');
    } finally {
      await other.end();
    }
  });
});
