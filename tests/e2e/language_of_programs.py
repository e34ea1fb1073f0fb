#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Help and errors of each installed program are in the user's language; output for programs has the same bytes in every language
(A8).

usage: language_of_programs.py BIN_FOLDER
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

from mill_by_hand import STEP_S, Findings

FOUND = Findings()
expect = FOUND.expect
VARIABLES = ('LANG', 'LANGUAGE', 'LC_ALL', 'LC_MESSAGES')
PLAIN = {name: value for name, value in os.environ.items() if name not in VARIABLES}
# A fresh Debian has no generated locale for these languages, only C.UTF-8.
GERMAN = ({'LANG': 'de_DE.UTF-8'}, {'LC_ALL': 'de_AT', 'LANG': 'es_ES.UTF-8'}, {'LC_MESSAGES': 'de_DE.UTF-8', 'LANG': 'C'}, {'LANGUAGE': 'de:es', 'LANG': 'en_US.UTF-8'})
SPANISH = ({'LANG': 'es_ES.UTF-8'}, {'LC_ALL': 'es', 'LANG': 'de_DE.UTF-8'}, {'LC_MESSAGES': 'es_ES.UTF-8', 'LANG': 'C'}, {'LANGUAGE': 'es:de', 'LANG': 'en_US.UTF-8'})
ENGLISH = ({}, {'LANG': 'C.UTF-8'}, {'LANG': 'en_GB.UTF-8'}, {'LC_ALL': 'C', 'LANG': 'de_DE.UTF-8'}, {'LANG': 'C.UTF-8', 'LANGUAGE': 'de'})
# Tools of the build and of tests, which are not installed.
NOT_INSTALLED = {'reference_pages', 'hal_tcl_test'}
# English words that occur in the help and in none of the other languages.
ENGLISH_WORDS = re.compile(r'\b(the|of|and|with|is|are|which|this|its|from|to|for|usage|not|default|by|other)\b')
PLACE = re.compile(r'[\w.]+:\d+:\d+: ')

HAL_ERRORS = (  # a command; its error in English, German and Spanish
    ('setp nosuch 1', "parameter or pin 'nosuch' does not exist", "der Parameter oder Pin 'nosuch' ist nicht vorhanden", "el parámetro o pin 'nosuch' no existe"),
    ('setp and2.0.in1x 1', "(did you mean 'and2.0.in1'?)", "(war 'and2.0.in1' gemeint?)", "(¿quería decir 'and2.0.in1'?)"),
    ('setp and2.0.in1 7', "'and2.0.in1': '7' is not a value of type bit: expected TRUE, FALSE, 1 or 0", "'7' ist kein Wert vom Typ bit: erwartet wird TRUE, FALSE, 1 oder 0",
     "'7' no es un valor de tipo bit: se espera TRUE, FALSE, 1 o 0"),
    ('net other and2.0.out', "pin 'and2.0.out' is linked to signal 'o' already", "der Pin 'and2.0.out' ist schon mit dem Signal 'o' verbunden",
     "el pin 'and2.0.out' ya está conectado a la señal 'o'"),
    ('net o and2.1.out', "signal 'o' cannot have OUT pin 'and2.1.out': pin 'and2.0.out' writes it already",
     "am Signal 'o' ist kein Pin OUT 'and2.1.out' möglich: Pin 'and2.0.out' schreibt es schon", "la señal 'o' no admite el pin OUT 'and2.1.out': pin 'and2.0.out' ya la escribe"),
    ('newsig o bit', "there is a signal 'o' already", "es gibt schon ein Signal 'o'", "ya existe una señal 'o'"),
    ('addf and2.0 servoo', "thread 'servoo' does not exist", "der Thread 'servoo' ist nicht vorhanden", "el hilo 'servoo' no existe"),
    ('addf and2.0 servo', "function 'and2.0' is in a thread already", "die Funktion 'and2.0' ist schon in einem Thread", "la función 'and2.0' ya está en un hilo"),
    ('addf and2.1', 'addf needs 2 to 3 arguments, 1 given', 'addf braucht 2 bis 3 Argumente, angegeben sind 1', 'addf necesita de 2 a 3 argumentos, hay 1'),
    ('net', 'net needs at least 2 arguments, 0 given (net SIGNAL PIN...)', 'net braucht mindestens 2 Argumente, angegeben sind 0 (net SIGNAL PIN...)',
     'net necesita al menos 2 argumentos, hay 0 (net SIGNAL PIN...)'),
    ('loadrt nosuch', "there is no module 'nosuch.so' in", "es gibt kein Modul 'nosuch.so' in", "no existe el módulo 'nosuch.so' en"),
    ('loadrt and2', "module 'and2' is loaded already", "das Modul 'and2' ist schon geladen", "el módulo 'and2' ya está cargado"),
    ('loadrt or2 cnt=1', "module 'or2' has no parameter 'cnt'; it has", "das Modul 'or2' hat keinen Parameter 'cnt'; es hat", "el módulo 'or2' no tiene el parámetro 'cnt'; tiene"),
    ('loadusr -w false', "program 'false' ended with status 1", "das Programm 'false' endete mit dem Ergebnis 1", "el programa 'false' terminó con el estado 1"),
    ('source nosuch.hal', "HAL file 'nosuch.hal' not found (searched in the working folder", "die HAL-Datei 'nosuch.hal' ist nicht zu finden (gesucht im Arbeitsordner",
     "no se encuentra el archivo HAL 'nosuch.hal' (se ha buscado en la carpeta de trabajo"),
    ('setp and2.0.in1 [A]B', "'[A]B' needs an INI file, and none was given", "'[A]B' braucht eine INI-Datei, und keine ist angegeben", "'[A]B' necesita un archivo INI, y no se ha dado ninguno"),
    ('linkpp and2.1.in0 and2.1.in1', "warning: linkpp command is deprecated, use 'net'", "Warnung: der Befehl linkpp ist veraltet, 'net' verwenden", "aviso: la orden linkpp está obsoleta, use 'net'"),
    ('nosuch', "unknown command 'nosuch'", "unbekannter Befehl 'nosuch'", "orden desconocida 'nosuch'"),
)
PREPARED = 'loadrt threads name1=servo period1=1000000\nloadrt and2 count=2\naddf and2.0 servo\nnet o and2.0.out\n'
# Command lines with errors, without a realtime process: their messages in English, German and Spanish.
OTHER_ERRORS = (
    ('halcmd show pin', 'no realtime process is running', 'es läuft kein Echtzeitprozess', 'no hay ningún proceso de tiempo real en marcha'),
    ('halcmd -x', 'unknown option -x', 'unbekannte Option -x', 'opción desconocida -x'),
    ('halcmd -i nosuch.ini show', 'nosuch.ini', 'nosuch.ini', 'nosuch.ini'),
    ('halcmd -h nosuch', "unknown command 'nosuch'", "unbekannter Befehl 'nosuch'", "orden desconocida 'nosuch'"),
    ('halcmd -U', 'options -I, -U and -T belong to halrun', 'die Optionen -I, -U und -T sind die von halrun', 'las opciones -I, -U y -T son de halrun'),
    ('halrun nosuch.hal', "HAL file 'nosuch.hal' not found", "die HAL-Datei 'nosuch.hal' ist nicht zu finden", "no se encuentra el archivo HAL 'nosuch.hal'"),
    ('halcmd_twopass a.ini', 'an INI file can only be used here when it has [HAL]TWOPASS', 'eine INI-Datei ist hier nur möglich, wenn sie [HAL]TWOPASS hat',
     'un archivo INI solo se puede usar aquí si tiene [HAL]TWOPASS'),
    ('halrun a.ini', 'an INI file can only be run when it has [HAL]TWOPASS', 'eine INI-Datei kann nur ausgeführt werden, wenn sie [HAL]TWOPASS hat',
     'un archivo INI solo se puede ejecutar si tiene [HAL]TWOPASS'),
    ('halrun bad.tcl', "parameter or pin 'nosuch' does not exist", "der Parameter oder Pin 'nosuch' ist nicht vorhanden", "el parámetro o pin 'nosuch' no existe"),
    ('halsampler -c x', "'x' is not a number of 0 or more", "'x' ist keine Zahl ab 0", "'x' no es un número de 0 o más"),
    ('millwright nosuch', "unknown command 'nosuch'; see millwright --help", "unbekannter Befehl 'nosuch'; siehe millwright --help", "orden desconocida 'nosuch'; véase millwright --help"),
    ('millwright hal watch nosuch', "no realtime process of instance", 'es läuft kein Echtzeitprozess der Instanz', 'no hay ningún proceso de tiempo real de la instancia'),
    ('latency-test 1', "'1' is not a period", "'1' ist keine Periode", "'1' no es un periodo"),
    ('halcompile --nosuch', 'unknown option --nosuch (--help lists them)', 'unbekannte Option --nosuch (--help zeigt alle)', 'opción desconocida --nosuch (--help las muestra todas)'),
    ('halcompile -o', '--outfile needs a value', '--outfile braucht einen Wert', '--outfile necesita un valor'),
    ('halcompile a.xy', "halcompile does not support the suffix '.xy'", "halcompile kennt die Endung '.xy' nicht", "halcompile no conoce la extensión '.xy'"),
    ('halcompile syntax.comp', "syntax.comp:3:1: error: ';' is expected here", "syntax.comp:3:1: Fehler: hier wird ';' erwartet", "syntax.comp:3:1: error: aquí se espera ';'"),
    ('halcompile names.comp', "names.comp:2:2: error: 'int' is a C keyword (call the pin int_", "names.comp:2:2: Fehler: 'int' ist ein Schlüsselwort von C (Name für pin: int_",
     "names.comp:2:2: error: 'int' es una palabra reservada de C (llame a pin int_"),
    ('halcompile --require-license free.comp', 'there is no license', 'die Lizenz fehlt', 'falta la licencia'),
    ('halcompile --compile main.c', 'main.c has no rtapi_app_main', 'main.c hat kein rtapi_app_main', 'main.c no tiene rtapi_app_main'),
)
FILES = {
    'a.ini': '[HAL]\nHALFILE = a.hal\n', 'bad.tcl': 'hal setp nosuch 1\n', 'syntax.comp': 'component syntax;\npin in bit x\npin in bit y;\nfunction _;\n;;\n',
    'names.comp': 'component names;\n pin in bit int;\nfunction _;\nlicense "GPL";\n;;\nFUNCTION(_) {}\n',
    'free.comp': 'component free "Does nothing.";\npin in bit x "An input.";\nfunction _;\n;;\nFUNCTION(_) {}\n', 'main.c': 'int main(void) { return 0; }\n',
    'caught.tcl': 'catch {hal setp nosuch 1} text\nputs $text\nputs [hal list pin]\nputs [hal getp and2.0.in0]\n',
    'caught.py': 'import hal\nh = hal.component("c")\nh.newpin("a", hal.HAL_BIT, hal.HAL_IN)\n'
                 'for call in (lambda: h.newpin("a", hal.HAL_BIT, hal.HAL_IN), lambda: h["nosuch"], lambda: hal.component("c"), lambda: hal.get_value("nosuch")):\n'
                 '    try:\n        call()\n    except Exception as error:\n        print(type(error).__name__, error)\nh.exit()\n',
}
# The output that scripts read.
READ_BY_SCRIPTS = ('list pin', 'list sig', 'list comp and2', 'list funct', 'list thread', 'show pin', 'show sig', 'show param and2*', 'show funct', 'show thread', 'show comp and2', 'show alias',
                   '-s show pin', '-s show sig', '-s show funct', '-s show thread', '-s show comp and2', '-s list pin', 'getp and2.0.in0', 'ptype and2.0.in0', 'gets o', 'stype o', 'save', 'save all',
                   'save net', '-s save all', 'status lock', '-s status lock', 'status mem', '-v setp and2.1.in0 1', '-V setp and2.1.in0 0', '-v newsig o bit', '-s setp nosuch 1', '-k getp nosuch')


def run(words, languages, folder, programs, **more):
    """stdout, stderr, exit status of a program that is started by its name through PATH."""
    env = {**PLAIN, **languages, 'PATH': f"{programs}:{os.environ['PATH']}", **more}
    done = subprocess.run(words.split() if isinstance(words, str) else words, env=env, cwd=folder, text=True, capture_output=True, check=False, stdin=subprocess.DEVNULL, timeout=STEP_S)
    return done.stdout, done.stderr, done.returncode


def check_help(programs, folder):
    """Each program, with each method of selecting a language."""
    names = sorted({path.name for path in programs.iterdir()} - NOT_INSTALLED)
    expect(len(names) > 20, 'the programs are found', names)
    helps = [[name, '--help'] for name in names] + [['halcmd', '-h'], ['halrun', '-h'], ['halcmd', '-h', 'net'], ['halcmd', '-h', 'loadusr']]
    helps += [['millwright', word, '--help'] for word in ('run', 'start', 'recover', 'ui', 'nml', 'doctor', 'select', 'setup', 'check', 'format', 'explain', 'hal')]
    helps += [['millwright', 'hal', word, '--help'] for word in ('watch', 'capture', 'graph', 'latency')]
    for words in helps:
        english, _, status = run(words, {}, folder, programs)
        expect(english and status == 0, f'{words} has help', english, status)
        for name, ways in (('German', GERMAN), ('Spanish', SPANISH)):
            first = run(words, ways[0], folder, programs)
            left = [line for line in first[0].splitlines() if len(ENGLISH_WORDS.findall(line)) > 1]
            expect(first[0] != english and first[2] == 0 and not left, f'{words} has help in {name}', left or first[0])
        if words[0] in ('halcmd', 'halcompile', 'hal_input'):
            for name, ways in (('German', GERMAN), ('Spanish', SPANISH), ('English', ENGLISH)):
                said = {run(words, way, folder, programs)[::2] for way in ways}
                expect(len(said) == 1, f'{words} has the same help by each variable that selects {name}', *said)


def check_hal_errors(programs, folder):
    """Errors in a file: the position is the same, the text is translated, and the exit status is the same."""
    path = folder / 'errors.hal'
    path.write_text(PREPARED + '\n'.join(error[0] for error in HAL_ERRORS) + '\n')
    said = [run('halrun -k errors.hal', way, folder, programs) for way in (ENGLISH[0], GERMAN[0], SPANISH[0])]
    for command, *texts in HAL_ERRORS:
        for text, (_, err, _) in zip(texts, said):
            expect(text in err, f"'{command}' is answered by: {text}", err)
    places = [PLACE.findall(err) for _, err, _ in said]
    expect(len(places[0]) > 15 and places[0] == places[1] == places[2], 'errors begin with the same FILE:LINE:COLUMN in each language', *places)
    expect(said[0][2] == said[1][2] == said[2][2] == 1, 'the exit status is the same', [one[2] for one in said])


def check_other_errors(programs, folder):
    for words, *texts in OTHER_ERRORS:
        said = [run(words, way, folder, programs) for way in (ENGLISH[0], GERMAN[0], SPANISH[0])]
        for text, (_, err, _) in zip(texts, said):
            expect(text in err, f"'{words}' is answered by: {text}", err)
        expect(said[0][2] == said[1][2] == said[2][2] != 0, f"the exit status of '{words}' is the same", [one[2] for one in said])


def check_scripts(programs, folder):
    """Output for programs has the same bytes in each language."""
    (folder / 'prepared.hal').write_text(PREPARED)
    made = run('halcmd -f prepared.hal', {}, folder, programs)
    expect(made == ('', '', 0), 'the HAL is prepared', made)
    python = {'PYTHONPATH': str(programs.parent / 'lib/python')}
    try:
        for words in [f'halcmd {command}' for command in READ_BY_SCRIPTS] + ['haltcl caught.tcl', f'{sys.executable} caught.py', 'halcompile -o /dev/stdout free.comp', 'realtime status',
                                                                           'halcompile -o /dev/stdout --document free.comp', 'halcompile --print-modinc', 'linuxcnc_var all', 'inivar -var HALFILE -ini a.ini']:
            english = run(words, ENGLISH[0], folder, programs, **python)
            for way in (GERMAN[0], SPANISH[0]):
                said = run(words, way, folder, programs, **python)
                expect(said[0] == english[0] and said[2] == english[2], f"'{words}' writes the same bytes in each language", said, english)
        expect("does not exist" in run('haltcl caught.tcl', GERMAN[0], folder, programs)[0], 'a script in Tcl catches errors in English')
    finally:
        run('halrun -U', {}, folder, programs)


def main():
    programs = pathlib.Path(sys.argv[1]).resolve()
    PLAIN['MILLWRIGHT_INSTANCE'] = f'language-{os.getpid()}'
    with tempfile.TemporaryDirectory(prefix='mw_language_') as name:
        folder = pathlib.Path(name)
        for file, text in FILES.items():
            (folder / file).write_text(text)
        check_help(programs, folder)
        check_hal_errors(programs, folder)
        check_other_errors(programs, folder)
        check_scripts(programs, folder)
    return FOUND.status()


if __name__ == '__main__':
    sys.exit(main())
