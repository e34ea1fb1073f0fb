# SPDX-License-Identifier: GPL-2.0-or-later
"""Random forms of lathe operations, in the manner of cases.py."""
import cases

KINDS = ['turn', 'lathe_face', 'lathe_bore', 'groove', 'part_off', 'lathe_thread', 'chamfer', 'radius']


class Maker(cases.Maker):
    def head(self):
        v = {'tool': 1, 'clearance': self.length(0.5, 3), 'coolant': self.pick('flood', 'mist', 'off')}
        v |= {'speed_mode': self.pick('rev', 'surface'), 'speed': float(self.random.randint(100, 2500)), 'surface': float(self.random.randint(30, 300)), 'limit_speed': float(self.random.randint(300, 2500)), 'feed_rev': self.length(0.03, 0.4, 4)}
        return v

    def noses(self, v):
        v['nose'] = self.length(0.1, 1.2)
        return v

    def depth(self, v, total):
        v['allowance'] = self.pick(0.0, round(total * self.random.uniform(0.02, 0.3), 4))
        v['cut'] = round(0.9999 * total / self.random.choice([1, 1.5, 3, 6.2]), 4)
        v['allowance'] = min(v['allowance'], v['cut'])
        return v

    def turn(self):
        v = self.noses(self.head())
        v['stock_diameter'] = self.length(10, 60)
        v['part_diameter'] = round(v['stock_diameter'] * self.random.uniform(0.3, 0.97), 4)
        v['z_start'] = self.pick(0.0, self.length(-5, 5))
        v = self.depth(v, (v['stock_diameter'] - v['part_diameter']) / 2)
        v['z_end'] = round(v['z_start'] - v['nose'] - v['allowance'] - self.length(1, 50), 4)
        return v

    def lathe_bore(self):
        v = self.noses(self.head())
        v['hole_diameter'] = round(2 * v['clearance'] + self.length(6, 30), 4)
        v['bore_diameter'] = round(v['hole_diameter'] + self.length(0.4, 16), 4)
        v['z_start'] = self.pick(0.0, self.length(-5, 5))
        v = self.depth(v, (v['bore_diameter'] - v['hole_diameter']) / 2)
        v['z_end'] = round(v['z_start'] - v['nose'] - v['allowance'] - self.length(1, 40), 4)
        return v

    def lathe_face(self):
        v = self.noses(self.head())
        v['stock_diameter'] = self.length(10, 60)
        v['end_diameter'] = self.pick(0.0, round(v['stock_diameter'] * self.random.uniform(0.1, 0.7), 4))
        v['z_end'] = self.pick(0.0, self.length(-3, 3))
        v['z_start'] = round(v['z_end'] + self.length(0.2, 6), 4)
        return self.depth(v, v['z_start'] - v['z_end'])

    def widths(self, v):
        v['tool_width'], v['tool_edge'], v['z_edge'] = self.length(1, 5), self.pick('left', 'right'), self.length(-40, -3)
        v['stock_diameter'] = self.length(10, 60)
        return v

    def groove(self):
        v = self.widths(self.head())
        v['groove_diameter'] = round(v['stock_diameter'] * self.random.uniform(0.4, 0.95), 4)
        v['groove_width'] = self.pick(v['tool_width'], round(v['tool_width'] * self.random.uniform(1, 6), 4))
        v['peck'] = round(0.9999 * (v['stock_diameter'] - v['groove_diameter']) / 2 / self.random.choice([1, 1.7, 4]), 4)
        return v

    def part_off(self):
        v = self.widths(self.head())
        v['end_diameter'] = self.pick(0.0, round(v['stock_diameter'] * 0.2, 4))
        v['peck'] = round(0.9999 * (v['stock_diameter'] - v['end_diameter']) / 2 / self.random.choice([1, 3, 7]), 4)
        return v

    def lathe_thread(self):
        v = self.head()
        for name in ('speed_mode', 'surface', 'limit_speed', 'feed_rev'):
            del v[name]
        v['speed'] = float(self.random.randint(60, 900))
        v['major'] = round(self.length(10, 50) + 2 * v['clearance'], 4)
        v['pitch'] = round(v['major'] * self.random.uniform(0.03, 0.1), 4)
        v['speed'] = min(v['speed'], float(int(2900 * self.scale / v['pitch'])))
        v['thread_side'] = self.pick('external', 'internal')
        v['minor'] = round(v['major'] - 2 * v['pitch'] * (0.5413 if v['thread_side'] == 'internal' else 0.6134), 4)
        v['z_start'] = self.pick(0.0, self.length(-5, 5))
        v['z_end'] = round(v['z_start'] - self.length(3, 40), 4)
        v['lead_in'] = round(v['pitch'] * self.random.uniform(1, 5), 4)
        v['first_cut'] = round((v['major'] - v['minor']) / 2 * self.random.uniform(0.1, 1) - 1e-4, 4)
        v['springs'] = self.random.randint(0, 3)
        return v

    def corner(self, name):
        v = self.noses(self.head())
        v[name] = self.length(0.3, 5)
        v['part_diameter'] = round(2 * (v[name] + v['nose'] + v['clearance']) + self.length(0.1, 40), 4)
        v['z_start'] = self.pick(0.0, self.length(-5, 5))
        v['cut'] = round(0.9999 * v[name] / self.random.choice([1, 2, 5]), 4)
        return v

    def chamfer(self):
        return self.corner('chamfer')

    def radius(self):
        return self.corner('radius')


def make(seed):
    maker = Maker(seed)
    r = maker.random
    kind = KINDS[seed % len(KINDS)]
    v = maker.values(kind)
    v['tool'] = r.randint(1, 30)
    widest = max(v.get(name, 0) for name in ('stock_diameter', 'part_diameter', 'bore_diameter', 'major'))
    job = {'version': 1, 'machine': 'lathe', 'name': 'Shaft', 'unit': maker.unit, 'system': r.choice(cases.SYSTEMS), 'safe': round(max(v.get('z_start', 0), 0) + max(v['clearance'], v.get('lead_in', 0)) + maker.length(0, 30), 4),
           'safeX': round(widest + 2 * v['clearance'] + maker.length(0, 30) + 1e-4, 4), 'retract': 'safe', 'end': r.choice(['M30', 'M2']), 'steps': [{'type': kind, 'values': v}]}
    case = {'seed': seed, 'mode': r.choices(['good', 'planted', 'wild'], [60, 20, 20])[0], 'dxf': {}, 'shapes': {}, 'expect': None, 'job': job}
    case['facts'] = {'tools': [{'number': v['tool'], 'diameter': 1.0}], 'maxFeed': 3000.0 * maker.scale, 'maxSpeed': 3000.0}
    if case['mode'] == 'planted':
        plant(case, maker)
    elif case['mode'] == 'wild':
        names = [name for name, value in v.items() if isinstance(value, float)]
        for name in r.sample(names, r.randint(1, 3)):
            v[name] = r.choice([v[name] * 10 ** r.uniform(-1, 1), -v[name], 0.0, v[name] * r.uniform(0.7, 1.4)])
    return case


def plant(case, maker):
    r, job = maker.random, case['job']
    v, kind = job['steps'][0]['values'], job['steps'][0]['type']
    options = [('clearance', 0.0), ('tool', 77)]
    options += [('speed', 5000.0)] if v.get('speed_mode', 'rev') == 'rev' else [('limit_speed', 5000.0), ('surface', 0.0)]
    options += [('feed_rev', 0.0), ('feed_rev', -0.1)] if 'feed_rev' in v else []
    options += [('cut', 0.0), ('cut', 100.0 * maker.scale)] if 'cut' in v else []
    options += [('allowance', v['cut'] * 1.01)] if 'allowance' in v else []
    options += [('stock_diameter', job['safeX'])] if 'stock_diameter' in v else []
    options += [('z_start', job['safe'] + 1), ('z_end', v['z_start'])] if 'z_end' in v else []
    options += {'turn': [('part_diameter', v.get('stock_diameter'))], 'lathe_bore': [('bore_diameter', v.get('hole_diameter')), ('hole_diameter', v['clearance'])], 'lathe_face': [('end_diameter', v.get('stock_diameter'))],
                'groove': [('groove_width', v.get('tool_width', 0) * 0.9), ('groove_diameter', v.get('stock_diameter')), ('peck', 0.0)], 'part_off': [('end_diameter', v.get('stock_diameter')), ('peck', 1e3)],
                'lathe_thread': [('pitch', 3000 * maker.scale / v['speed'] * 1.01), ('minor', v.get('major')), ('first_cut', v.get('major'))], 'chamfer': [('chamfer', v.get('part_diameter'))], 'radius': [('radius', v.get('part_diameter'))]}[kind]
    name, value = r.choice(options)
    v[name] = value
    case['expect'] = {'fields': [name], 'value': value}
