// SPDX-License-Identifier: GPL-2.0-or-later
// Tests the remaining time of a program, followed by its lines (J3).
import { expect, it } from 'vitest';
import { Follower, Times } from '../src/lib/path/times';

function made(moves: [number, number][]): Times {
  const times = new Times();
  moves.forEach(([line, seconds]) => times.add(line, seconds));
  return times;
}

it('sums over many moves', () => {
  const times = made(Array.from({ length: 5000 }, (_, i) => [i + 1, (i % 7) + 0.5]));
  const sum = (to: number): number => Array.from({ length: to }, (_, i) => (i % 7) + 0.5).reduce((a, b) => a + b, 0);
  expect(times.total).toBeCloseTo(sum(5000), 6);
  for (const move of [0, 1, 1023, 1024, 1025, 2048, 4999]) {
    expect(times.before(move)).toBeCloseTo(sum(move), 6);
  }
});

it('counts down within a move, and waits at its end', () => {
  const follower = new Follower(made([[1, 10], [2, 5]]));
  expect(follower.follow(0, 0)).toBe(15);
  expect(follower.follow(1, 0)).toBe(15);
  expect(follower.follow(1, 4)).toBe(11);
  expect(follower.follow(1, 60)).toBe(5); // slower than calculated: later moves remain
  expect(follower.follow(2, 1)).toBe(4);
});

it('goes forward in loops, and never back to a line that is done', () => {
  const loop: [number, number][] = Array.from({ length: 30 }, (_, i) => [3 + (i % 3), 1]);
  const follower = new Follower(made(loop));
  let left = Infinity;
  for (let i = 0; i < 30; ++i) {
    const now = follower.follow(3 + (i % 3), 1);
    expect(now).toBeCloseTo(29 - i, 6);
    expect(now).toBeLessThan(left);
    left = now;
  }
});

it('goes through the moves of one line by their time', () => {
  const follower = new Follower(made([[7, 1], [7, 1], [7, 1], [8, 2]]));
  follower.follow(7, 0);
  expect(follower.follow(7, 1.5)).toBeCloseTo(3.5, 6);
  expect(follower.follow(7, 1)).toBeCloseTo(2.5, 6);
  expect(follower.follow(7, 9)).toBeCloseTo(2, 6);
});

it('begins where a start at a line begins, and takes no line that there is not for another', () => {
  const follower = new Follower(made([[1, 10], [2, 10], [3, 10], [4, 10]]));
  expect(follower.follow(3, 0)).toBe(20);
  expect(follower.follow(99, 2)).toBe(18);
  expect(follower.follow(4, 0)).toBe(10);
});
