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
async function result(answer) {
  if (answer.status === 403) part('login').hidden = false;
  if (!answer.ok) throw new Error(await answer.text());
  return answer.json();
}
const get = async (path) => result(await fetch(path, { cache: 'no-store' }));
const post = async (path, body) => result(await fetch(path, { method: 'POST', body: JSON.stringify(body) }));
// A file in another encoding is not changed silently.
async function textOf(file) {
  try {
    return { name: file.name, text: new TextDecoder('utf-8', { fatal: true, ignoreBOM: true }).decode(await file.arrayBuffer()) };
  } catch {
    throw new Error(`${file.name} is not text in UTF-8.`);
  }
}
// A request that is repeated after a lost answer has the same number, so it has no effect.
let request = null;
async function offerProgram(event) {
  event.preventDefault();
  try {
    request ??= crypto.randomUUID();
    const files = await Promise.all([...part('program').files, ...part('subroutines').files].map(textOf));
    const machines = [...part('targets').selectedOptions].map((option) => Number(option.value));
    await post('offers', { request, machines, files, from: part('person').value, note: part('note').value, parts: Number(part('parts').value) });
    localStorage.setItem('person', part('person').value);
    request = null;
    part('offered').textContent = `${files[0].name} is offered.`;
    await showOffers();
  } catch (error) {
    part('offered').textContent = error.message;
  }
}
async function withdraw(offer) {
  try {
    await post('offers/withdraw', { id: offer.id, by: part('person').value || offer.sender });
    await showOffers();
  } catch (error) {
    part('offered').textContent = error.message;
  }
}
function stateOfOffer(offer) {
  const isEnded = offer.ended !== null;
  const isAsked = offer.withdrawn !== null && !isEnded;
  const state = isAsked ? 'withdrawn, not yet confirmed by the machine' : offer.state;
  const at = isAsked ? offer.withdrawn : offer.ended ?? offer.received ?? offer.sent;
  const by = offer.state === 'withdrawn' || isAsked ? offer.withdrawn_by : offer.ended_by;
  return `${state}, ${time(at)}${by ? `, ${by}` : ''}${offer.reason ? `: ${offer.reason}` : ''}`;
}
function offerRow(offer) {
  const button = document.createElement('button');
  button.textContent = 'Withdraw';
  button.onclick = () => withdraw(offer);
  const isOpen = offer.ended === null && offer.withdrawn === null;
  const size = `${(offer.bytes / 1000).toFixed(1)} kB`;
  return row([time(offer.sent), offer.machine, offer.name, offer.parts || '–', size, offer.note, offer.sender, stateOfOffer(offer), isOpen ? button : ''], [3, 4]);
}
async function showOffers() {
  part('offers').replaceChildren(...(await get('offers')).offers.map(offerRow));
}
function copyRow(copy) {
  const link = document.createElement('a');
  link.href = `copies/${copy.id}`;
  link.download = copy.name;
  link.textContent = copy.name;
  return row([time(copy.at), copy.machine, link, `${(copy.bytes / 1000).toFixed(1)} kB`, copy.sha256.slice(0, 12)], [3]);
}
async function showCopies() {
  part('copies').replaceChildren(...(await get('copies')).copies.map(copyRow));
}
function showTargets(machines) {
  const names = machines.map((machine) => `${machine.id} ${machine.group}/${machine.node}/${machine.device}`);
  if (part('targets').dataset.names === names.join()) return;
  part('targets').dataset.names = names.join();
  part('targets').replaceChildren(...machines.map((machine, i) => new Option(names[i].slice(names[i].indexOf(' ') + 1), machine.id)));
}
async function signIn(event) {
  event.preventDefault();
  const answer = await fetch('api/login', { method: 'POST', body: JSON.stringify({ token: part('token').value }) });
  part('login').hidden = answer.ok;
  part('problem').textContent = answer.ok ? '' : 'Access denied.';
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
    showTargets(shop.machines);
    await showOffers();
    await showCopies();
    part('shift').textContent = sums.shift ? `– shift ${sums.shift}` : '';
    part('problem').textContent = '';
  } catch (error) {
    part('problem').textContent = `No new values: ${error.message}`;
  }
  setTimeout(refresh, PERIOD_MS);
}
part('person').value = localStorage.getItem('person') ?? '';
part('offer').onsubmit = offerProgram;
part('offer').oninput = () => (request = null);
part('login').onsubmit = signIn;
refresh();
