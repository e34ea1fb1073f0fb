// SPDX-License-Identifier: GPL-2.0-or-later
import { t } from './i18n/index.svelte';

/** Permissions of a role as text. */
export function roleText(role: string): string {
  return role === 'configure' ? t('app.role_configure') : role === 'operate' ? t('app.role_operate') : t('app.role_view');
}
