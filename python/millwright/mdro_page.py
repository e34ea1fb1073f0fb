# SPDX-License-Identifier: GPL-2.0-or-later
"""The page of mdro. POINT_SIZE is the size of its text. Values older than a second are not shown."""

PAGE = '''<!doctype html>
<html lang="en"><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1"><title>mdro</title>
<style>
  body { font: POINT_SIZEpt system-ui, sans-serif; background: #16191d; color: #f2f4f6; margin: .5em; user-select: none }
  button { font: inherit; color: inherit; background: #323a44; border: 1px solid #7d8996; border-radius: .3em; padding: .35em .6em; min-width: 2.6em }
  button:focus-visible { outline: 3px solid #ffd24a } button[aria-pressed=true] { background: #0b6b3a } button:disabled { opacity: .4 }
  .axis { display: flex; gap: .4em; align-items: center; margin: .3em 0 } .axis.chosen output { outline: 3px solid #ffd24a }
  output { font: 1.6em ui-monospace, monospace; background: #05070a; color: #7dff9e; flex: 1; text-align: right; padding: .1em .4em; white-space: pre }
  .letter { font-size: 1.6em; width: 1.2em; text-align: center } .row { display: flex; gap: .4em; flex-wrap: wrap; margin: .6em 0 }
  #keys { display: grid; grid-template-columns: repeat(3, 1fr); gap: .3em; max-width: 14em } #said { color: #ffb3a8; min-height: 1.4em }
</style>
<main><div id="axes"></div><div class="row" id="systems" role="group" aria-label="coordinate system"></div>
<div class="row" role="group" aria-label="unit"><button data-unit="mm">mm</button><button data-unit="inch">inch</button></div>
<p id="said" role="alert"></p><div id="keys" role="group" aria-label="keypad"></div></main>
<script>
'use strict';
const $ = id => document.getElementById(id), made = (tag, set) => Object.assign(document.createElement(tag), set);
let shown = null, chosen = null, typed = '', heard = 0;
async function ask(request) {
  try {
    const given = await fetch(request ? 'do' : 'state', request ? {method: 'POST', body: JSON.stringify(request)} : {});
    const answer = await given.json();
    if (given.ok) { heard = Date.now(); show(answer); if (request) $('said').textContent = ''; } else $('said').textContent = answer.refused || 'refused';
  } catch { if (request) $('said').textContent = 'no connection: nothing was done'; }
}
function rows(state) {
  $('axes').replaceChildren(...state.axes.map((axis, n) => {
    const row = made('div', {className: 'axis'}), button = (text, label, what) => made('button', {textContent: text, ariaLabel: axis.letter + ' ' + label, onclick: what});
    row.append(made('span', {className: 'letter', textContent: axis.letter}), made('output', {ariaLabel: axis.letter}),
      button('0', 'to zero', () => ask({do: 'zero', axis: n})), button('\\u00bd', 'half', () => ask({do: 'half', axis: n})),
      button('Set', 'set a value', () => { chosen = chosen === n ? null : n; typed = ''; show(shown); }), button('Index', 'zero at the index', () => ask({do: 'index', axis: n})));
    return row;
  }));
  $('systems').replaceChildren(...state.systems.map(name => made('button', {textContent: name, onclick: () => ask({do: 'system', value: name})})));
}
function show(state) {
  if (!shown || shown.axes.length !== state.axes.length) rows(state);
  shown = state;
  const old = Date.now() - heard > 1000;
  state.axes.forEach((axis, n) => {
    const row = $('axes').children[n], digits = axis.rotary || state.mm ? 3 : 4;
    row.classList.toggle('chosen', chosen === n);
    row.children[1].textContent = chosen === n ? (typed || '_') : old || axis.value === null ? '-----' : axis.value.toFixed(digits);
    for (const k of [2, 3, 4]) row.children[k].disabled = state.system === state.systems[0];
    row.children[4].setAttribute('aria-pressed', chosen === n); row.children[5].setAttribute('aria-pressed', axis.index);
  });
  [...$('systems').children].forEach(one => one.setAttribute('aria-pressed', one.textContent === state.system));
  document.querySelectorAll('[data-unit]').forEach(one => one.setAttribute('aria-pressed', (one.dataset.unit === 'mm') === state.mm));
  $('keys').querySelectorAll('button').forEach(one => { one.disabled = chosen === null; });
  if (old) $('said').textContent = 'no connection to mdro: nothing is shown';
  else if ($('said').textContent.startsWith('no connection to')) $('said').textContent = '';
}
function key(name) {
  if (chosen === null) return;
  if (name === 'Enter') {
    const value = Number(typed), axis = chosen;
    if (!/[0-9]/.test(typed) || !Number.isFinite(value)) { $('said').textContent = typed + ' is no number'; return; }
    chosen = null; ask({do: 'set', axis, value});
  } else if (name === 'Esc') chosen = null;
  else if (name === '\\u232b') typed = typed.slice(0, -1);
  else if (name === '\\u00b1') typed = typed.startsWith('-') ? typed.slice(1) : '-' + typed;
  else if (typed.length < 14) typed += name;
  if (shown) show(shown);
}
$('keys').append(...['7', '8', '9', '4', '5', '6', '1', '2', '3', '0', '.', '\\u00b1', '\\u232b', 'Esc', 'Enter'].map(name => made('button', {textContent: name, onclick: () => key(name)})));
document.querySelectorAll('[data-unit]').forEach(one => { one.onclick = () => ask({do: 'units', value: one.dataset.unit}); });
addEventListener('keydown', event => {
  const name = {Escape: 'Esc', Backspace: '\\u232b', '-': '\\u00b1'}[event.key] || event.key;
  if (chosen !== null && /^([0-9.]|Esc|Enter|\\u232b|\\u00b1)$/.test(name)) { event.preventDefault(); key(name); }
});
setInterval(() => { ask(); if (shown) show(shown); }, 100);
</script></html>
'''
