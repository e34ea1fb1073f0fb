// SPDX-License-Identifier: GPL-2.0-or-later
// Operations of a lathe. X is a diameter. The theoretical tip of a turning tool (orientation 2, for a boring
// bar 3) follows the path.
import { count, choice, diameterOf, field, lengthFault, margin, nice, position, size, speedField, toolFields, within } from '../fields';
import { num, word, type Context, type Faults, type Field, type Limit, type Operation, type Values } from '../types';
import type { Writer } from '../writer';

const isSurface = (values: Values): boolean => word(values, 'speed_mode') === 'surface';
const revsOf = (values: Values): number => num(values, isSurface(values) ? 'limit_speed' : 'speed');

/** The feed at the maximum speed must not exceed that of the machine. */
function revLimits(values: Values, context: Context): Limit[] {
  const most = nice(context.unit, 5, 0.2);
  const limits: Limit[] = [{ low: 0, isOpen: true, key: 'fault.above_zero' }, { low: nice(context.unit, 0.001, 0.0001), key: 'fault.at_least', values: { low: nice(context.unit, 0.001, 0.0001) } }, { high: most, key: 'fault.at_most', values: { high: most } }];
  return context.maxFeed === null ? limits : [...limits, { high: context.maxFeed / revsOf(values), key: 'fault.rev_feed', values: { high: context.maxFeed } }];
}
function feedField(mm = 0.15, inch = 0.006): Field {
  return field('feed_rev', 'rev', (_, context) => nice(context.unit, mm, inch), revLimits, { reason: 'why.feed_rev' });
}
const toolNumber = (): Field[] => toolFields().filter((one) => one.id === 'tool');
const coolant = (): Field[] => toolFields().filter((one) => one.id === 'coolant');

function spindleFields(): Field[] {
  return [
    choice('speed_mode', ['rev', 'surface'], 'rev', { reason: 'why.speed_mode' }),
    { ...speedField('speed', 800), isShown: (values) => !isSurface(values) },
    field('surface', 'surface', (_, context) => nice(context.unit, 120, 400), () => within(0.1, 5000), { isShown: isSurface }),
    { ...speedField('limit_speed', 2000), isShown: isSurface, reason: 'why.limit_speed' },
  ];
}
function noseFields(): Field[] {
  const nose = margin('nose', (values, context) => (diameterOf(values, context) ?? nice(context.unit, 0.8, 0.03)) / 2, { reason: 'why.nose', limits: (_, context) => within(0, nice(context.unit, 10, 0.4)) });
  return [...toolNumber(), nose, ...spindleFields(), feedField(), ...coolant()];
}
function widthFields(): Field[] {
  return [...toolNumber(), size('tool_width', 3, 0.125), choice('tool_edge', ['left', 'right'], 'left', { reason: 'why.tool_edge' }), ...spindleFields(), feedField(0.05, 0.002), ...coolant()];
}
function stockDiameter(): Field {
  return size('stock_diameter', 40, 1.5, { limits: (values, context) => [{ high: context.safeX - 2 * num(values, 'clearance'), key: 'fault.stock_safe', values: { high: context.safeX - 2 * num(values, 'clearance') } }] });
}
function zStart(preset: (context: Context) => number = () => 0): Field {
  return position('z_start', (_, context) => preset(context), { reason: 'why.z_start', limits: (values, context) => [{ high: context.safe - num(values, 'clearance'), key: 'fault.z_safe', values: { safe: context.safe } }] });
}
const zEnd = (mm: number, inch: number): Field => position('z_end', (_, context) => nice(context.unit, mm, inch), { limits: (values) => [{ high: num(values, 'z_start'), isOpen: true, key: 'fault.z_order', values: { high: num(values, 'z_start') } }] });
const gap = (): Field => size('clearance', 2, 0.1, { reason: 'why.gap', limits: (_, context) => within(0, nice(context.unit, 50, 2)) });
const cutField = (most: (values: Values) => number): Field =>
  size('cut', (values, context) => Math.min(nice(context.unit, 1, 0.04), most(values)) || nice(context.unit, 1, 0.04), 0.04, { reason: 'why.cut', limits: (values) => [{ high: most(values), key: 'fault.cut_all', values: { high: most(values) } }, { low: most(values) / 1000, key: 'fault.too_many_steps' }] });
const finish = (most: (values: Values) => number): Field => margin('allowance', (values, context) => Math.min(nice(context.unit, 0.2, 0.01), most(values) / 2) || 0, { reason: 'why.turn_allowance', limits: (values) => [{ high: most(values), isOpen: true, key: 'fault.less_than', values: { high: most(values) } }, { high: num(values, 'cut'), key: 'fault.allowance_cut', values: { high: num(values, 'cut') } }] });

/** Equal cuts of at most `cut` from 0 to `total`. */
function cutsOf(total: number, cut: number): number[] {
  const n = Math.max(1, Math.ceil(total / cut - 1e-9));
  return Array.from({ length: n }, (_, i) => (total * (i + 1)) / n);
}

const turnDepth = (values: Values): number => (num(values, 'stock_diameter') - num(values, 'part_diameter')) / 2;

export const turn: Operation = {
  id: 'turn',
  machine: 'lathe',
  fields: [gap(), stockDiameter(), size('part_diameter', 30, 1.25, { limits: (values) => [{ high: num(values, 'stock_diameter'), isOpen: true, key: 'fault.part_stock', values: { high: num(values, 'stock_diameter') } }] }), zStart(), zEnd(-30, -1.25), ...noseFields(), cutField(turnDepth), finish(turnDepth)],
  check: depthLeft,
  write: (writer, values) => lengthways(writer, values, { from: num(values, 'stock_diameter'), to: num(values, 'part_diameter'), sign: 1 }),
};

const boreDepth = (values: Values): number => (num(values, 'bore_diameter') - num(values, 'hole_diameter')) / 2;

export const latheBore: Operation = {
  id: 'lathe_bore',
  machine: 'lathe',
  fields: [
    gap(),
    size('hole_diameter', 16, 0.625, { reason: 'why.hole', limits: (values) => [{ low: 2 * num(values, 'clearance'), isOpen: true, key: 'fault.hole_gap', values: { low: 2 * num(values, 'clearance') } }] }),
    size('bore_diameter', 24, 1, { limits: (values, context) => [{ low: num(values, 'hole_diameter'), isOpen: true, key: 'fault.bore_hole', values: { low: num(values, 'hole_diameter') } }, { high: context.safeX, key: 'fault.stock_safe', values: { high: context.safeX } }] }),
    zStart(),
    zEnd(-20, -0.75),
    ...noseFields(),
    cutField(boreDepth),
    finish(boreDepth),
  ],
  check: depthLeft,
  write: (writer, values) => lengthways(writer, values, { from: num(values, 'hole_diameter'), to: num(values, 'bore_diameter'), sign: -1 }),
};

function depthLeft(values: Values): Faults {
  return num(values, 'z_start') - num(values, 'z_end') <= num(values, 'allowance') + num(values, 'nose') ? { z_end: { key: 'fault.z_short' } } : {};
}

/**
 * Cuts along Z from the diameter `from` to `to`, then once along the finished wall and its shoulder. `sign`:
 * the side without material.
 */
function lengthways(writer: Writer, values: Values, { from, to, sign }: { from: number; to: number; sign: 1 | -1 }): void {
  const [feed, start, end, allowance] = [num(values, 'feed_rev'), num(values, 'z_start'), num(values, 'z_end'), num(values, 'allowance')];
  const clear = num(values, 'clearance');
  const front = start + clear;
  const away = from + 2 * sign * clear;
  // A tool that is retracted at an angle leaves no mark, and remains outside the material.
  const lift = Math.min(clear, (start - end) / 2) / 4;
  writer.rapid({ z: front });
  writer.rapid({ x: away });
  for (const depth of cutsOf(Math.abs(to - from) / 2 - allowance, num(values, 'cut'))) {
    const x = from - sign * 2 * depth;
    writer.rapid({ x });
    writer.feed({ z: end + allowance }, feed);
    writer.feed({ x: x + 2 * sign * lift, z: end + allowance + lift }, feed);
    writer.rapid({ z: front });
  }
  writer.comment('Finishing cut');
  writer.rapid({ x: to });
  writer.feed({ z: end }, feed);
  writer.feed({ x: away }, feed);
  writer.rapid({ z: front });
}

const faceDepth = (values: Values): number => num(values, 'z_start') - num(values, 'z_end');

export const latheFace: Operation = {
  id: 'lathe_face',
  machine: 'lathe',
  fields: [
    gap(),
    stockDiameter(),
    margin('end_diameter', 0, { reason: 'why.end_diameter', limits: (values) => [{ high: num(values, 'stock_diameter'), isOpen: true, key: 'fault.part_stock', values: { high: num(values, 'stock_diameter') } }] }),
    zStart((context) => nice(context.unit, 1, 0.04)),
    zEnd(0, 0),
    ...noseFields(),
    cutField(faceDepth),
    finish(faceDepth),
  ],
  write(writer, values) {
    const [feed, clear] = [num(values, 'feed_rev'), num(values, 'clearance')];
    const out = num(values, 'stock_diameter') + 2 * clear;
    // Without a shoulder the tool moves past the centre by the nose radius.
    const end = num(values, 'end_diameter') > 0 ? num(values, 'end_diameter') : -2 * num(values, 'nose');
    const allowance = num(values, 'allowance');
    const depths = cutsOf(faceDepth(values) - allowance, num(values, 'cut'));
    writer.rapid({ z: num(values, 'z_start') + clear });
    writer.rapid({ x: out });
    for (const depth of allowance > 0 ? [...depths, faceDepth(values)] : depths) {
      const z = num(values, 'z_start') - depth;
      writer.rapid({ z });
      writer.feed({ x: end }, feed);
      writer.feed({ z: z + clear }, feed);
      writer.rapid({ x: out });
    }
    writer.rapid({ z: num(values, 'z_start') + clear });
  },
};

/** Z of the reference edge of a tool whose left edge is at `left`. */
const edgeZ = (values: Values, left: number): number => (word(values, 'tool_edge') === 'left' ? left : left + num(values, 'tool_width'));

/** Moves into the material in pecks, each with a short retract that breaks the chip. */
function peckIn(writer: Writer, values: Values, from: number, to: number): void {
  const feed = num(values, 'feed_rev');
  const back = Math.min(num(values, 'peck'), num(values, 'clearance')) / 2;
  for (const depth of cutsOf((from - to) / 2, num(values, 'peck'))) {
    const x = from - 2 * depth;
    writer.feed({ x }, feed);
    if (x > to + 1e-6) {
      writer.feed({ x: x + 2 * back }, feed);
    }
  }
}
const peckField = (most: (values: Values) => number): Field => size('peck', (values, context) => Math.min(nice(context.unit, 2, 0.08), most(values)) || nice(context.unit, 2, 0.08), 0.08, { reason: 'why.peck_turn', limits: (values) => [{ high: most(values), key: 'fault.cut_all', values: { high: most(values) } }, { low: most(values) / 1000, key: 'fault.too_many_steps' }] });

const grooveDepth = (values: Values): number => (num(values, 'stock_diameter') - num(values, 'groove_diameter')) / 2;

export const groove: Operation = {
  id: 'groove',
  machine: 'lathe',
  fields: [
    gap(),
    stockDiameter(),
    size('groove_diameter', 30, 1.25, { limits: (values) => [{ high: num(values, 'stock_diameter'), isOpen: true, key: 'fault.part_stock', values: { high: num(values, 'stock_diameter') } }] }),
    position('z_edge', (_, context) => nice(context.unit, -10, -0.4), { reason: 'why.groove_z', limits: (_, context) => [{ high: context.safe, isOpen: true, key: 'fault.z_safe', values: { safe: context.safe } }] }),
    size('groove_width', 5, 0.2, { limits: (values) => [{ low: num(values, 'tool_width'), key: 'fault.tool_wide_groove', values: { low: num(values, 'tool_width') } }] }),
    peckField(grooveDepth),
    ...widthFields(),
  ],
  check: (values) => lengthFault(((num(values, 'groove_width') / num(values, 'tool_width')) * 8 * grooveDepth(values)) / num(values, 'peck'), 'peck'),
  write(writer, values) {
    const out = num(values, 'stock_diameter') + 2 * num(values, 'clearance');
    const right = num(values, 'z_edge') - num(values, 'tool_width');
    const extra = num(values, 'groove_width') - num(values, 'tool_width');
    const steps = Math.ceil(extra / (0.75 * num(values, 'tool_width')) - 1e-9);
    for (let i = 0; i <= steps; i += 1) {
      writer.rapid({ z: edgeZ(values, right - (steps === 0 ? 0 : (extra * i) / steps)) });
      writer.rapid({ x: out });
      peckIn(writer, values, out, num(values, 'groove_diameter'));
      writer.feed({ x: out }, num(values, 'feed_rev'));
    }
  },
};

const partDepth = (values: Values): number => (num(values, 'stock_diameter') - num(values, 'end_diameter')) / 2;

export const partOff: Operation = {
  id: 'part_off',
  machine: 'lathe',
  fields: [
    gap(),
    stockDiameter(),
    margin('end_diameter', 0, { reason: 'why.part_end', limits: (values) => [{ high: num(values, 'stock_diameter'), isOpen: true, key: 'fault.part_stock', values: { high: num(values, 'stock_diameter') } }] }),
    position('z_edge', (_, context) => nice(context.unit, -40, -1.5), { reason: 'why.part_z', limits: (_, context) => [{ high: context.safe, isOpen: true, key: 'fault.z_safe', values: { safe: context.safe } }] }),
    peckField(partDepth),
    ...widthFields(),
  ],
  write(writer, values) {
    const out = num(values, 'stock_diameter') + 2 * num(values, 'clearance');
    writer.rapid({ z: edgeZ(values, num(values, 'z_edge') - num(values, 'tool_width')) });
    writer.rapid({ x: out });
    peckIn(writer, values, out, num(values, 'end_diameter'));
    writer.feed({ x: out }, num(values, 'feed_rev'));
  },
};

const threadHeight = (values: Values): number => (num(values, 'major') - num(values, 'minor')) / 2;

export const latheThread: Operation = {
  id: 'lathe_thread',
  machine: 'lathe',
  fields: [
    choice('thread_side', ['external', 'internal'], 'external'),
    gap(),
    size('major', 20, 0.75, { limits: (values, context) => [{ high: context.safeX - 2 * num(values, 'clearance'), key: 'fault.stock_safe', values: { high: context.safeX - 2 * num(values, 'clearance') } }] }),
    size('pitch', 1.5, 0.0625, {
      limits: (values, context) => [{ high: num(values, 'major') / 2, key: 'fault.pitch_major', values: { high: num(values, 'major') / 2 } }, ...(context.maxFeed === null ? [] : [{ high: context.maxFeed / num(values, 'speed'), key: 'fault.pitch_feed' as const, values: { feed: num(values, 'pitch') * num(values, 'speed'), high: context.maxFeed } }])],
    }),
    size('minor', (values) => num(values, 'major') - 2 * num(values, 'pitch') * (word(values, 'thread_side') === 'internal' ? 0.5413 : 0.6134), 0.7, {
      reason: 'why.minor',
      limits: (values) => [
        { high: num(values, 'major'), isOpen: true, key: 'fault.minor_major', values: { high: num(values, 'major') } },
        { low: num(values, 'major') - 2.2 * num(values, 'pitch'), key: 'fault.minor_pitch', values: { low: num(values, 'major') - 2.2 * num(values, 'pitch') } },
      ],
    }),
    zStart(),
    zEnd(-20, -0.75),
    size('lead_in', (values) => 3 * num(values, 'pitch'), 0.2, { reason: 'why.lead_in', limits: (values, context) => [{ low: num(values, 'pitch'), key: 'fault.thread_depth', values: { low: num(values, 'pitch') } }, { high: context.safe - num(values, 'z_start'), key: 'fault.z_safe', values: { safe: context.safe } }] }),
    ...toolNumber(),
    speedField('speed', 400),
    ...coolant(),
    size('first_cut', (values) => threadHeight(values) / 4, 0.01, { reason: 'why.first_cut', limits: (values) => [{ high: threadHeight(values), key: 'fault.cut_all', values: { high: threadHeight(values) } }, { low: threadHeight(values) / 20, key: 'fault.at_least', values: { low: threadHeight(values) / 20 } }] }),
    count('springs', 1, 0, 10, { reason: 'why.springs' }),
  ],
  check: (values): Faults => (word(values, 'thread_side') === 'internal' && num(values, 'minor') <= 2 * num(values, 'clearance') ? { minor: { key: 'fault.hole_gap', values: { low: 2 * num(values, 'clearance') } } } : {}),
  write(writer, values) {
    const isOut = word(values, 'thread_side') === 'external';
    const clear = num(values, 'clearance');
    const drive = isOut ? num(values, 'major') / 2 + clear : num(values, 'minor') / 2 - clear;
    writer.rapid({ z: num(values, 'z_start') + num(values, 'lead_in') });
    writer.line('G8');
    writer.line(`G0 X${writer.number(drive)}`);
    writer.line(`G76 P${writer.number(num(values, 'pitch'))} Z${writer.number(num(values, 'z_end'))} I${writer.number(isOut ? -clear : clear)} J${writer.number(num(values, 'first_cut'))} K${writer.number(threadHeight(values))} R2 Q29.5 H${num(values, 'springs')} L0`);
    writer.line('G7');
    writer.forget();
    // G76 ends at the end of the thread, so the tool first leaves the bore.
    writer.rapid({ z: num(values, 'z_start') + num(values, 'lead_in') });
  },
};

const cornerFields = (id: string): Field[] => [
  gap(),
  size('part_diameter', 30, 1.25, { limits: (values, context) => [{ high: context.safeX - 2 * num(values, 'clearance'), key: 'fault.stock_safe', values: { high: context.safeX - 2 * num(values, 'clearance') } }] }),
  zStart(),
  size(id, 2, 0.08, { limits: (values) => [{ high: num(values, 'part_diameter') / 2 - num(values, 'nose') - num(values, 'clearance'), key: 'fault.corner_part', values: { high: num(values, 'part_diameter') / 2 - num(values, 'nose') - num(values, 'clearance') } }] }),
  ...noseFields(),
  cutField((values) => num(values, id)),
];

export const chamfer: Operation = {
  id: 'chamfer',
  machine: 'lathe',
  fields: cornerFields('chamfer'),
  write(writer, values) {
    const [edge, z, clear, feed] = [num(values, 'part_diameter'), num(values, 'z_start'), num(values, 'clearance'), num(values, 'feed_rev')];
    // Material that the nose radius leaves beside a 45 degree line through the tip.
    const total = num(values, 'chamfer') + (2 - Math.SQRT2) * num(values, 'nose');
    for (const c of cutsOf(total, num(values, 'cut'))) {
      writer.rapid({ z: z + clear });
      writer.rapid({ x: edge - 2 * (c + clear) });
      writer.feed({ x: edge + 2 * clear, z: z - c - clear }, feed);
    }
    writer.rapid({ z: z + clear });
  },
};

export const cornerRadius: Operation = {
  id: 'radius',
  machine: 'lathe',
  fields: cornerFields('radius'),
  write(writer, values) {
    const [edge, z, clear, feed] = [num(values, 'part_diameter'), num(values, 'z_start'), num(values, 'clearance'), num(values, 'feed_rev')];
    const total = num(values, 'radius') + num(values, 'nose');
    for (const r of cutsOf(total, num(values, 'cut'))) {
      writer.rapid({ z: z + clear });
      writer.rapid({ x: edge - 2 * r });
      writer.feed({ z }, feed);
      writer.arcByRadius({ x: edge, z: z - r }, r, false, feed);
      writer.feed({ x: edge + 2 * clear }, feed);
    }
    writer.rapid({ z: z + clear });
  },
};
