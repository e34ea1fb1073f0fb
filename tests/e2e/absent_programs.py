#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Programs and modules of LinuxCNC 2.9 that Millwright does not have report this when a configuration calls them, and name a
replacement.

usage: absent_programs.py BIN_FOLDER MODULE_FOLDER
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

# Programs that LinuxCNC's package installs in /usr/bin, and realtime modules, that Millwright does not have.
PROGRAMS = '''5axisgui axis axis-remote classicladder debuglevel elbpcom genserkins gladevcp gladevcp_demo gmoccapy gremlin_view gs2_vfd
gscreen hal-histogram hal_input hal_manualtoolchange halcmd halcmd_twopass halcompile halmeter halreport halrmt halrun halsampler halscope
halshow halstreamer haltcl halui hbmgui hexagui hy_gt_vfd hy_vfd image-to-gcode inivar io iov2 latency-histogram latency-plot latency-test
lineardelta linuxcnc linuxcnc_info linuxcnc_module_helper linuxcnc_var linuxcnclcd linuxcncmkdesktop linuxcncrsh linuxcncsvr linuxcnctop
maho600gui max5gui mb2hal mdi melfagui milltask millturngui mitsub_vfd monitor-xhc-hb04 motion-logger moveoff_gui mqtt-publisher ngcgui
panelui pi500_vfd pmx485 pmx485-test pncconf puma560gui pumagui pyngcgui pyui pyvcp pyvcp_demo qtplasmac-cfg2prefs qtplasmac-materials
qtplasmac-plasmac2qt qtplasmac_gcode qtvcp rotarydelta rs274 rtapi_app scaragui schedrmt scorbot-er-3 sendkeys setup_designer shuttle
sim-torch sim_pin simulate_probe stepconf svd-ps_vfd teach-in thermistor tool_mmap_read tool_watch tooledit touchy update_ini vfdb_vfd
vfs11_vfd wj200_vfd xhc-hb04 xhc-hb04-accels xhc-whb04b-6 xyzab-tdr-gui xyzac-trt-gui xyzbc-trt-gui z_level_compensation'''.split()
MODULES = '''axistest boss_plc classicladder_rt hal_bb_gpio hal_gm hal_lib hal_ppmc hal_speaker hm2_7i43 hm2_7i90 hm2_pci hm2_rpspi hm2_spi homecomp mesa_7i65 mesa_pktgyro_test mesa_uart scope_rt serport setsserial tp userkins
xhc_hb04_util'''.split()


def main():
    programs, modules = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
    absent = [name for name in PROGRAMS if not (programs / name).exists()]
    asked = [f'loadusr {name}' for name in absent] + [f'loadrt {name}' for name in MODULES if not (modules / f'{name}.so').exists()]
    failed = 0
    with tempfile.TemporaryDirectory(prefix='mw_absent_') as folder:
        # No program of an installed LinuxCNC is in the path, so none is started.
        env = {**os.environ, 'PATH': str(programs), 'MILLWRIGHT_INSTANCE': f'absent-{os.getpid()}', 'LC_ALL': 'C'}
        file = pathlib.Path(folder, 'absent.hal')
        file.write_text('\n'.join(asked) + '\n')
        done = subprocess.run([programs / 'halrun', '-k', '-f', file], env=env, capture_output=True, text=True, check=False,
                              stdin=subprocess.DEVNULL, timeout=120)
        told = {int(m[1]): m[2] for m in re.finditer(r'absent\.hal:(\d+)(?::\d+)?: (.*)', done.stderr)}
        for line, words in enumerate(asked, 1):
            said = told.get(line, '')
            # It names the missing program and has a hint.
            if words.split()[1] not in said or not re.search(r'\([^()]{30,}', said):
                failed += 1
                print(f'FAIL {words}: {said!r}')
        for name in absent[:3] + absent[-3:]:
            one = subprocess.run([programs / 'millwright', name], env=env, capture_output=True, text=True, check=False, timeout=20)
            if one.returncode != 2 or len(one.stderr) < 80:
                failed += 1
                print(f'FAIL millwright {name}: {one.stderr!r}')
    print(f'{len(asked)} asked, {failed} failed')
    return 1 if failed or len(asked) < 90 else 0


if __name__ == '__main__':
    sys.exit(main())
