// SPDX-License-Identifier: GPL-2.0-or-later
// Exports of this folder.
export * from './dxf';
export * from './job';
export * from './registry';
export * from './store';
export * from './types';
export * from './validate';
