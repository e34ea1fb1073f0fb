# SPDX-License-Identifier: GPL-2.0-or-later
"""Random forms. `good` forms must be accepted, unless a contour has no space for the tool. In `planted` forms one value is
impossible and must be rejected at its field. `wild` forms have values of any size; any accepted program must be safe."""
import math
import random

import dxf_cases

KINDS = ['face', 'rect_pocket', 'round_pocket', 'slot', 'rect_boss', 'round_boss', 'drill', 'tap', 'bore', 'thread_mill', 'engrave', 'contour']
SYSTEMS = ['G54', 'G55', 'G56', 'G57', 'G58', 'G59', 'G59.1', 'G59.2', 'G59.3']
LETTERS = 'ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789.,:;-+=/()[]!?"\'%#&*_<>@° äöüÄÖÜßñÑáéíóúÁÉÍÓÚ¿¡Øø±×µ€'


class Maker:
    def __init__(self, seed):
        self.random = random.Random(seed)
        r = self.random
        self.unit = r.choice(['mm', 'mm', 'inch'])
        self.scale = 1.0 if self.unit == 'mm' else 1 / 25.4
        self.seed = seed

    def length(self, low, high, digits=3):
        return round(self.random.uniform(low, high) * self.scale, digits if self.unit == 'mm' else digits + 1)

    def pick(self, *options):
        return self.random.choice(options)

    def common(self, diameter, depth):
        r = self.random
        top = self.pick(0.0, 0.0, self.length(-20, 10))
        return {
            'tool': r.randint(1, 40), 'diameter': diameter, 'speed': float(r.randint(200, 12000)), 'feed': self.length(50, 1500, 0), 'coolant': self.pick('flood', 'mist', 'off'), 'top': top, 'depth': depth,
            'clearance': self.length(0.5, 5),
        }

    def milling(self, v):
        r, d = self.random, v['diameter']
        v['feed_z'] = self.length(20, 300, 0)
        v['step_down'] = round(min(v['depth'], v['depth'] / r.choice([1, 1.3, 2, 2.7, 3.4])), 4)
        v['step_over'] = round(d * r.uniform(0.15, 0.69), 4)
        v['allowance'] = self.pick(0.0, round(d * r.uniform(0.005, 0.2), 4))
        v['direction'] = self.pick('climb', 'climb', 'conventional')

    def entry(self, v):
        v['entry'] = self.pick('ramp', 'ramp', 'ramp', 'plunge')
        v['ramp_angle'] = round(self.random.uniform(1.5, 20), 2)

    def tool(self):
        return self.length(1, 20)

    def place(self, v):
        v['x'], v['y'] = self.pick(0.0, self.length(-100, 100)), self.pick(0.0, self.length(-100, 100))

    def values(self, kind):
        return getattr(self, kind)()

    def face(self):
        d = self.length(4, 60)
        v = self.common(d, self.length(0.2, 4))
        self.milling(v)
        del v['allowance'], v['direction']
        self.place(v)
        v |= {'origin': self.pick('corner', 'centre'), 'length': self.length(5, 200), 'width': self.length(5, 150), 'face_direction': self.pick('climb', 'both'), 'floor_allowance': self.pick(0.0, round(min(v['depth'] * 0.2, v['step_down']), 4))}
        v['step_over'] = round(d * self.random.uniform(0.2, 0.89), 4)
        return v

    def pocket(self):
        d = self.tool()
        v = self.common(d, self.length(0.5, 12))
        self.milling(v)
        self.entry(v)
        self.place(v)
        # Exactly as wide as the tool, or wide enough for a helix.
        v['_wide'] = round((d + 2 * v['allowance']) * self.pick(1.25, 1.6, 2.5, 4, 7) + 0.25 * d, 4)
        return v

    def rect_pocket(self):
        v = self.pocket()
        wide = v.pop('_wide')
        sides = [wide, round(wide * self.random.uniform(1, 4), 4)]
        self.random.shuffle(sides)
        v |= {'origin': self.pick('centre', 'corner'), 'length': sides[0], 'width': sides[1], 'angle': self.pick(0.0, round(self.random.uniform(-180, 180), 2))}
        v['corner_radius'] = self.pick(math.ceil(v['diameter'] / 2 * 1e4) / 1e4, round(self.random.uniform(v['diameter'] / 2 + 1e-4, min(sides) / 2 - 1e-4), 4), math.floor(min(sides) / 2 * 1e4) / 1e4)
        return v

    def round_pocket(self):
        v = self.pocket()
        v['pocket_diameter'] = v.pop('_wide')
        return v

    def slot(self):
        v = self.pocket()
        wide = v.pop('_wide')
        length, turn = self.random.uniform(1.3, 8) * v['diameter'], self.random.uniform(0, 2 * math.pi)
        v['x_end'], v['y_end'] = round(v['x'] + length * math.cos(turn), 4), round(v['y'] + length * math.sin(turn), 4)
        if self.random.random() < 0.4:
            wide, v['allowance'] = v['diameter'], 0.0
        v['slot_width'] = wide
        return v

    def boss(self, v):
        self.milling(v)
        self.place(v)

    def rect_boss(self):
        v = self.common(self.tool(), self.length(0.5, 12))
        self.boss(v)
        v['length'], v['width'] = self.length(2, 80), self.length(2, 80)
        v['corner_radius'] = self.pick(0.0, math.floor(self.random.uniform(0, min(v['length'], v['width']) / 2) * 1e4) / 1e4)
        v['stock_length'] = round(v['length'] + self.length(0.5, 60), 4)
        v['stock_width'] = round(v['width'] + self.pick(0.0, self.length(0.5, 60)), 4)
        return v

    def round_boss(self):
        v = self.common(self.tool(), self.length(0.5, 12))
        self.boss(v)
        v['boss_diameter'] = self.length(2, 80)
        v['stock_length'], v['stock_width'] = round(v['boss_diameter'] + self.pick(0.0, self.length(0, 60)), 4), round(v['boss_diameter'] + self.length(0, 60), 4)
        return v

    def pattern(self, v):
        r, d = self.random, v['diameter']
        self.place(v)
        far = lambda: round(d * r.uniform(1.05, 4), 4)
        v |= {'pattern': self.pick('circle', 'line', 'grid', 'list'), 'holes': r.randint(1, 12), 'start_angle': round(r.uniform(-180, 180), 3), 'spacing': far(), 'columns': r.randint(1, 5), 'rows': r.randint(1, 4), 'spacing_x': far(), 'spacing_y': far(),
              'angle': round(r.uniform(-180, 180), 2)}
        v['circle_diameter'] = round(max(1.05 * d / math.sin(math.pi / v['holes']) if v['holes'] > 1 else d, d) * r.uniform(1, 2) + d * 0.01, 4)
        cells = r.sample([(i, k) for i in range(5) for k in range(4)], r.randint(1, 8))
        comma = self.pick('.', ',')
        v['points'] = '\n'.join(f'{i * 1.2 * d:.4f}{self.pick(" ", "; ", "  ")}{k * 1.3 * d:.4f}'.replace('.', comma) for i, k in cells)

    def drill(self):
        d = self.length(0.8, 14)
        v = self.common(d, self.length(2, 40))
        self.pattern(v)
        v |= {'depth_at': self.pick('tip', 'diameter'), 'tip_angle': float(self.random.randint(90, 140)), 'cycle': self.pick('drill', 'peck', 'chip_break'), 'peck': round(v['depth'] / self.random.uniform(1, 6), 4), 'dwell': self.pick(0.0, 0.5), 'between': self.pick('safe', 'clearance')}
        return v

    def tap(self):
        d = self.length(2, 14)
        v = self.common(d, self.length(2, 30))
        del v['feed']
        self.pattern(v)
        v['speed'] = float(self.random.randint(50, 800))
        v |= {'tapping': self.pick('rigid', 'floating'), 'hand': self.pick('right', 'left'), 'pitch': round(d * self.random.uniform(0.05, 0.2), 4)}
        return v

    def bore(self):
        v = self.common(self.length(4, 40), self.length(2, 40))
        self.pattern(v)
        v |= {'boring': self.pick('feed_out', 'dwell', 'stop'), 'dwell': self.pick(0.0, 0.4), 'between': self.pick('safe', 'clearance')}
        return v

    def thread_mill(self):
        major = self.length(6, 60)
        pitch = round(major * self.random.uniform(0.02, 0.12), 4)
        inside = self.pick('internal', 'external')
        minor = round(major - 2 * pitch * (0.5413 if inside == 'internal' else 0.6134), 4)
        v = self.common(round(minor * self.random.uniform(0.2, 0.85), 4) if inside == 'internal' else self.length(3, 20), round(pitch * self.random.uniform(1.2, 12), 4))
        self.place(v)
        v |= {'thread_side': inside, 'hand': self.pick('right', 'left'), 'major': major, 'minor': minor, 'pitch': pitch, 'passes': self.random.randint(1, 4), 'direction': self.pick('climb', 'conventional')}
        return v

    def engrave(self):
        d = self.length(0.05, 0.6)
        v = self.common(d, self.length(0.05, 1))
        self.place(v)
        letter = lambda: self.random.choice(LETTERS)
        v |= {'text': self.random.choice('AbcHmn8ä') + ''.join(letter() for _ in range(self.random.randint(0, 14))), 'text_height': self.length(2, 30), 'align': self.pick('left', 'centre', 'right'), 'angle': self.pick(0.0, round(self.random.uniform(-180, 180), 1))}
        v['feed_z'] = self.length(20, 300, 0)
        v['step_down'] = round(min(v['depth'], v['depth'] / self.pick(1, 1.5, 3)), 4)
        return v

    def contour(self):
        v = self.common(self.tool(), self.length(0.5, 8))
        self.milling(v)
        del v['step_over']
        self.entry(v)
        self.place(v)
        v['layer'] = self.pick('0', 'CUT', 'Kontur außen')
        return v


def job_of(maker, steps):
    r = maker.random
    highest = max((s['values']['top'] + s['values']['clearance'] for s in steps), default=0)
    safe = round(max(highest + maker.length(0, 10), maker.length(2, 40)) + 1e-3, 4)
    return {'version': 1, 'machine': 'mill', 'name': r.choice(['Plate', 'Teil 7', 'prueba_3', 'Größe-2']), 'unit': maker.unit, 'system': r.choice(SYSTEMS), 'safe': safe, 'retract': r.choice(['machine', 'machine', 'safe']), 'end': r.choice(['M30', 'M2']), 'steps': steps}


def facts_of(job, maker):
    tools = {s['values']['tool']: s['values']['diameter'] for s in job['steps']}
    return {'tools': [{'number': n, 'diameter': d} for n, d in sorted(tools.items())], 'maxFeed': 6000.0 * maker.scale, 'maxSpeed': 12000.0}


def make(seed):
    maker = Maker(seed)
    r = maker.random
    mode = r.choices(['good', 'planted', 'wild'], [60, 20, 20])[0]
    count = 1 if mode != 'good' or r.random() < 0.85 else r.randint(2, 3)
    steps = [{'type': kind, 'values': maker.values(kind)} for kind in (KINDS[seed % len(KINDS)] if i == 0 else r.choice(KINDS) for i in range(count))]
    numbers = r.sample(range(1, 60), count)
    for number, step in zip(numbers, steps):
        step['values']['tool'] = number
    case = {'seed': seed, 'mode': mode, 'dxf': {}, 'shapes': {}, 'expect': None}
    for i, step in enumerate(steps):
        if step['type'] == 'contour':
            contours, text, sides = dxf_cases.make(r, step['values']['layer'], maker.scale, step['values']['diameter'], maker.unit)
            step['values']['side'] = r.choice(sides)
            case['dxf'][str(i)], case['shapes'][str(i)] = text, contours
    case['job'] = job_of(maker, steps)
    case['facts'] = facts_of(case['job'], maker)
    if mode == 'planted':
        plant(case, maker)
    elif mode == 'wild':
        wild(case, maker)
    return case


def plant(case, maker):
    """Makes one value impossible; `expect` contains the fields at one of which it must be rejected."""
    r, job = maker.random, case['job']
    step = job['steps'][0]
    v, kind = step['values'], step['type']
    options = [('diameter', -1.0), ('diameter', 0.0), ('depth', 0.0), ('depth', -2.0), ('depth', None), ('tool', 1.5), ('tool', 77), ('speed', 0.0), ('speed', 13000.0), ('top', job['safe'] + 1), ('clearance', job['safe'] - v['top'] + 1), ('clearance', 0.0), ('coolant', 'oil')]
    d = v['diameter']
    options += [('feed', 0.0), ('feed', 7000.0)] if 'feed' in v else []
    options += [('step_down', v['depth'] * 1.01), ('step_down', 0.0)] if 'step_down' in v else []
    options += [('step_over', d * 1.01), ('step_over', 0.0), ('step_over', d * 0.92)] if 'step_over' in v else []
    if kind in ('rect_pocket', 'round_pocket', 'slot', 'rect_boss', 'round_boss'):
        options += [('allowance', -0.1), ('allowance', d)]
    if 'entry' in v and v['entry'] == 'ramp':
        options += [('ramp_angle', 0.0), ('ramp_angle', 60.0)]
    special = {
        'face': [('length', 0.0), ('floor_allowance', v['depth']), ('floor_allowance', v.get('step_down', 0) * 1.01)],
        'rect_pocket': [('length', d * 0.9), ('width', d * 0.99), ('corner_radius', d * 0.49), ('corner_radius', 1e3)],
        'round_pocket': [('pocket_diameter', d * 0.95)],
        'slot': [('slot_width', d * 0.98), ('x_end+y_end', (v.get('x'), v.get('y')))],
        'rect_boss': [('stock_length', v.get('length', 0) * 0.99), ('stock_width', v.get('width', 0) * 0.9), ('corner_radius', 1e3)],
        'round_boss': [('stock_length', v.get('boss_diameter', 0) * 0.99)],
        'drill': [('peck', v['depth'] * 1.1)] if v.get('cycle') != 'drill' else [],
        'tap': [('pitch', 6000 * maker.scale / v['speed'] * 1.01), ('pitch', 0.0), ('pitch', d)],
        'bore': [('depth', -1.0)],
        'thread_mill': [('minor', v.get('major', 0)), ('minor', 0.0), ('depth', v.get('pitch', 0) * 0.9)] + ([('diameter', v.get('minor', 0))] if v.get('thread_side') == 'internal' else []),
        'engrave': [('text', ''), ('text', '   '), ('text', 'A漢'), ('text_height', d * 0.9)],
        'contour': [('layer', 'none'), ('drawing', '')],
    }[kind]
    if 'pattern' in v:
        special += {'circle': [('holes', 400), ('holes', 0), ('circle_diameter', -5.0)], 'line': [('spacing', d * 0.9)] if v['holes'] > 1 else [('holes', 0)],
                    'grid': [('spacing_x', d * 0.9)] if v['columns'] > 1 else [('columns', 0)], 'list': [('points', '1 2\n3 x'), ('points', ''), ('points', f'0 0\n{d * 0.5} 0')]}[v['pattern']]
    field, value = r.choice(r.choice([options, special or options]))
    if r.random() < 0.06:
        plant_in_job(case, r)
        return
    for i, name in enumerate(field.split('+')):
        v[name] = value[i] if isinstance(value, tuple) else value
        if name == 'drawing':
            case['dxf'] = {}
    case['expect'] = {'fields': field.split('+'), 'value': value}


def plant_in_job(case, r):
    job = case['job']
    name, value = r.choice([('safe', min(s['values']['top'] for s in job['steps']) - 1), ('name', ''), ('name', '../x'), ('name', 'a/b'), ('system', 'G60')])
    job[name] = value
    case['expect'] = {'job': name, 'value': value}


def wild(case, maker):
    """Some numbers of arbitrary size."""
    r = maker.random
    v = case['job']['steps'][0]['values']
    numeric = [name for name, value in v.items() if isinstance(value, (int, float)) and name != 'tool']
    for name in r.sample(numeric, r.randint(1, min(5, len(numeric)))):
        old = v[name]
        factor = 10 ** r.uniform(-1.5, 1.5)
        value = r.choice([old * factor, old * factor, old * r.uniform(0.7, 1.4), -old, 0.0, 10 ** r.uniform(-4, 5)])
        v[name] = max(0, round(value)) if name in ('holes', 'columns', 'rows', 'passes') else round(value, r.choice([0, 2, 4, 7]))
    case['facts']['tools'][0]['diameter'] = v['diameter'] if isinstance(v['diameter'], float) else 1.0
