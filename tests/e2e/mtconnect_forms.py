# SPDX-License-Identifier: GPL-2.0-or-later
"""The form of documents of MTConnect 2.2, as far as the agent uses it: elements, their order, attributes, types and words.
Written from the facts of the standard (parts 1 to 4); the published schemas are not part of this project."""
import re
import xml.etree.ElementTree as tree

TIME = r'\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d(\.\d+)?Z'
NUMBER, WHOLE, POSITIVE = r'-?\d+(\.\d+)?', r'-?\d+', r'[1-9]\d*'
ID, ANY = r'[A-Za-z_][\w.-]*', r'(?s).+'
UNAVAILABLE = 'UNAVAILABLE'
HEAD = {'creationTime': TIME, 'sender': ANY, 'instanceId': POSITIVE, 'version': r'\d+\.\d+(\.\d+){0,2}', 'testIndicator?': 'true|false'}
MODEL = {'deviceModelChangeTime': TIME}
HEADERS = {
    'Devices': HEAD | MODEL | {'bufferSize': POSITIVE, 'assetBufferSize': POSITIVE, 'assetCount': r'\d+'},
    'Streams': HEAD | MODEL | {'bufferSize': POSITIVE, 'firstSequence': POSITIVE, 'lastSequence': r'\d+', 'nextSequence': POSITIVE},
    'Assets': HEAD | MODEL | {'assetBufferSize': POSITIVE, 'assetCount': r'\d+'},
    'Error': HEAD | {'bufferSize': POSITIVE},
}
# Type: category, subtypes, units, pattern of a value.
WORDS = {
    'AVAILABILITY': ('EVENT', (None,), None, 'AVAILABLE'),
    'ASSET_CHANGED': ('EVENT', (None,), None, ANY),
    'ASSET_REMOVED': ('EVENT', (None,), None, ANY),
    'EMERGENCY_STOP': ('EVENT', (None,), None, 'ARMED|TRIGGERED'),
    'MESSAGE': ('EVENT', (None,), None, ANY),
    'CONTROLLER_MODE': ('EVENT', (None,), None, 'AUTOMATIC|MANUAL|MANUAL_DATA_INPUT|SEMI_AUTOMATIC|EDIT'),
    'EXECUTION': ('EVENT', (None,), None, 'READY|ACTIVE|INTERRUPTED|FEED_HOLD|STOPPED|OPTIONAL_STOP|PROGRAM_STOPPED|PROGRAM_COMPLETED|WAIT'),
    'PROGRAM': ('EVENT', (None,), None, r'(?s).*'),
    'BLOCK': ('EVENT', (None,), None, r'(?s).*'),
    'LINE_NUMBER': ('EVENT', ('ABSOLUTE', 'INCREMENTAL'), None, WHOLE),
    'PATH_FEEDRATE': ('SAMPLE', (None, 'ACTUAL', 'COMMANDED', 'JOG', 'PROGRAMMED', 'RAPID'), 'MILLIMETER/SECOND', NUMBER),
    'PATH_FEEDRATE_OVERRIDE': ('EVENT', ('JOG', 'PROGRAMMED', 'RAPID'), 'PERCENT', NUMBER),
    'WORK_OFFSET': ('EVENT', (None,), None, ANY),
    'TOOL_NUMBER': ('EVENT', (None,), None, ANY),
    'POSITION': ('SAMPLE', ('ACTUAL', 'COMMANDED', 'PROGRAMMED', 'TARGET'), 'MILLIMETER', NUMBER),
    'ANGLE': ('SAMPLE', ('ACTUAL', 'COMMANDED'), 'DEGREE', NUMBER),
    'ROTARY_VELOCITY': ('SAMPLE', ('ACTUAL', 'COMMANDED', 'PROGRAMMED'), 'REVOLUTION/MINUTE', NUMBER),
    'ROTARY_VELOCITY_OVERRIDE': ('EVENT', (None,), 'PERCENT', NUMBER),
    'DIRECTION': ('EVENT', ('ROTARY', 'LINEAR'), None, 'CLOCKWISE|COUNTER_CLOCKWISE|POSITIVE|NEGATIVE|NONE'),
}
CONDITIONS = {'SYSTEM', 'LOGIC_PROGRAM', 'MOTION_PROGRAM', 'HARDWARE', 'ACTUATOR', 'POSITION', 'COMMUNICATIONS'}
COMPONENTS = {'Axes', 'Linear', 'Rotary', 'Controller', 'Path', 'Systems'}
ERRORS = 'UNAUTHORIZED|NO_DEVICE|OUT_OF_RANGE|TOO_MANY|INVALID_URI|INVALID_REQUEST|INTERNAL_ERROR|INVALID_PATH|UNSUPPORTED|ASSET_NOT_FOUND'
STATUS = 'NEW|AVAILABLE|UNAVAILABLE|ALLOCATED|UNALLOCATED|MEASURED|RECONDITIONED|USED|EXPIRED|BROKEN|NOT_REGISTERED|UNKNOWN'
MEASUREMENTS = {'CuttingDiameterMax': 'DC', 'FunctionalLength': 'LF'}


def name_of(word):
    return ''.join(part.capitalize() for part in word.split('_'))


class Check:
    """Collects the faults of one document."""

    def __init__(self, text):
        self.problems = []
        try:
            self.root = tree.fromstring(text)
        except tree.ParseError as error:
            self.problems.append(f'no XML: {error}')
            self.root = None
            return
        found = re.fullmatch(r'\{urn:mtconnect\.org:MTConnect(\w+):2\.2\}MTConnect(\w+)', self.root.tag)
        self.kind = found[1] if found and found[1] == found[2] else ''
        if not self.kind:
            self.problems.append(f'the root is {self.root.tag}')
            return
        for element in self.root.iter():
            element.tag = element.tag.split('}')[1]
        self.attributes(self.root[0], HEADERS[self.kind])
        {'Devices': self.devices, 'Streams': self.streams, 'Assets': self.assets, 'Error': self.error}[self.kind]()

    def expect(self, condition, what):
        if not condition:
            self.problems.append(what)

    def attributes(self, element, known):
        for name, value in element.attrib.items():
            pattern = known.get(name) or known.get(name + '?')
            if not name.startswith('{'):
                self.expect(pattern and re.fullmatch(pattern, value), f'<{element.tag} {name}="{value}">')
        for name in known:
            self.expect(name.endswith('?') or name in element.attrib, f'<{element.tag}> has no {name}')

    def children(self, element, *order):
        """Each name at most once, names with * any number of times, in this order."""
        places = {name.strip('*'): i for i, name in enumerate(order)}
        found = [child.tag for child in element]
        self.expect(all(tag in places for tag in found), f'<{element.tag}> has {found}')
        ranks = [places.get(tag, -1) for tag in found]
        self.expect(ranks == sorted(ranks), f'<{element.tag}> has another order: {found}')
        for tag in set(found):
            self.expect(found.count(tag) == 1 or f'{tag}*' in order, f'<{element.tag}> has more than one {tag}')

    def component(self, element):
        is_device = element.tag == 'Device'
        self.attributes(element, {'id': ID, 'name': r'\S.*', 'uuid': ANY} if is_device else {'id': ID, 'name?': r'\S+', 'uuid?': ANY})
        self.children(element, 'Description', 'Configuration', 'DataItems', 'Components', 'Compositions', 'References')
        for item in element.findall('DataItems/*'):
            self.attributes(item, {'id': ID, 'category': 'SAMPLE|EVENT|CONDITION', 'type': r'[A-Z_]+', 'subType?': r'[A-Z_]+', 'units?': ANY,
                                   'name?': ANY})
            kind = item.get('type')
            if item.get('category') == 'CONDITION':
                self.expect(kind in CONDITIONS, f'condition {kind}')
                continue
            self.expect(kind in WORDS, f'type {kind}')
            category, subs, units, _ = WORDS.get(kind, ('', (), None, ''))
            self.expect(item.get('category') == category, f'{kind} is a {item.get("category")}')
            self.expect(item.get('subType') in subs, f'{kind} has the subtype {item.get("subType")}')
            self.expect(item.get('units') == units, f'{kind} has the units {item.get("units")}')
        for child in element.findall('Components/*'):
            self.expect(child.tag in COMPONENTS, f'component {child.tag}')
            self.component(child)

    def devices(self):
        self.children(self.root, 'Header', 'Devices')
        devices = self.root.findall('Devices/Device')
        self.expect(devices, 'there is a device')
        for device in devices:
            self.component(device)
            types = {item.get('type') for item in device.findall('DataItems/DataItem')}
            self.expect({'AVAILABILITY', 'ASSET_CHANGED', 'ASSET_REMOVED'} <= types, f'the device has {types}')
        ids = [element.get('id') for device in devices for element in device.iter() if element.get('id')]
        self.expect(len(ids) == len(set(ids)), 'an id is there twice')

    def observation(self, part, element):
        known = {'dataItemId': ID, 'timestamp': TIME, 'sequence': POSITIVE, 'subType?': r'[A-Z_]+', 'name?': ANY}
        if part == 'Condition':
            self.expect(element.tag in ('Normal', 'Warning', 'Fault', 'Unavailable'), f'condition {element.tag}')
            self.attributes(element, known | {'type': '|'.join(CONDITIONS), 'nativeCode?': ANY, 'nativeSeverity?': ANY, 'qualifier?': 'HIGH|LOW'})
            return
        types = {name_of(word): word for word in WORDS}
        self.expect(element.tag in types, f'observation {element.tag}')
        word = WORDS.get(types.get(element.tag), ('', (), None, ''))
        self.expect(word[0].capitalize() + 's' == part, f'{element.tag} is among {part}')
        if element.tag.startswith('Asset'):
            known = known | {'assetType': 'CuttingTool'}
        self.attributes(element, known)
        self.expect(element.get('subType') in word[1], f'{element.tag} has the subtype {element.get("subType")}')
        text = element.text or ''
        self.expect(text == UNAVAILABLE or re.fullmatch(word[3], text), f'{element.tag} has the value {text!r}')

    def streams(self):
        self.children(self.root, 'Header', 'Streams')
        for device in self.root.findall('Streams/*'):
            self.expect(device.tag == 'DeviceStream', device.tag)
            self.attributes(device, {'name': ANY, 'uuid': ANY})
            for component in device:
                self.expect(component.tag == 'ComponentStream', component.tag)
                self.attributes(component, {'component': '|'.join(COMPONENTS | {'Device'}), 'componentId': ID, 'name?': ANY, 'uuid?': ANY})
                self.children(component, 'Samples', 'Events', 'Condition')
                self.expect(len(component), 'an empty ComponentStream')
                for part in component:
                    sequences = [int(element.get('sequence')) for element in part]
                    self.expect(len(sequences) == len(set(sequences)), 'a sequence number is there twice')
                    for element in part:
                        self.observation(part.tag, element)

    def assets(self):
        self.children(self.root, 'Header', 'Assets')
        for asset in self.root.findall('Assets/*'):
            self.expect(asset.tag == 'CuttingTool', asset.tag)
            self.attributes(asset, {'assetId': ANY, 'timestamp': TIME, 'toolId': ANY, 'serialNumber': ANY, 'deviceUuid?': ANY, 'removed?': 'true|false'})
            self.children(asset, 'Description', 'CuttingToolLifeCycle')
            for life in asset.findall('CuttingToolLifeCycle'):
                self.children(life, 'CutterStatus', 'ReconditionCount', 'ToolLife*', 'ProgramToolGroup', 'ProgramToolNumber', 'Location',
                              'ProcessSpindleSpeed', 'ProcessFeedRate', 'ConnectionCodeMachineSide', 'Measurements', 'CuttingItems')
                self.expect(life[0].tag == 'CutterStatus' and len(life[0]) and all(re.fullmatch(STATUS, one.text) for one in life[0]), 'CutterStatus')
                for place in life.findall('Location'):
                    self.attributes(place, {'type': 'POT|STATION|CRIB|SPINDLE', 'positiveOverlap?': WHOLE, 'negativeOverlap?': WHOLE})
                for one in life.findall('Measurements/*'):
                    self.attributes(one, {'code?': MEASUREMENTS.get(one.tag, 'none'), 'units?': 'MILLIMETER', 'nominal?': NUMBER})
                    self.expect(one.tag in MEASUREMENTS and re.fullmatch(NUMBER, one.text or ''), f'measurement {one.tag}')

    def error(self):
        self.children(self.root, 'Header', 'Errors')
        self.expect(self.root.findall('Errors/Error'), 'there is an error')
        for one in self.root.findall('Errors/*'):
            self.expect(one.tag == 'Error' and one.text, 'an error has a text')
            self.attributes(one, {'errorCode': ERRORS})


def problems_of(text):
    return Check(text).problems


def self_test():
    """Faulty documents are detected."""
    right = ('<MTConnectError xmlns="urn:mtconnect.org:MTConnectError:2.2"><Header creationTime="2026-01-01T00:00:00Z" sender="h" instanceId="1" '
             'version="2.2.0.0" bufferSize="10"/><Errors><Error errorCode="NO_DEVICE">text</Error></Errors></MTConnectError>')
    wrong = (right.replace('NO_DEVICE', 'NOTHING'), right.replace(' sender="h"', ''), right.replace('>text<', '><'), right[:-1],
             right.replace('2026-01-01T', ''), right.replace('Errors>', 'Faults>'), right.replace(':2.2"', ':9"'), right.replace(' sender', ' more="1" sender'))
    return not problems_of(right) and all(problems_of(text) for text in wrong)
