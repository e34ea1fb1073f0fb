// SPDX-License-Identifier: GPL-2.0-or-later
import './style.css';
import { mount } from 'svelte';
import App from './App.svelte';
import { endJogsWithAttention } from './lib/actions';
import { beginLogin } from './lib/login.svelte';
import { connect } from './lib/machine.svelte';

const target = document.getElementById('app');
if (target === null) {
  throw new Error('index.html has no element "app"');
}
mount(App, { target });
endJogsWithAttention(window);
void beginLogin().then(connect);
