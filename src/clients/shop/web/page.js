// SPDX-License-Identifier: GPL-2.0-or-later
// The page of a shop, which requests the machines periodically.
'use strict';
const PERIOD_MS = 2000, DAYS = 7;
const part = (id) => document.getElementById(id);
const percent = (value) => (value ?? null) === null ? '–' : `${Math.round(100 * value)} %`;
const time = (text) => text === null ? '–' : new Date(text).toLocaleString();
const file = (path) => path ? path.split('/').pop() : '–';
function duration(s) {
  if (s === null) return '–';
  const whole = Math.max(0, Math.round(s));
  const two = (number) => String(number).padStart(2, '0');
  return `${Math.floor(whole / 3600)}:${two(Math.floor(whole / 60) % 60)}:${two(whole % 60)}`;
}
// Texts of machines are never interpreted as HTML.
function row(cells, numbers = []) {
  const line = document.createElement('tr');
  cells.forEach((cell, i) => {
    const field = line.insertCell();
    field.append(cell ?? '–');
    if (numbers.includes(i)) field.className = 'number';
  });
  return line;
}
function stateOf(machine) {
  const field = document.createElement('span');
  const name = !machine.alive ? 'No contact' : machine.state === 'ON' ? machine.execution : machine.state;
  field.className = `state ${machine.alarms && machine.alive ? 'alarm' : machine.alive ? machine.execution : ''}`;
  field.textContent = name ?? '–';
  return field;
}
function machineRow(machine, sums, now) {
  const isRunning = machine.alive && sums.ends && !['READY', 'STOPPED'].includes(machine.execution);
  const left = isRunning ? duration((new Date(sums.ends) - new Date(now)) / 1000) : '–';
  const choose = document.createElement('button');
  choose.textContent = `${machine.group}/${machine.node}/${machine.device}`;
  choose.onclick = () => showHistory(machine);
  const line = row([choose, stateOf(machine), file(machine.program), machine.line, left, machine.alarms ?? '',
    percent(sums.availability), percent(sums.performance), percent(sums.quality), percent(sums.oee), sums.parts],
  [3, 4, 6, 7, 8, 9, 10]);
  line.classList.toggle('away', !machine.alive);
  line.cells[5].className = 'alarms';
  return line;
}
async function get(path) {
  const answer = await fetch(path, { cache: 'no-store' });
  if (!answer.ok) throw new Error(await answer.text());
  return answer.json();
}
async function showHistory(machine) {
  part('chosen').textContent = `${machine.group}/${machine.node}/${machine.device}, ${DAYS} days`;
  try {
    const history = await get(`machines/history?machine=${machine.id}&days=${DAYS}`);
    part('jobs').replaceChildren(...history.jobs.map((job) => row([file(job.program), time(job.begins), job.result === 'RUNNING' ? '–' : time(job.ends), duration(job.active_s), job.result], [3])));
    part('alarms').replaceChildren(...history.alarms.map((alarm) => row([time(alarm.at), alarm.source, alarm.message])));
    part('shifts').replaceChildren(...history.shifts.map((shift) => row([shift.name, time(shift.begins), percent(shift.availability),
      percent(shift.performance), percent(shift.quality), percent(shift.oee), shift.parts], [2, 3, 4, 5, 6])));
    part('history').hidden = false;
  } catch (error) {
    part('problem').textContent = error.message;
  }
}
async function refresh() {
  try {
    const shop = await get('machines');
    const sums = await get('machines/sums');
    part('machines').replaceChildren(...shop.machines.map((machine) => machineRow(machine, sums.machines[machine.id] ?? {}, shop.at)));
    part('shift').textContent = sums.shift ? `– shift ${sums.shift}` : '';
    part('problem').textContent = '';
  } catch (error) {
    part('problem').textContent = `No new values: ${error.message}`;
  }
  setTimeout(refresh, PERIOD_MS);
}
refresh();
