// SPDX-License-Identifier: GPL-2.0-or-later
// A simulated mill in real time, its server, and a browser, with a separate instance, folders and ports for
// each file.
import { createRequire } from 'node:module';
import { createServer } from 'node:net';
import { execFileSync, spawn, spawnSync, type ChildProcess } from 'node:child_process';
import { cpSync, existsSync, mkdirSync, mkdtempSync, openSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { chromium, type Browser, type BrowserContextOptions, type Page } from 'playwright-core';
import { expect, type TestContext } from 'vitest';

const ROOT = fileURLToPath(new URL('../..', import.meta.url));
const BUILD = process.env['MW_BUILD'] ?? join(ROOT, 'build/release');
const CHROMIUM = process.env['MW_CHROMIUM'] ?? '/usr/bin/chromium';
const FLAGS = ['--headless', '--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync'];
const STEP_MS = 40_000;

const BY_HAND = `unlinkp iocontrol.0.tool-change
unlinkp iocontrol.0.tool-changed
loadusr -W hal_manualtoolchange
net by-hand iocontrol.0.tool-change => hal_manualtoolchange.change
net by-hand-done hal_manualtoolchange.changed => iocontrol.0.tool-changed
net by-hand-number iocontrol.0.tool-prep-number => hal_manualtoolchange.number
`;

/** Tools are changed manually. */
export function byHand(ini: string): string {
  return ini.replace('HALFILE = spindle_sim.hal\n', 'HALFILE = spindle_sim.hal\nHALFILE = by_hand.hal\n');
}

export function sleep(ms: number): Promise<void> {
  return new Promise((done) => setTimeout(done, ms));
}

export async function until(isTrue: () => boolean | Promise<boolean>, what: string, ms = STEP_MS): Promise<void> {
  const deadline = Date.now() + ms;
  while (!(await isTrue())) {
    if (Date.now() > deadline) {
      throw new Error(`timeout while waiting for: ${what}`);
    }
    await sleep(20);
  }
}

interface Started {
  process: ChildProcess;
  output: string;
}

export class Rig {
  readonly folder = mkdtempSync(join(tmpdir(), 'mw-screen-'));
  readonly programs = join(this.folder, 'programs');
  readonly ini: string;
  private readonly env: NodeJS.ProcessEnv;
  private readonly started: Started[] = [];
  private browser: Browser | null = null;
  private files = 0;
  address = '';
  /** Address for other computers. */
  remoteAddress = '';

  constructor(change: (ini: string) => string = (ini) => ini, machine = 'mill_mm') {
    if (!existsSync(CHROMIUM)) {
      throw new Error(`there is no ${CHROMIUM}: script/bootstrap installs it`);
    }
    cpSync(join(ROOT, 'configs'), join(this.folder, 'configs'), { recursive: true, filter: (path) => !/\.(var|journal)$/.test(path) });
    mkdirSync(this.programs);
    this.ini = join(this.folder, `configs/sim/${machine}.ini`);
    const plain = readFileSync(this.ini, 'utf8');
    writeFileSync(join(this.folder, 'configs/sim/by_hand.hal'), BY_HAND);
    writeFileSync(this.ini, change(plain.replace(/PROGRAM_PREFIX = .*/, `PROGRAM_PREFIX = ${this.programs}`)));
    this.env = { ...process.env, XDG_CONFIG_HOME: join(this.folder, 'config'), XDG_CACHE_HOME: join(this.folder, 'cache'), MILLWRIGHT_INSTANCE: `screen-${process.pid}-${Math.floor(performance.now())}` };
  }

  write(name: string, text: string): void {
    writeFileSync(join(this.programs, name), text);
  }

  private begin(words: string[]): Started {
    const output = join(this.folder, `${this.files++}.out`);
    const file = openSync(output, 'w');
    const process = spawn(join(BUILD, 'bin/millwright'), words, { env: this.env, stdio: ['ignore', file, file] });
    const one = { process, output };
    this.started.push(one);
    return one;
  }

  async startMachine(): Promise<ChildProcess> {
    const one = this.begin(['start', this.ini, '--no-display']);
    const told = (): string => readFileSync(one.output, 'utf8');
    await until(() => told().includes('is running: instance') || one.process.exitCode !== null, 'the machine');
    if (one.process.exitCode !== null) {
      throw new Error(`the machine has ended: ${told()}`);
    }
    return one.process;
  }

  /** `millwright select --browser` for a user with the home folder `home`, with configurations in `shop`. */
  async startSelector(port: number, home: string, shop: string): Promise<ChildProcess> {
    this.env['HOME'] = home;
    this.env['LINUXCNC_AUX_CONFIGS'] = shop;
    delete this.env['DISPLAY'];
    delete this.env['WAYLAND_DISPLAY'];
    const one = this.begin(['select', '--browser', '--port', String(port)]);
    const told = (): string => readFileSync(one.output, 'utf8');
    await until(() => told().includes('#key=') || one.process.exitCode !== null, 'the selector');
    this.address = /http:\S+/.exec(told())?.[0] ?? '';
    return one.process;
  }

  /** On a free port, or on the port used before. */
  async startServer(port = 0, words: string[] = []): Promise<ChildProcess> {
    const one = this.begin(['ui', this.ini, '--port', String(port), ...words]);
    const told = (): string => readFileSync(one.output, 'utf8');
    const wanted = words.includes('--listen') ? /for other computers.*\n/ : /http:\/\//;
    await until(() => wanted.test(told()) || one.process.exitCode !== null, 'the server');
    const address = /http:\/\/[\d.]+:\d+\//.exec(told())?.[0];
    this.remoteAddress = /for other computers.*(https?:\/\/[\d.]+:\d+\/)/.exec(told())?.[1] ?? '';
    if (address === undefined) {
      throw new Error(`the server has ended: ${told()}`);
    }
    this.address = address;
    return one.process;
  }

  /** The secret of a role, from the file that the server has created. */
  token(role: string): string {
    const text = readFileSync(join(this.folder, 'config/millwright/screen/tokens'), 'utf8');
    return new RegExp(`^${role} (\\w+)$`, 'm').exec(text)?.[1] ?? '';
  }

  /** Private memory of the largest page of the browser, and its share of shared memory. [MB] */
  async pageMemory(): Promise<number> {
    const session = await (this.browser as Browser).newBrowserCDPSession();
    const { processInfo } = await session.send('SystemInfo.getProcessInfo');
    await session.detach();
    const sizes = processInfo
      .filter((one) => one.type === 'renderer')
      .map((one) => {
        try {
          return Number(/^Pss:\s+(\d+) kB/m.exec(readFileSync(`/proc/${one.id}/smaps_rollup`, 'utf8'))?.[1] ?? 0) / 1024;
        } catch {
          return 0; // it has just ended
        }
      });
    return Math.max(...sizes);
  }

  /** Processor time of all processes of the browser. [s] */
  async processorTime(): Promise<number> {
    const session = await (this.browser as Browser).newBrowserCDPSession();
    const { processInfo } = await session.send('SystemInfo.getProcessInfo');
    await session.detach();
    return processInfo.reduce((sum, one) => sum + one.cpuTime, 0);
  }

  get port(): number {
    return Number(new URL(this.address).port);
  }

  async page(options: BrowserContextOptions = {}, address = this.address): Promise<Page> {
    this.browser ??= await chromium.launch({ executablePath: CHROMIUM, args: FLAGS });
    const context = await this.browser.newContext({ viewport: { width: 1280, height: 800 }, locale: 'en-GB', colorScheme: 'dark', ...options });
    const page = await context.newPage();
    page.setDefaultTimeout(10_000);
    const errors: string[] = [];
    page.on('pageerror', (error) => errors.push(String(error)));
    page.on('console', (text) => {
      if (text.type() === 'error' && !/ERR_CONNECTION_REFUSED|status of 40[0-9]|code: 401/.test(text.text())) {
        errors.push(text.text());
      }
    });
    (page as Page & { errors: string[] }).errors = errors;
    await page.goto(address);
    return page;
  }

  /** Samples of the X axis (output of tests/e2e/joint_watch.py) until its standard input is closed. */
  watchJoint(): ChildProcess {
    const process = spawn('python3', [join(ROOT, 'tests/e2e/joint_watch.py'), join(BUILD, 'lib/python')], { env: this.env, stdio: ['pipe', 'pipe', 'inherit'] });
    this.started.push({ process, output: '' });
    return process;
  }

  /** Value of a HAL pin. */
  pin(name: string): string {
    return execFileSync(join(BUILD, 'bin/halcmd'), ['getp', name], { env: this.env, encoding: 'utf8' }).trim();
  }
  /** Value of a HAL signal; empty if it does not exist. */
  signal(name: string): string {
    return spawnSync(join(BUILD, 'bin/halcmd'), ['gets', name], { env: this.env, encoding: 'utf8', stdio: ['ignore', 'pipe', 'ignore'] }).stdout.trim();
  }
  setPin(name: string, value: string): void {
    execFileSync(join(BUILD, 'bin/halcmd'), ['setp', name, value], { env: this.env });
  }
  position(joint: number): number {
    return Number(this.pin(`joint.${joint}.pos-cmd`));
  }

  async end(): Promise<void> {
    await this.browser?.close();
    for (const { process } of this.started) {
      if (process.exitCode === null && process.signalCode === null) {
        process.kill('SIGTERM');
      }
    }
    await Promise.all(
      this.started.map(async ({ process }) => {
        try {
          await until(() => process.exitCode !== null || process.signalCode !== null, 'an end', 10_000);
        } catch {
          process.kill('SIGKILL');
        }
      }),
    );
    rmSync(this.folder, { recursive: true, force: true });
  }
}

export async function freePort(): Promise<number> {
  return new Promise((done) => {
    const server = createServer().listen(0, '127.0.0.1', () => {
      const address = server.address();
      server.close(() => done(typeof address === 'object' && address !== null ? address.port : 0));
    });
  });
}

const AXE = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');

interface Finding {
  id: string;
  nodes: { target: string[]; failureSummary: string }[];
}

/** Checks that axe-core finds nothing. */
export async function judgeByAxe(page: Page, what: string): Promise<void> {
  if (!(await page.evaluate(() => 'axe' in window))) {
    await page.evaluate(AXE); // the page's content security policy permits no script tag
  }
  const found = await page.evaluate(async () => {
    const { axe } = window as unknown as { axe: { run(options: object): Promise<{ violations: Finding[] }> } };
    return (await axe.run({ resultTypes: ['violations'] })).violations;
  });
  expect(found.map((one) => `${what}: ${one.id} ${one.nodes.map((node) => `${node.target.join(' ')} ${node.failureSummary}`).join('; ')}`)).toEqual([]);
}

export function errorsOf(page: Page): string[] {
  return (page as Page & { errors: string[] }).errors;
}

export async function text(page: Page, id: string): Promise<string> {
  return (await page.getByTestId(id).innerText()).trim();
}

/** Opens a view by its tab, or by the list of views if the tabs do not fit. */
export async function openView(page: Page, id: string): Promise<void> {
  const [tab, more] = [page.getByTestId(`tab-${id}`), page.getByTestId('tab-more')];
  // The page layout may be changing.
  await until(async () => {
    if (!(await tab.isVisible()) && (await more.isVisible())) {
      await more.click({ timeout: 1000 }).catch(() => undefined);
    }
    return (await tab.isVisible()) && tab.click({ timeout: 1000 }).then(() => true, () => false);
  }, `the view ${id}`);
}

export async function untilText(page: Page, id: string, wanted: string | RegExp, ms = 10_000): Promise<void> {
  let last = '';
  try {
    await until(async () => {
      last = (await page.getByTestId(id).first().isVisible()) ? (await page.getByTestId(id).first().innerText()).trim() : '';
      return typeof wanted === 'string' ? last === wanted : wanted.test(last);
    }, '', ms);
  } catch {
    throw new Error(`${id} is '${last}', not ${String(wanted)}`);
  }
}

/** Leaves emergency stop, switches on and homes, with the buttons. */
export async function bringUp(page: Page): Promise<void> {
  await page.getByTestId('reset').click();
  await page.getByTestId('on').click();
  await untilText(page, 'state', 'On');
  await page.getByTestId('home-all').click();
  await untilText(page, 'homed-0', 'homed', 30_000);
  await untilText(page, 'homed-1', 'homed', 30_000);
  await untilText(page, 'homed-2', 'homed', 30_000);
  await untilText(page, 'run-state', 'Idle');
}

/** Saves a picture of the page and its text after a failed test, if MW_SCREEN_PICTURES names a folder. */
export async function showFailure(context: TestContext, page: Page): Promise<void> {
  const folder = process.env['MW_SCREEN_PICTURES'];
  if (context.task.result?.state === 'fail' && folder !== undefined) {
    await page.screenshot({ path: join(folder, `${context.task.name.replace(/\W+/g, '_')}.png`) });
  }
}
