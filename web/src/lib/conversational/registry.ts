// SPDX-License-Identifier: GPL-2.0-or-later
// All operations, in the order of the screen.
import { rectBoss, roundBoss } from './operations/boss';
import { contour } from './operations/contour';
import { engrave } from './operations/engrave';
import { face } from './operations/face';
import { bore, drill, tap } from './operations/holes';
import { chamfer, cornerRadius, groove, latheBore, latheFace, latheThread, partOff, turn } from './operations/lathe';
import { rectPocket } from './operations/rect_pocket';
import { roundPocket } from './operations/round_pocket';
import { slot } from './operations/slot';
import { threadMill } from './operations/thread_mill';
import type { Operation } from './types';

export const OPERATIONS: Operation[] = [face, rectPocket, roundPocket, slot, rectBoss, roundBoss, drill, tap, bore, threadMill, engrave, contour, turn, latheFace, latheBore, groove, partOff, latheThread, chamfer, cornerRadius];

export function operationOf(id: string): Operation | null {
  return OPERATIONS.find((one) => one.id === id) ?? null;
}
