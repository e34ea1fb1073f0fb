// SPDX-License-Identifier: GPL-2.0-or-later
// Total and remaining time of the open program, calculated by the planner for the current overrides.
import { machine } from './machine.svelte';
import { Ranges } from './path/shades';
import { Follower, Times, type TimeSum } from './path/times';
import type { TimesNews, TimesOrder } from './path/times_worker';
import { openName, program } from './program.svelte';

interface Progress {
  isReading: boolean;
  /** Null while it is not known. */
  sum: TimeSum | null;
  left_s: number | null;
  failed: string;
  /** Increases with each completed read. */
  reads: number;
}

export const progress = $state<Progress>({ isReading: false, sum: null, left_s: null, failed: '', reads: 0 });

/** Maximum speed of each move, along the points of the path. Changes with `progress.reads`. */
export const speeds = new Ranges();

/** Wait for an override that is being changed. */
const SETTLE_MS = 700;
let worker: Worker | null = null;
let order = 0;
let times = new Times();
let follower: Follower | null = null;
let point = 0;
let lastTime_s = 0;
let settling: ReturnType<typeof setTimeout> | undefined;

function hear(event: MessageEvent<TimesNews>): void {
  const news = event.data;
  if (news.number !== order) {
    return;
  }
  if ('failed' in news) {
    progress.isReading = false;
    progress.failed = news.failed;
  } else if ('sum' in news) {
    progress.sum = news.sum;
    progress.isReading = false;
    progress.reads += 1;
  } else {
    const { points, lines, seconds, velocities } = news.moves;
    for (let i = 0; i < lines.length; ++i) {
      speeds.add(point, velocities[i] ?? 0);
      point = (points[i] ?? 0) + 1;
      times.add(lines[i] ?? 0, seconds[i] ?? 0);
    }
  }
}

function forget(): void {
  order += 1;
  times = new Times();
  follower = null;
  speeds.clear();
  point = 0;
  Object.assign(progress, { sum: null, left_s: null, failed: '', isReading: false });
}

function read(file: string, feed: number, rapid: number, maxVelocity: number): void {
  worker ??= new Worker(new URL('./path/times_worker.ts', import.meta.url), { type: 'module' });
  worker.onmessage = hear;
  progress.isReading = true;
  const asked: TimesOrder = { number: order, file, feed, rapid, maxVelocity };
  worker.postMessage(asked);
}

/** Call it in an effect. Calculates the times of the open program, again when the overrides change. */
export function followTimes(): void {
  const name = machine.isConnected ? openName() : null;
  void program.reads;
  const { isPathUnderWay } = program;
  const overrides = machine.status?.overrides;
  const [feed, rapid] = [overrides?.feed_enabled === false ? 1 : (overrides?.feed ?? 1), overrides?.rapid ?? 1];
  const most = machine.status?.settings.max_velocity ?? 0;
  clearTimeout(settling);
  forget();
  if (name === null || feed <= 0 || rapid <= 0) {
    return;
  }
  progress.isReading = true;
  if (isPathUnderWay) {
    return; // the path is read first, because both need the processor
  }
  settling = setTimeout(() => read(name, feed, rapid, most), SETTLE_MS);
}

/** Call it with each status. */
export function followProgress(): void {
  const status = machine.status;
  const isRunning = status !== null && status.task.mode === 'AUTO' && status.task.interp_state !== 'IDLE';
  if (!isRunning || progress.sum === null) {
    follower = null;
    progress.left_s = null;
    return;
  }
  const now_s = status.time_ns * 1e-9;
  const isMoving = !status.task.is_paused && status.trajectory.current_velocity > 0;
  const isDwelling = status.task.waiting.what === 'DWELL' && !status.task.is_paused;
  if (follower === null) {
    follower = new Follower(times);
    lastTime_s = now_s;
  }
  const passed = isMoving || isDwelling ? Math.max(0, now_s - lastTime_s) : 0;
  lastTime_s = now_s;
  progress.left_s = follower.follow(status.task.motion_line, passed);
}
