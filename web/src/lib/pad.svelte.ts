// SPDX-License-Identifier: GPL-2.0-or-later
// The gamepad of this computer, polled while the jog view is shown.
import { jogger, whenJogsEnd } from './actions';
import { canJog } from './gates';
import { t } from './i18n/index.svelte';
import { jogSpeed, targetOfKey } from './jogging.svelte';
import { machine, tellLocally, view } from './machine.svelte';
import { PadJogger, sticksOf, type Pad } from './pad';

const LOOK_MS = 20;

export const gamepad = $state({ isThere: false, isOn: false });

function velocityOf(letter: string, share: number): number {
  return share * jogSpeed(targetOfKey(letter)?.isAngular ?? false, false);
}

const pads = new PadJogger({
  press(letter, share) {
    const target = targetOfKey(letter);
    if (target !== undefined) {
      void jogger.press({ isJoint: target.isJoint, index: target.index, velocity: velocityOf(letter, share), increment: null });
    }
  },
  change(letter, share) {
    const target = targetOfKey(letter);
    if (target !== undefined) {
      jogger.changeSpeed(target.isJoint, target.index, velocityOf(letter, share));
    }
  },
  release(letter) {
    const target = targetOfKey(letter);
    if (target !== undefined) {
      jogger.release(target.isJoint, target.index);
    } else {
      jogger.releaseAll(); // the target no longer exists, so all jogs end
    }
  },
  isOpen: () => canJog(view()) === null && document.hasFocus() && !document.hidden && document.querySelector('[role="dialog"]') === null,
  ended: (why) => tellLocally(t(why === 'lost' ? 'pad.lost' : 'pad.still')),
});

whenJogsEnd(() => pads.noteEnd());

/** Reads the pads while the view is shown. Returns the function that stops reading. */
export function watchPad(): () => void {
  const look = (): void => {
    const all = (navigator.getGamepads?.() ?? []) as readonly (Pad | null)[];
    gamepad.isThere = all.some((one) => one !== null && one.connected);
    if (gamepad.isOn) {
      pads.look(all, sticksOf(machine.facts?.kind ?? 'mill', machine.facts?.axes ?? ''), performance.now());
    }
  };
  const timer = setInterval(look, LOOK_MS);
  const drop = (): void => pads.drop();
  const gone = (): void => look();
  window.addEventListener('blur', drop);
  window.addEventListener('gamepaddisconnected', gone);
  return () => {
    clearInterval(timer);
    window.removeEventListener('blur', drop);
    window.removeEventListener('gamepaddisconnected', gone);
    pads.drop();
  };
}

export function switchPad(isOn: boolean): void {
  gamepad.isOn = isOn;
  if (!isOn) {
    pads.drop();
  }
}
