# SPDX-License-Identifier: GPL-2.0-or-later
"""Random HAL files for compare_hal.py: streamers feed components, samplers record every output in every period.

A file has a group of components that are linked to each other, once for each order of their functions (addf), and some separate
components. The exports of components are discovered, not listed.
"""
import dataclasses
import itertools
import random

import hal_differences
from hal_components import COMPONENTS, LETTERS, generator_of, quadrature

FIFO_PINS = 20
FIFOS = 8
MOST_ORDERS = 6
ROWS = 150


@dataclasses.dataclass
class Instance:
    """A component of a file, with the values of its inputs and parameters."""
    name: str
    load: str
    prefix: str
    exports: dict
    functions: list
    avoided: set = dataclasses.field(default_factory=set)  # differences that do not apply to this file

    def pins(self, direction):
        return [pin for pin, what in self.exports.items() if what[0] in LETTERS and what[1] == direction]

    def may_differ(self, pin):
        """The difference that covers this output, or None."""
        return next((d for d in hal_differences.of_component(self.name, self.load)
                     if d not in self.avoided and d.shift == 0 and d.covers(pin)), None)


class HalFile:
    """One generated file: `text`, the rows of its FIFOs, and the meaning of each recorded column."""

    def __init__(self, seed, exports, wanted=None):
        self.seed = seed
        self.random = random.Random(seed)
        self.exports = exports
        self.loads, self.nets, self.setps, self.adds = [], [], [], []
        self.streams, self.samples = [], []  # (pin's type, values), (pin's type, instance, pin)
        self.linked = {}
        self.period_ns = 1000000
        names = [name for name in COMPONENTS if name in exports]
        self.make_group([n for n in names if not COMPONENTS[n].single and (not wanted or n in wanted)], wanted)
        self.make_singles([n for n in names if COMPONENTS[n].single and (not wanted or n in wanted)])
        self.text = self.make_text()

    # The contents of the file.

    def make_group(self, names, wanted):
        if not names:
            return
        size = min(len(names), self.random.choice((1, 2, 2, 3)))
        chosen = self.random.sample(names, size)
        orders = list(itertools.permutations(range(size)))
        self.random.shuffle(orders)
        columns = sum(len(self.exports[n].outputs()) for n in chosen)
        orders = orders[:max(1, min(MOST_ORDERS, 100 // max(1, columns)))]
        plans = [self.plan(name) for name in chosen]
        sources = self.choose_links(chosen, plans)
        for number, order in enumerate(orders):
            instances = [self.instance(name, number, plan) for name, plan in zip(chosen, plans)]
            self.connect(instances, plans, sources, number)
            for at in order:
                self.adds += instances[at].functions
        for name, plan in zip(chosen, plans):
            self.loads.append(COMPONENTS[name].load_text(plan['load'], len(orders)))

    def make_singles(self, names):
        count = self.random.choice((0, 1, 1, 2)) if self.loads else 1
        for name in self.random.sample(names, min(count, len(names))):
            plan = self.plan(name)
            instance = self.instance(name, 0, plan)
            self.connect([instance], [plan], {}, name)
            functions = list(instance.functions)
            self.random.shuffle(functions)
            if COMPONENTS[name].ordered:
                functions.sort(reverse=True)
            self.adds += functions
            self.loads.append(plan['load'])

    def plan(self, name):
        """The values of all inputs and parameters of a component, the same in each order."""
        spec = COMPONENTS[name]
        load = self.random.choice(spec.loads or [name])
        found = self.exports[name].of_load(load)
        avoided = {d for d in hal_differences.of_component(name, load) if d.avoid and self.random.random() < 0.7}
        forced = {pin: value for d in avoided for pin, value in d.avoid.items()}
        values, params = {}, {}
        for pin, what in found.items():
            kind, direction = what[0], what[1] if len(what) > 1 else ''
            if kind not in LETTERS or spec.is_skipped(pin):
                continue
            draw = generator_of(spec, forced, pin, kind, self.random)
            if direction == 'IN':
                values[pin] = self.column(draw)
            elif direction in ('RW', 'I/O') and (pin in forced or spec.has_generator(pin)
                                                 or self.random.random() < 0.5):
                params[pin] = draw(self.random, None)
        for first, second in spec.pairs:
            values[first], values[second] = quadrature(self.random, ROWS)
        return {'load': load, 'found': found, 'values': values, 'params': params, 'avoided': avoided}

    def column(self, draw):
        if hasattr(draw, 'column'):
            return draw.column(self.random, ROWS)
        values, last = [], None
        for _ in range(ROWS):
            last = draw(self.random, last)
            values.append(last)
        return values

    def instance(self, name, number, plan):
        spec = COMPONENTS[name]
        prefix = spec.prefix_of(name, number)
        functions = [spec.function_name(name, number, f) for f, what in plan['found'].items()
                     if what[0] == 'function']
        return Instance(name, plan['load'], prefix, plan['found'], functions, plan['avoided'])

    def choose_links(self, chosen, plans):
        """{(component, input): (component, output)}: the inputs that are linked to outputs of the group."""
        links = {}
        for to, plan in enumerate(plans):
            for pin in plan['values']:
                kind = plan['found'][pin][0]
                outputs = [(at, out) for at, other in enumerate(plans) if at != to
                           for out, what in other['found'].items()
                           if what[0] == kind and what[1:2] == ('OUT',) and not COMPONENTS[chosen[at]].is_hidden(out)
                           and not self.is_uncertain(chosen[at], other['load'], out,
                                                         other['avoided'])]
                is_fixed = any(pin in d.avoid for d in plan['avoided']) or COMPONENTS[chosen[to]].has_generator(pin) \
                    or any(pin in pair for pair in COMPONENTS[chosen[to]].pairs)
                if outputs and not is_fixed and self.random.random() < 0.4:
                    links[to, pin] = self.random.choice(outputs)
        return links

    @staticmethod
    def is_uncertain(name, load, pin, avoided):
        return any(d.covers(pin) for d in hal_differences.of_component(name, load) if d not in avoided)

    # Its connections.

    def connect(self, instances, plans, links, tag):
        for at, (instance, plan) in enumerate(zip(instances, plans)):
            for param, value in plan['params'].items():
                self.setps.append(f'{instance.prefix}{param} {value}')
            for pin, values in plan['values'].items():
                if (at, pin) not in links:
                    self.feed(instance, pin, plan, values, (tag if instance.name in COMPONENTS and
                                                            COMPONENTS[instance.name].single else 'group', at, pin))
            for pin, what in plan['found'].items():
                if what[0] in LETTERS and what[1] in ('OUT', 'I/O') and not COMPONENTS[instance.name].is_hidden(pin):
                    self.record(instance, pin, what[0], [(instances[to].prefix + inner)
                                                         for (to, inner), source in links.items()
                                                         if source == (at, pin)])

    def feed(self, instance, pin, plan, values, key):
        """One stream column serves the same input in all orders."""
        kind = plan['found'][pin][0]
        if key not in self.linked:
            if len(self.streams) == FIFO_PINS * FIFOS:
                return
            self.linked[key] = len(self.streams)
            self.streams.append((kind, values))
            self.nets.append(f'net in{self.linked[key]} {stream_pin(self.linked[key])}')
        self.nets.append(f'net in{self.linked[key]} {instance.prefix}{pin}')

    def record(self, instance, pin, kind, readers):
        at = len(self.samples)
        is_recorded = at < FIFO_PINS * FIFOS
        if is_recorded:
            self.samples.append((kind, instance, pin))
        if is_recorded or readers:
            name = f'out{at}' if is_recorded else 'link_' + (instance.prefix + pin).replace('.', '_')
            words = [instance.prefix + pin, *readers] + ([f'sampler.{at // FIFO_PINS}.pin.{at % FIFO_PINS}']
                                                         if is_recorded else [])
            self.nets.append(f'net {name} ' + ' '.join(words))

    def make_text(self):
        streams, samples = parts([kind for kind, _ in self.streams]), parts([kind for kind, _, _ in self.samples])
        depth = ROWS + 16
        lines = [f'loadrt threads name1=t period1={self.period_ns}']
        if streams:
            lines.append(f'loadrt streamer cfg={",".join(streams)} depth={",".join([str(depth)] * len(streams))}')
        lines.append(f'loadrt sampler cfg={",".join(samples)} depth={",".join([str(depth)] * len(samples))}')
        lines += [f'loadrt {load}' for load in self.loads] + [f'setp {text}' for text in self.setps] + self.nets
        lines += [f'addf streamer.{i} t' for i in range(len(streams))] + [f'addf {f} t' for f in self.adds]
        lines += [f'addf sampler.{i} t' for i in range(len(samples))]
        lines += [f'loadusr -w halstreamer -c {i} in{i}.txt' for i in range(len(streams))] + ['start']
        lines += [f'loadusr -w halsampler -c {i} -n {ROWS} out{i}.txt' for i in range(len(samples))]
        return '\n'.join(lines) + '\n'

    def inputs(self):
        """{file name: text} of the streams."""
        files = {}
        for first in range(0, len(self.streams), FIFO_PINS):
            columns = [values for _, values in self.streams[first:first + FIFO_PINS]]
            files[f'in{first // FIFO_PINS}.txt'] = ''.join(
                ' '.join(str(value) for value in row) + '\n' for row in zip(*columns))
        return files

    def outputs(self):
        return [f'out{i}.txt' for i in range(len(parts([kind for kind, _, _ in self.samples])))]

    def components(self):
        return sorted({instance.name for _, instance, _ in self.samples})


def stream_pin(at):
    return f'streamer.{at // FIFO_PINS}.pin.{at % FIFO_PINS}'


def parts(kinds):
    """The cfg= words of streams with these columns."""
    letters = ''.join(LETTERS[kind] for kind in kinds)
    return [letters[i:i + FIFO_PINS] for i in range(0, len(letters), FIFO_PINS)]
