// SPDX-License-Identifier: GPL-2.0-or-later
import '../style.css';
import { mount } from 'svelte';
import First from './First.svelte';

const target = document.getElementById('app');
if (target === null) {
  throw new Error('the page has no element "app"');
}
mount(First, { target });
