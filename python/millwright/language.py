# SPDX-License-Identifier: GPL-2.0-or-later
"""Help of Python programs in the language of the environment, from the catalogues of the other programs (src/base/language)."""
import argparse
import gettext
import os
import pathlib

# What argparse itself prints.
ARGPARSE = ('usage: ', 'positional arguments', 'options', 'show this help message and exit', '%(prog)s: error: %(message)s\n', 'argument %(argument_name)s: %(message)s',
            'the following arguments are required: %s', 'unrecognized arguments: %s', 'expected one argument', 'invalid choice: %(value)r (choose from %(choices)s)',
            'invalid %(type)s value: %(value)r')
MOST_FOLDERS = 7  # from this file up to the folder that contains share


def wanted(environment):
    """The requested languages, the preferred one first, as gettext selects them: LANGUAGE is used only if another variable names
    a locale other than C."""
    locale = next((environment[name] for name in ('LC_ALL', 'LC_MESSAGES', 'LANG') if environment.get(name)), '')
    plain = locale.split('.')[0].split('@')[0]
    if plain in ('', 'C', 'POSIX'):
        return []
    found = []
    for name in (environment.get('LANGUAGE') or plain).split(':'):
        name = name.split('.')[0].split('@')[0]
        if name in ('C', 'POSIX') or name.startswith('en'):
            break
        if name and '/' not in name:
            found += [name, name.split('_')[0]] if '_' in name else [name]
    return found


def read_catalogue(environment):
    for name in wanted(environment):
        for folder in pathlib.Path(__file__).resolve().parents[:MOST_FOLDERS]:
            path = folder / 'share/locale' / name / 'LC_MESSAGES/millwright.mo'
            if path.is_file():
                with path.open('rb') as file:
                    return gettext.GNUTranslations(file)
    return gettext.NullTranslations()


CATALOGUE = read_catalogue(os.environ)


def shown(text):
    """`text` in the user's language; blanks at its ends are kept."""
    core = text.strip()
    return text.replace(core, CATALOGUE.gettext(core)) if core else text


class Parser(argparse.ArgumentParser):
    """Prints help and errors in the user's language."""

    def __init__(self, description, **more):
        argparse._ = shown  # where argparse looks up its own texts
        super().__init__(description=shown(description), **more)

    def add_argument(self, *names, **settings):
        if settings.get('help'):
            settings['help'] = shown(settings['help'])
        return super().add_argument(*names, **settings)
