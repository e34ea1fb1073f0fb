// SPDX-License-Identifier: GPL-2.0-or-later
// The available space: a workshop panel, a small panel, or a phone.

export type Room = 'wide' | 'medium' | 'narrow';

export const layout = $state<{ room: Room }>({ room: 'wide' });

const WIDE = '(min-width: 1100px) and (min-height: 620px)';
const NARROW = '(max-width: 640px)';

export function watchRoom(): void {
  const [wide, narrow] = [matchMedia(WIDE), matchMedia(NARROW)];
  const look = (): void => {
    layout.room = narrow.matches ? 'narrow' : wide.matches ? 'wide' : 'medium';
  };
  wide.addEventListener('change', look);
  narrow.addEventListener('change', look);
  look();
}
